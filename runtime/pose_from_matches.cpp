#include "runtime/pose_from_matches.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace foresight {
namespace {

// Planes whose normals are nearer than this to one line say nothing dependable about what lies across them: a normal of
// a small region errs by degrees. Unit: rad (10 degrees).
constexpr double kLeastAngle = 0.1745;

// Centroids nearer than this across the normals do not point anywhere. Unit: mm.
constexpr double kLeastCentroidDistance = 1.0;

// Least eigenvalue (of a sum of n n^T) and least determinacy (of the rotation): those of two unit normals at
// kLeastAngle.
const double kLeastEigenvalue = 1.0 - std::cos(kLeastAngle);

// Angle between the lines along two unit normals, in [0, pi/2].
double angle_between_lines(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

// Whether all normals stand along one line, in either frame: that of the faces, which is exact, or that of the regions.
bool parallel(std::span<const RegionFaceMatch> matches) {
  double widest_face = 0.0;
  double widest_region = 0.0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    for (std::size_t j = i + 1; j < matches.size(); ++j) {
      widest_face = std::max(widest_face, angle_between_lines(matches[i].face->normal, matches[j].face->normal));
      widest_region = std::max(widest_region,
                               angle_between_lines(matches[i].region->region.normal, matches[j].region->region.normal));
    }
  }
  return std::min(widest_face, widest_region) < kLeastAngle;
}

// Kabsch's correlation matrix over the normals. All weigh the same: a weight by size would hand the rotation to the
// largest region, and the pose is rough anyway.
Eigen::Matrix3d correlate_normals(std::span<const RegionFaceMatch> matches) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const RegionFaceMatch& match : matches) sum += match.region->region.normal * match.face->normal.transpose();
  return sum;
}

// The common axis of near-parallel normals in each frame; opposite normals are turned over, in both frames alike.
struct CommonAxis {
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();
  Eigen::Vector3d model = Eigen::Vector3d::Zero();
};

CommonAxis common_axis(std::span<const RegionFaceMatch> matches) {
  CommonAxis axis;
  for (const RegionFaceMatch& match : matches) {
    const double sign = match.face->normal.dot(matches.front().face->normal) < 0.0 ? -1.0 : 1.0;
    axis.sensor += sign * match.region->region.normal;
    axis.model += sign * match.face->normal;
  }
  axis.sensor.normalize();
  axis.model.normalize();
  return axis;
}

// What the directions between centroids, seen along the common axis, say about the turn around it: a correlation of
// total weight 1, in which long distances count most. Zero where all are too short to point anywhere.
Eigen::Matrix3d correlate_centroids(std::span<const RegionFaceMatch> matches) {
  const CommonAxis axis = common_axis(matches);
  const auto across = [](const Eigen::Vector3d& v, const Eigen::Vector3d& along) -> Eigen::Vector3d {
    return v - along * along.dot(v);
  };
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double weight = 0.0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    for (std::size_t j = i + 1; j < matches.size(); ++j) {
      const Eigen::Vector3d in_sensor = across(matches[i].region->centroid - matches[j].region->centroid, axis.sensor);
      const Eigen::Vector3d in_model = across(matches[i].face->centroid - matches[j].face->centroid, axis.model);
      if (std::min(in_sensor.norm(), in_model.norm()) < kLeastCentroidDistance) continue;
      sum += in_sensor * in_model.transpose();
      weight += in_sensor.norm() * in_model.norm();
    }
  }
  return weight > 0.0 ? Eigen::Matrix3d(sum / weight) : sum;
}

// The rotation that maximises trace(R^T correlation) (Kabsch 1976), when it is the only one: turning about the least
// determined axis costs the two smallest singular values, the last counted negative under a reflection. Two normals
// need no third: the determinant gives the missing axis.
std::optional<Eigen::Matrix3d> best_rotation(const Eigen::Matrix3d& correlation) {
  const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::Matrix3d>(correlation).singularValues();
  const double last = correlation.determinant() < 0.0 ? -values[2] : values[2];
  if (!(values[1] + last >= 0.5 * kLeastEigenvalue)) return std::nullopt;
  return nearest_rotation(correlation);
}

// The same of two matches whose normals are not parallel: sums and differences of unit normals stand at right angles in
// either frame, so that both pairs of them can be laid on each other.
Eigen::Matrix3d rotation_of_two(const RegionFaceMatch& a, const RegionFaceMatch& b) {
  const auto axes = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    Eigen::Matrix3d frame;
    frame.col(0) = (p + q).normalized();
    frame.col(1) = (p - q).normalized();
    frame.col(2) = frame.col(0).cross(frame.col(1));
    return frame;
  };
  return axes(a.region->region.normal, b.region->region.normal) * axes(a.face->normal, b.face->normal).transpose();
}

// Translation t: where a face centroid c_m comes to lie, R c_m + t, is on the plane of its region, so
// n_s . t = offset_s - n_s . R c_m. Directions these planes leave free are taken from t = c_s - R c_m instead: a
// region's centroid is that of the face only while the whole face is seen, so it has no say where planes do.
Eigen::Vector3d translation(std::span<const RegionFaceMatch> matches, const Eigen::Matrix3d& rotation) {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  Eigen::Vector3d offsets = Eigen::Vector3d::Zero();
  Eigen::Vector3d from_centroids = Eigen::Vector3d::Zero();
  for (const RegionFaceMatch& match : matches) {
    const Eigen::Vector3d& normal = match.region->region.normal;
    const Eigen::Vector3d turned = rotation * match.face->centroid;
    normals += normal * normal.transpose();
    offsets += normal * (match.region->region.offset - normal.dot(turned));
    from_centroids += match.region->centroid - turned;
  }
  from_centroids /= static_cast<double>(matches.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normals);
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d direction = solver.eigenvectors().col(k);
    const double determined = solver.eigenvalues()[k];
    result += direction *
              (determined >= kLeastEigenvalue ? direction.dot(offsets) / determined : direction.dot(from_centroids));
  }
  return result;
}

}  // namespace

std::optional<Pose> pose_from_matches(std::span<const RegionFaceMatch> matches) {
  assert(matches.size() >= 2);
  const bool are_parallel = parallel(matches);
  if (matches.size() == 2 && !are_parallel) {
    const Eigen::Matrix3d rotation = rotation_of_two(matches[0], matches[1]);
    return Pose{rotation, translation(matches, rotation)};
  }
  Eigen::Matrix3d correlation = correlate_normals(matches);
  if (are_parallel) {
    const Eigen::Matrix3d centroids = correlate_centroids(matches);
    if (centroids.isZero(0.0)) return std::nullopt;
    correlation += centroids;
  }
  const std::optional<Eigen::Matrix3d> rotation = best_rotation(correlation);
  if (!rotation) return std::nullopt;
  return Pose{*rotation, translation(matches, *rotation)};
}

}  // namespace foresight
