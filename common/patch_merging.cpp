#include "common/patch_merging.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "common/plane_contacts.h"

namespace foresight {
namespace {

// Sets of patches that have become one plane: a union-find forest in which the larger absorbs the smaller.
struct Clusters {
  PoolVector<PointSums>& sums;  // by patch; of the whole cluster at its representative
  PoolVector<int> parent;       // by patch

  explicit Clusters(PoolVector<PointSums>& patches) : sums(patches), parent(patches.size()) {
    for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = static_cast<int>(i);
  }
  [[nodiscard]] PointSums& of(int representative) { return sums[static_cast<std::size_t>(representative)]; }
  int representative(int patch) {
    while (parent[static_cast<std::size_t>(patch)] != patch) {
      int& up = parent[static_cast<std::size_t>(patch)];
      up = parent[static_cast<std::size_t>(up)];
      patch = up;
    }
    return patch;
  }
};

// The worse of the two parts' mean squared distances from their common plane: a small patch cannot hide in a large one.
double common_error(const PointSums& a, const PointSums& b) {
  PointSums both = a;
  both.add(b);
  const Plane plane = both.fit();
  return std::max(fit_error(a, plane), fit_error(b, plane));
}

struct Pair {
  double error;
  int a, b;      // patches that touch
  double stamp;  // cells of both clusters when the error was computed; a different number now means it is out of date

  bool operator>(const Pair& other) const {
    if (error != other.error) return error > other.error;
    return a != other.a ? a > other.a : b > other.b;
  }
};

Pair make_pair_of(Clusters& clusters, int a, int b) {
  const PointSums& in_a = clusters.of(clusters.representative(a));
  const PointSums& in_b = clusters.of(clusters.representative(b));
  return {common_error(in_a, in_b), a, b, in_a.count() + in_b.count()};
}

}  // namespace

double relative_noise(const Plane& plane) {
  constexpr double kSideways = 0.4;
  return std::max(kSideways, std::abs(plane.normal.z()));
}

PoolVector<ReachTest> reach_tests(const Coordinates& points, const SegmentationOptions& options,
                                  const PoolVector<Plane>& planes) {
  PoolVector<ReachTest> tests;
  tests.reserve(planes.size());
  for (const Plane& plane : planes)
    tests.emplace_back(points, plane, options.grow_tolerance * options.plane_sigma * relative_noise(plane));
  return tests;
}

double fit_error(const PointSums& sums, const Plane& plane) {
  const double noise = relative_noise(plane);
  return sums.mean_squared_distance(plane) / (noise * noise);
}

bool is_steady(const PointSums& sums, const Plane& plane, const SegmentationOptions& options) {
  const double noise = options.plane_sigma * relative_noise(plane) / kNormalAccuracy;
  return sums.count() * sums.narrow_spread() >= noise * noise;
}

PoolVector<int> merge_best_first(PoolVector<PointSums>& patches, const PoolVector<std::pair<int, int>>& touching,
                                 double largest_rms) {
  Clusters clusters(patches);
  PoolVector<Pair> pairs;
  pairs.reserve(touching.size());
  for (const auto& [a, b] : touching) pairs.push_back(make_pair_of(clusters, a, b));
  std::priority_queue<Pair, PoolVector<Pair>, std::greater<>> queue(std::greater<>(), std::move(pairs));
  // Pairs whose clusters have grown since their error was computed are brought up to date when they come up, not
  // before: a cluster has as many pairs as its outline has patches, and most never come up again.
  while (!queue.empty()) {
    const Pair top = queue.top();
    queue.pop();
    const int a = clusters.representative(top.a);
    const int b = clusters.representative(top.b);
    if (a == b) continue;
    PointSums& in_a = clusters.of(a);
    PointSums& in_b = clusters.of(b);
    if (in_a.count() + in_b.count() != top.stamp) {
      queue.push(make_pair_of(clusters, top.a, top.b));
      continue;
    }
    if (top.error > largest_rms * largest_rms) continue;
    const bool a_absorbs = in_a.count() != in_b.count() ? in_a.count() > in_b.count() : a < b;
    (a_absorbs ? in_a : in_b).add(a_absorbs ? in_b : in_a);
    clusters.parent[static_cast<std::size_t>(a_absorbs ? b : a)] = a_absorbs ? a : b;
  }
  for (int patch = 0; patch < static_cast<int>(patches.size()); ++patch) {
    clusters.parent[static_cast<std::size_t>(patch)] = clusters.representative(patch);
  }
  return clusters.parent;
}

void merge_touching_planes(const CellConnectivity& connectivity, const SegmentationOptions& options,
                           PlaneLabels& found) {
  PoolVector<std::pair<int, int>> touching;
  for (const Contact& contact : contacts_of(connectivity, found.labels)) {
    const std::pair<int, int> pair = std::minmax(found.labels[static_cast<std::size_t>(contact.cell)] - 1,
                                                 found.labels[static_cast<std::size_t>(contact.next)] - 1);
    if (touching.empty() || touching.back() != pair) touching.push_back(pair);
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  const PoolVector<int> merged = merge_best_first(found.sums, touching, options.merge_tolerance * options.plane_sigma);

  PoolVector<int> label_of(merged.size() + 1, 0);  // by old label
  PoolVector<PointSums> sums;
  for (std::size_t i = 0; i < merged.size(); ++i) {
    if (merged[i] != static_cast<int>(i)) continue;
    sums.push_back(found.sums[i]);
    label_of[i + 1] = static_cast<int>(sums.size());
  }
  for (std::size_t i = 0; i < merged.size(); ++i) label_of[i + 1] = label_of[static_cast<std::size_t>(merged[i]) + 1];
  if (sums.size() < merged.size()) {  // else every plane keeps its label
    for (int& label : found.labels) label = label_of[static_cast<std::size_t>(label)];
  }
  found.planes.clear();
  for (const PointSums& plane : sums) found.planes.push_back(plane.fit());
  found.sums = std::move(sums);
}

}  // namespace foresight
