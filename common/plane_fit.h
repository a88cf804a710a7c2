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
  void add(const Eigen::Vector3d& point) { add(point, 1.0); }
  void remove(const Eigen::Vector3d& point) { add(point, -1.0); }
  void add(const PointSums& other) {
    count_ += other.count_;
    sum_ += other.sum_;
    squares_ += other.squares_;
    products_ += other.products_;
  }

  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] Eigen::Vector3d mean() const { return sum_ / count_; }
  // Plane of least mean squared distance, its normal towards the origin (the sensor). REQUIRES: count() >= 3.
  [[nodiscard]] Plane fit() const;
  // Mean squared distance of the points from the line that fits them best, in the plane that does: how wide the narrow
  // side of a patch is. Unit: mm^2.
  [[nodiscard]] double narrow_spread() const;
  // Mean squared distance of the points from any plane. Unit: mm^2.
  [[nodiscard]] double mean_squared_distance(const Plane& plane) const;

 private:
  void add(const Eigen::Vector3d& point, double weight) {
    const Eigen::Vector3d weighted = weight * point;
    count_ += weight;
    sum_ += weighted;
    squares_ += weighted.cwiseProduct(point);
    products_ += Eigen::Vector3d(weighted.x() * point.y(), weighted.x() * point.z(), weighted.y() * point.z());
  }
  [[nodiscard]] Eigen::Matrix3d covariance() const;

  double count_ = 0.0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares_ = Eigen::Vector3d::Zero();   // of xx, yy, zz
  Eigen::Vector3d products_ = Eigen::Vector3d::Zero();  // of xy, xz, yz
};

}  // namespace foresight
