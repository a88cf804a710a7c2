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
  GrowthQueue() { latest_.fill(-1); }

  // share: distance as a share of the reach, 0 to 1.
  void push(double share, Candidate candidate) {
    const auto bucket = static_cast<std::size_t>(share * (kBuckets - 1));
    entries_.push_back({candidate, latest_[bucket]});
    latest_[bucket] = static_cast<int>(entries_.size()) - 1;
    first_ = std::min(first_, bucket);
  }
  // The nearest candidate, the latest of several; false when there is none.
  bool pop(Candidate& nearest) {
    while (first_ < kBuckets && latest_[first_] < 0) ++first_;
    if (first_ == kBuckets) return false;
    const Entry& entry = entries_[static_cast<std::size_t>(latest_[first_])];
    nearest = entry.candidate;
    latest_[first_] = entry.before;
    return true;
  }

 private:
  struct Entry {
    Candidate candidate;
    int before;  // the one pushed before it with the same distance, or -1
  };
  static constexpr std::size_t kBuckets = 64;
  std::size_t first_ = kBuckets;
  std::array<int, kBuckets> latest_;  // by bucket: index of the entry pushed last, or -1
  PoolVector<Entry> entries_;
};

// Sums without the cells beside other planes or none. By plane.
PoolVector<PointSums> sums_of_inner_cells(const Coordinates& points, const PlaneLabels& found) {
  PoolVector<PointSums> inner = found.sums;
  const int* labels = found.labels.data();
  const int columns = points.columns;
  const int cells = points.size();
  const auto remove = [&](int cell) {
    if (labels[cell] != 0) inner[static_cast<std::size_t>(labels[cell] - 1)].remove(points[cell]);
  };
  const auto mark = [&](int first, Marks& marks) { return mark_borders(labels + first, columns, marks); };
  // The rows at the border of the image lie beside no plane.
  for (int cell = 0; cell < columns; ++cell) remove(cell);
  visit_marked(columns, cells - columns, mark, remove);
  for (int cell = std::max(columns, cells - columns); cell < cells; ++cell) remove(cell);
  return inner;
}

void fit_inner_cells(const Coordinates& points, const SegmentationOptions& options, PlaneLabels& found) {
  const PoolVector<PointSums> inner = sums_of_inner_cells(points, found);
  for (std::size_t i = 0; i < inner.size(); ++i) {
    if (found.sums[i].count() >= 3.0) found.planes[i] = found.sums[i].fit();
    if (inner[i].count() < options.smallest_region) continue;
    const Plane plane = inner[i].fit();
    if (is_steady(inner[i], plane, options)) found.planes[i] = plane;
  }
}

}  // namespace

void grow_planes(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                 PlaneLabels& found, const Stop& stop) {
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
  const int* labels = found.labels.data();
  const auto none_is_free = [&](int block) {
    return !any_is_free(labels + block) || !connectivity.any_connected(block);
  };
  visit_cells(0, image.size(), none_is_free, [&](int cell) {
    if (labels[cell] != 0) return;
    connectivity.for_each_neighbour(cell, [&](int neighbour) {
      const int label = growth.label(neighbour);
      if (label == 0) return;
      const double share = growth.distance(cell, label) / growth.reach(label);
      if (share <= 1.0) queue.push(share, {cell, label});
    });
  });
  GrowthQueue::Candidate nearest{};
  constexpr int kAtOnce = 4096;  // candidates between two questions whether to stop
  for (int taken = 0; queue.pop(nearest); ++taken) {
    if (taken % kAtOnce == 0 && stop && stop()) return;
    if (growth.label(nearest.cell) != 0) continue;
    growth.join(nearest.cell, nearest.label);
    offer(nearest.cell, nearest.label);
  }
}

void refit_planes(const Coordinates& points, const SegmentationOptions& options, PlaneLabels& found) {
  fit_inner_cells(points, options, found);
  const PoolVector<ReachTest> within_reach = reach_tests(points, options, found.planes);
  const int* labels = found.labels.data();
  const auto keeps_all = [&](int block) {
    const int own = labels[block];
    return all_are(own, labels + block) &&
           (own == 0 || within_reach[static_cast<std::size_t>(own - 1)].holds_for_block(block));
  };
  visit_cells(0, points.size(), keeps_all, [&](int cell) {
    int& label = found.labels[static_cast<std::size_t>(cell)];
    if (label == 0) return;
    const auto own = static_cast<std::size_t>(label - 1);
    if (within_reach[own].holds(cell)) return;
    found.sums[own].remove(points[cell]);
    label = 0;
  });
}

}  // namespace foresight
