// Cells join planes: the second half of region growing.
#pragma once

#include "common/patch_merging.h"

namespace foresight {

// Best-first region growing by cells: of all free cells beside a plane's cells and within the grow tolerance of the
// plane, those nearest to it join first. Planes do not change, their sums do. Stopped: unfinished.
void grow_planes(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                 PlaneLabels& found, const Stop& stop = {});

// Planes from the cells as they stand now, as far as possible without those beside other planes or none, whose data
// points may lie between two surfaces. Sets free the cells that are out of the grow tolerance then.
void refit_planes(const Coordinates& points, const SegmentationOptions& options, PlaneLabels& found);

}  // namespace foresight
