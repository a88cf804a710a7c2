#include "common/plane_fit.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace foresight {

void PointSums::add(const Eigen::Vector3d& point) {
  count_ += 1.0;
  sum_ += point;
  outer_.noalias() += point * point.transpose();
}

void PointSums::add(const PointSums& other) {
  count_ += other.count_;
  sum_ += other.sum_;
  outer_ += other.outer_;
}

Eigen::Matrix3d PointSums::covariance() const {
  const Eigen::Vector3d centre = mean();
  return outer_ / count_ - centre * centre.transpose();
}

Plane PointSums::fit() const {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance());
  Plane plane;
  plane.normal = solver.eigenvectors().col(0);
  plane.offset = plane.normal.dot(mean());
  if (plane.offset > 0.0) {
    plane.normal = -plane.normal;
    plane.offset = -plane.offset;
  }
  return plane;
}

double PointSums::mean_squared_distance(const Plane& plane) const {
  const double off = plane.distance(mean());
  return std::max(0.0, plane.normal.dot(covariance() * plane.normal)) + off * off;
}

}  // namespace foresight
