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
    z_ += other.z_;
    xy_ += other.xy_;
    xx_yy_ += other.xx_yy_;
    xz_yz_ += other.xz_yz_;
    zz_xy_ += other.zz_xy_;
  }

  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] Eigen::Vector3d mean() const { return Eigen::Vector3d(xy_[0], xy_[1], z_) / count_; }
  // Plane of least mean squared distance, its normal towards the origin (the sensor). REQUIRES: count() >= 3.
  [[nodiscard]] Plane fit() const;
  // Mean squared distance of the points from the line that fits them best, in the plane that does: how wide the narrow
  // side of a patch is. Unit: mm^2.
  [[nodiscard]] double narrow_spread() const;
  // Mean squared distance of the points from any plane. Unit: mm^2.
  [[nodiscard]] double mean_squared_distance(const Plane& plane) const;

 private:
  using Pair = Eigen::Array2d;  // what one vector instruction adds

  void add(const Eigen::Vector3d& point, double weight) {
    const Pair xy(point.x(), point.y());
    const double z = point.z();
    count_ += weight;
    z_ += weight * z;
    xy_ += weight * xy;
    xx_yy_ += weight * xy * xy;
    xz_yz_ += weight * xy * z;
    zz_xy_ += weight * Pair(z, xy[0]) * Pair(z, xy[1]);
  }

  double count_ = 0.0;
  double z_ = 0.0;
  Pair xy_ = Pair::Zero();
  Pair xx_yy_ = Pair::Zero();  // of products
  Pair xz_yz_ = Pair::Zero();
  Pair zz_xy_ = Pair::Zero();

  friend struct Scatter;
};

}  // namespace foresight
