// Planes that meet share their border fairly.
#pragma once

#include "common/patch_merging.h"

namespace foresight {

// Gives cells where two planes meet to the one they belong to. Where the planes form a crease that is decided by their
// line of intersection, which is known much better than any single data point; elsewhere by the nearer plane. Stopped:
// unfinished.
void settle_borders(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                    PlaneLabels& found, const Stop& stop = {});

}  // namespace foresight
