// Start poses of hypotheses: where two, three or even one matched region may put the object.
//
// A part of a face tells its plane as well as the whole does, but not its middle. So what planes leave free is not
// taken from centroids alone: every end at which region and face may both end makes a start of its own, and looking at
// them (pose_check.h) decides.
#pragma once

#include <array>

#include "common/memory_pool.h"
#include "common/pose.h"
#include "common/region_attributes.h"
#include "runtime/database.h"
#include "runtime/hypothesis_queue.h"

namespace foresight {

// The smallest rectangle around a planar patch.
struct PatchFrame {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // towards the sensor, or outward
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of the rectangle. Unit: mm.
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();    // along its longer side; the other axis is normal x axis
  std::array<double, 2> extents{};                   // full length along both. Unit: mm.
};

// Of the convex hull of points on a plane with this normal. REQUIRES: points not empty.
[[nodiscard]] PatchFrame smallest_rectangle(const PoolVector<Eigen::Vector3d>& points, const Eigen::Vector3d& normal);

// Vertices and frames of the faces of all loaded models.
class FaceShapes {
 public:
  explicit FaceShapes(const Database& database);
  [[nodiscard]] const PoolVector<Eigen::Vector3d>& vertices(int model, int face) const;
  [[nodiscard]] const PatchFrame& frame(int model, int face) const;
  // Unit, direction of the larger second moment.
  [[nodiscard]] const Eigen::Vector3d& major_axis(int model, int face) const;

 private:
  struct Shape {
    PoolVector<Eigen::Vector3d> vertices;
    PatchFrame frame;
    Eigen::Vector3d major_axis = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] const Shape& shape(int model, int face) const;
  PoolVector<PoolVector<Shape>> shapes_;  // by model, by face
};

struct ScanRegions {
  const PoolVector<DescribedRegion>& regions;
  PoolVector<PatchFrame> frames;  // by region
};
[[nodiscard]] ScanRegions frame_regions(const PoolVector<DescribedRegion>& regions);

// Rotation from the normals; along the line both planes leave free, starts at which the centroids coincide on average,
// or an end of either region with that of its face. Empty when the matches do not determine a pose.
[[nodiscard]] PoolVector<Pose> pair_starts(const Database& database, const FaceShapes& shapes, const ScanRegions& scan,
                                           const MatchPair& pair);

// Whether three regions and three faces are seen from the same side, by the triple products of their normals: those of
// an object and of its mirror image have opposite signs. Not so where either is too small: such planes hardly fix a
// point.
[[nodiscard]] bool same_handed(double of_regions, double of_faces);

// All symmetric ways to lay the face on the region's plane: smallest rectangles with each other, their centres or,
// where the region is cut, one of their corners together; where it is whole, also the principal axes with each other.
// None when the region reaches beyond the face.
[[nodiscard]] PoolVector<Pose> single_starts(const Database& database, const FaceShapes& shapes,
                                             const ScanRegions& scan, const RatedMatch& match, bool cut);

}  // namespace foresight
