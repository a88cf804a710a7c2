#include "common/region_growth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/growth_state.h"

namespace foresight {
namespace {

// A queue with the distances rounded to a sixty-fourth of the reach: constant time, and finer than the noise.
class GrowthQueue {
 public:
  struct Candidate {
    int cell, label;
  };
  // share: distance as a share of the reach, 0 to 1.
  void push(double share, Candidate candidate) {
    const auto bucket = static_cast<std::size_t>(share * (kBuckets - 1));
    buckets_[bucket].push_back(candidate);
    first_ = std::min(first_, bucket);
  }
  // The nearest candidate, the latest of several; false when there is none.
  bool pop(Candidate& nearest) {
    while (first_ < kBuckets && buckets_[first_].empty()) ++first_;
    if (first_ == kBuckets) return false;
    nearest = buckets_[first_].back();
    buckets_[first_].pop_back();
    return true;
  }

 private:
  static constexpr std::size_t kBuckets = 64;
  std::size_t first_ = kBuckets;
  std::array<std::vector<Candidate>, kBuckets> buckets_;
};

}  // namespace

void grow_planes(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                 PlaneLabels& found) {
  Growth growth{image, connectivity, options, found};
  growth.measure_reach();
  GrowthQueue queue;
  const auto offer = [&](int cell, int label) {
    connectivity.for_each_neighbour(cell, [&](int neighbour) {
      if (growth.label(neighbour) != 0) return;
      const double share = growth.distance(neighbour, label) / growth.reach(label);
      if (share <= 1.0) queue.push(share, {neighbour, label});
    });
  };
  for (int cell = 0; cell < image.size(); ++cell) {
    if (growth.label(cell) != 0) continue;
    connectivity.for_each_neighbour(cell, [&](int neighbour) {
      const int label = growth.label(neighbour);
      if (label == 0) return;
      const double share = growth.distance(cell, label) / growth.reach(label);
      if (share <= 1.0) queue.push(share, {cell, label});
    });
  }
  GrowthQueue::Candidate nearest{};
  while (queue.pop(nearest)) {
    if (growth.label(nearest.cell) != 0) continue;
    growth.join(nearest.cell, nearest.label);
    offer(nearest.cell, nearest.label);
  }
}

void refit_planes(const RangeImage& image, const SegmentationOptions& options, PlaneLabels& found) {
  std::vector<PointSums> inner = found.sums;
  const auto columns = static_cast<std::size_t>(image.columns);
  const auto point = [&](std::size_t at) { return Eigen::Vector3d(image.points[at].cast<double>()); };
  for (std::size_t at = 0; at < found.labels.size(); ++at) {
    const int own = found.labels[at];
    if (own == 0) continue;
    const bool amid = at >= columns && at + columns < found.labels.size() && found.labels[at - 1] == own &&
                      found.labels[at + 1] == own && found.labels[at - columns] == own &&
                      found.labels[at + columns] == own;
    if (!amid) inner[static_cast<std::size_t>(own - 1)].remove(point(at));
  }
  std::vector<double> reach(found.planes.size());
  for (std::size_t i = 0; i < inner.size(); ++i) {
    if (found.sums[i].count() >= 3.0) found.planes[i] = found.sums[i].fit();
    if (inner[i].count() >= options.smallest_region) {
      const Plane plane = inner[i].fit();
      if (is_steady(inner[i], plane, options)) found.planes[i] = plane;
    }
    reach[i] = options.grow_tolerance * options.plane_sigma * relative_noise(found.planes[i]);
  }
  for (std::size_t at = 0; at < found.labels.size(); ++at) {
    if (found.labels[at] == 0) continue;
    const auto own = static_cast<std::size_t>(found.labels[at] - 1);
    if (std::abs(found.planes[own].distance(point(at))) <= reach[own]) continue;
    found.sums[own].remove(point(at));
    found.labels[at] = 0;
  }
}

}  // namespace foresight
