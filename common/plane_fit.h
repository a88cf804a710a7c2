// Least-squares planes from running sums, so that two patches merge in constant time.
#pragma once

#include <Eigen/Core>

namespace foresight {

struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit
  double offset = 0.0;                                // normal . p = offset. Unit: mm.

  [[nodiscard]] double distance(const Eigen::Vector3d& point) const { return normal.dot(point) - offset; }  // signed
};

// Count, sum and sum of outer products of points.
class PointSums {
 public:
  void add(const Eigen::Vector3d& point);
  void add(const PointSums& other);

  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] Eigen::Vector3d mean() const { return sum_ / count_; }
  // Plane of least mean squared distance, its normal towards the origin (the sensor). REQUIRES: count() >= 3.
  [[nodiscard]] Plane fit() const;
  // Mean squared distance of the points from any plane. Unit: mm^2.
  [[nodiscard]] double mean_squared_distance(const Plane& plane) const;

 private:
  [[nodiscard]] Eigen::Matrix3d covariance() const;

  double count_ = 0.0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d outer_ = Eigen::Matrix3d::Zero();
};

}  // namespace foresight
