// Planes fall apart into connected pieces.
#pragma once

#include "common/patch_merging.h"

namespace foresight {

// Every connected piece becomes a plane of its own, in the order of their first cells. Pieces that are too small or not
// steady are free again.
void split_planes(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                  PlaneLabels& found);

}  // namespace foresight
