// What growing and the settling of borders share; for their sources only.
#pragma once

#include <cmath>

#include "common/memory_pool.h"
#include "common/patch_merging.h"

namespace foresight {

// A view of an image and its planes that reads like prose.
struct Growth {
  const RangeImage& image;
  const CellConnectivity& connectivity;
  const SegmentationOptions& options;
  PlaneLabels& found;
  PoolVector<double> reach_of = {};  // by plane

  void measure_reach() {
    for (const Plane& plane : found.planes)
      reach_of.push_back(options.grow_tolerance * options.plane_sigma * relative_noise(plane));
  }
  [[nodiscard]] int& label(int cell) { return found.labels[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] PointSums& sums(int label) { return found.sums[static_cast<std::size_t>(label - 1)]; }
  [[nodiscard]] Eigen::Vector3d point(int cell) const { return image[cell].cast<double>(); }
  [[nodiscard]] double signed_distance(int cell, int label) const {
    return found.planes[static_cast<std::size_t>(label - 1)].distance(point(cell));
  }
  [[nodiscard]] double distance(int cell, int label) const { return std::abs(signed_distance(cell, label)); }
  [[nodiscard]] double reach(int label) const { return reach_of[static_cast<std::size_t>(label - 1)]; }
  [[nodiscard]] bool within_reach(int cell, int label) const { return distance(cell, label) <= reach(label); }
  void release(int cell) {
    sums(label(cell)).remove(point(cell));
    label(cell) = 0;
  }
  void join(int cell, int to) {
    sums(to).add(point(cell));
    label(cell) = to;
  }
};

}  // namespace foresight
