// Rigid motion. Always named T_target_source: takes points of the source frame into the target frame.
#pragma once

#include <Eigen/Core>

namespace foresight {

struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();    // proper rotation
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();     // mm

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + translation; }
  [[nodiscard]] Pose operator*(const Pose& source) const {
    return {rotation * source.rotation, rotation * source.translation + translation};
  }
  [[nodiscard]] Pose inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
};

// Rotation by |v| radians about v, through Rodrigues' formula.
[[nodiscard]] Eigen::Matrix3d rotation_from_vector(const Eigen::Vector3d& v);

// Angle of a rotation, radians in [0, pi].
[[nodiscard]] double rotation_angle(const Eigen::Matrix3d& rotation);

// The nearest proper rotation in the least-squares sense (removes rounding after many products).
[[nodiscard]] Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

// True when the matrix is a proper rotation within the tolerance on every entry of R^T R and on det R.
[[nodiscard]] bool is_rotation(const Eigen::Matrix3d& matrix, double tolerance = 1e-6);

}  // namespace foresight
