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
  void add(const Eigen::Vector3d& point) { add(point.x(), point.y(), point.z(), 1.0); }
  void remove(const Eigen::Vector3d& point) { add(point.x(), point.y(), point.z(), -1.0); }
  void add(const PointSums& other) {
    count_ += other.count_;
    x_ += other.x_;
    y_ += other.y_;
    z_ += other.z_;
    xx_ += other.xx_;
    yy_ += other.yy_;
    zz_ += other.zz_;
    xy_ += other.xy_;
    xz_ += other.xz_;
    yz_ += other.yz_;
  }

  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] Eigen::Vector3d mean() const { return Eigen::Vector3d(x_, y_, z_) / count_; }
  // Plane of least mean squared distance, its normal towards the origin (the sensor). REQUIRES: count() >= 3.
  [[nodiscard]] Plane fit() const;
  // Mean squared distance of the points from the line that fits them best, in the plane that does: how wide the narrow
  // side of a patch is. Unit: mm^2.
  [[nodiscard]] double narrow_spread() const;
  // Mean squared distance of the points from any plane. Unit: mm^2.
  [[nodiscard]] double mean_squared_distance(const Plane& plane) const;

 private:
  void add(double x, double y, double z, double weight) {
    count_ += weight;
    x_ += weight * x;
    y_ += weight * y;
    z_ += weight * z;
    xx_ += weight * x * x;
    yy_ += weight * y * y;
    zz_ += weight * z * z;
    xy_ += weight * x * y;
    xz_ += weight * x * z;
    yz_ += weight * y * z;
  }

  double count_ = 0.0;
  double x_ = 0.0, y_ = 0.0, z_ = 0.0;
  double xx_ = 0.0, yy_ = 0.0, zz_ = 0.0;
  double xy_ = 0.0, xz_ = 0.0, yz_ = 0.0;

  friend struct Scatter;
};

}  // namespace foresight
