// The patches from which planes grow: square blocks of the image that lie on a plane, merged best first.
#pragma once

#include "common/patch_merging.h"

namespace foresight {

// Stopped, either leaves what it has found so far unfinished.

// Blocks of seed_block cells on a grid over the whole image. Blocks that differ from one beside them are given up again
// where the plane has others: those straddle creases and edges, and growing decides about their cells one by one.
void seed_on_grid(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                  PlaneLabels& found, const Stop& stop = {});

// Windows of `side` cells wherever one fits between the planes found so far, on no grid: thin and small faces.
void seed_between(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                  int side, PlaneLabels& found, const Stop& stop = {});

}  // namespace foresight
