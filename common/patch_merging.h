// Best-first merging of patches of the image into planes: the neighbouring pair of least common fit error merges first.
//
// After Feng, Taguchi, Kamat, "Fast plane extraction in organized point clouds using agglomerative hierarchical
// clustering", ICRA 2014, with pairs instead of patches in the queue.
#pragma once

#include <utility>

#include "common/cell_connectivity.h"
#include "common/memory_pool.h"
#include "common/plane_fit.h"

namespace foresight {

// Planes and which cells are theirs.
struct PlaneLabels {
  PoolVector<int> labels;  // by cell: 0 = free, i + 1 = planes[i]
  PoolVector<Plane> planes;
  PoolVector<PointSums> sums;  // by plane: of its cells

  explicit PlaneLabels(int cells) : labels(static_cast<std::size_t>(cells), 0) {}
};

// Standard deviation of the data points about a plane, in units of plane_sigma. Sensors err along their line of sight,
// so points lie nearer to a plane seen at a slant; not without limit, because they err a little sideways too.
[[nodiscard]] double relative_noise(const Plane& plane);

// Which data points lie within the grow tolerance, by plane.
[[nodiscard]] PoolVector<ReachTest> reach_tests(const Coordinates& points, const SegmentationOptions& options,
                                                const PoolVector<Plane>& planes);

// Root mean square distance from the plane in standard deviations of the data points about it, squared; plane_sigma
// = 1.
[[nodiscard]] double fit_error(const PointSums& sums, const Plane& plane);

// How well normals of seeds and of regions must be known at least. Unit: rad.
inline constexpr double kNormalAccuracy = 0.1;

// Whether data points say which way their plane faces: a row of cells lies on many planes. The normal of n points of
// noise sigma that spread by s across their narrow side is known to about sigma / (s sqrt(n)) radians.
[[nodiscard]] bool is_steady(const PointSums& sums, const Plane& plane, const SegmentationOptions& options);

// Patches that have become one plane, by patch: the index of one of them, the same for all. `patches` holds the sums of
// the whole at that index afterwards.
// touching: pairs that may merge. largest_rms: no part of a merged pair is farther than this (rms) from the common
// plane, where that faces the sensor.
[[nodiscard]] PoolVector<int> merge_best_first(PoolVector<PointSums>& patches,
                                               const PoolVector<std::pair<int, int>>& touching, double largest_rms);

// Merges touching planes that fit one plane within the merge tolerance: pieces of one face that grew from apart.
// Every plane must have at least three cells.
void merge_touching_planes(const CellConnectivity& connectivity, const SegmentationOptions& options,
                           PlaneLabels& found);

}  // namespace foresight
