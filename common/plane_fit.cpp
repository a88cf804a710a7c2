#include "common/plane_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace foresight {

Eigen::Matrix3d PointSums::covariance() const {
  const Eigen::Vector3d centre = mean();
  Eigen::Matrix3d outer;
  outer << squares_.x(), products_.x(), products_.y(),  //
      products_.x(), squares_.y(), products_.z(),       //
      products_.y(), products_.z(), squares_.z();
  return outer / count_ - centre * centre.transpose();
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

double PointSums::narrow_spread() const {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance(), Eigen::EigenvaluesOnly);
  return std::max(0.0, solver.eigenvalues()[1]);
}

double PointSums::mean_squared_distance(const Plane& plane) const {
  const double off = plane.distance(mean());
  return std::max(0.0, plane.normal.dot(covariance() * plane.normal)) + off * off;
}

}  // namespace foresight
