#include "common/pose.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace foresight {

Eigen::Matrix3d rotation_from_vector(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  if (angle < 1e-300) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

double rotation_angle(const Eigen::Matrix3d& rotation) {
  // atan2 keeps its precision near 0 and pi, where acos of the trace loses it.
  const Eigen::Vector3d axis(rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0),
                             rotation(1, 0) - rotation(0, 1));
  return std::atan2(axis.norm(), rotation.trace() - 1.0);
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

bool is_rotation(const Eigen::Matrix3d& matrix, double tolerance) {
  if (!matrix.allFinite()) return false;
  const Eigen::Matrix3d error = matrix.transpose() * matrix - Eigen::Matrix3d::Identity();
  return error.cwiseAbs().maxCoeff() <= tolerance && std::abs(matrix.determinant() - 1.0) <= 3.0 * tolerance;
}

}  // namespace foresight
