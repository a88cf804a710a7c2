// PCL's planar regions, for comparison with segment().
#pragma once

#include <vector>

#include "common/range_image.h"

namespace foresight {

struct PclPlanesOptions {
  double normal_smoothing = 11.0;   // of the integral image normals. Unit: cells. Limit: > 0.
  double depth_change = 0.01;       // of them: neighbours are apart beyond this times (1 m + depth). Limit: > 0.
  double angle = 0.14;              // normals of one plane. Unit: rad. Limit: > 0.
  double distance = 40.0;           // of their planes from the origin, at a depth of 1 m. Unit: mm. Limit: > 0.
  double largest_curvature = 0.01;  // of a region's plane fit. Limit: > 0.
  int smallest_region = 100;        // Unit: cells. Limit: >= 3.
  bool refine = true;               // PCL's second pass, which gives regions the cells along their borders
};

// Integral image normals and organized multi-plane segmentation. Label image, row by row: 0 = no region, regions
// from 1.
[[nodiscard]] std::vector<int> pcl_planes(const RangeImage& image, const PclPlanesOptions& options = {});

}  // namespace foresight
