#include "common/plane_fit.h"

#include <algorithm>
#include <cmath>

namespace foresight {

// The covariance of points: a symmetric matrix. Its eigenvalues and eigenvectors come from arithmetic and square roots
// alone, which give the same bits on every machine; the cosines of the usual closed form do not.
struct Scatter {
  static constexpr double kNothing = 1e-10;  // next to 1, of numbers of which hardly more than rounding is left

  double xx, yy, zz, xy, xz, yz;

  explicit Scatter(const PointSums& sums) {
    const double share = 1.0 / sums.count_;
    const double x = sums.xy_[0] * share, y = sums.xy_[1] * share, z = sums.z_ * share;
    xx = sums.xx_yy_[0] * share - x * x;
    yy = sums.xx_yy_[1] * share - y * y;
    zz = sums.zz_xy_[0] * share - z * z;
    xy = sums.zz_xy_[1] * share - x * y;
    xz = sums.xz_yz_[0] * share - x * z;
    yz = sums.xz_yz_[1] * share - y * z;
  }

  // Coefficients of the characteristic polynomial.
  [[nodiscard]] double trace() const { return xx + yy + zz; }
  [[nodiscard]] double minors() const { return (xx * yy - xy * xy) + (xx * zz - xz * xz) + (yy * zz - yz * yz); }
  [[nodiscard]] double determinant() const {
    return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  }

  // The smallest eigenvalue by Newton's method from 0: up to it the characteristic polynomial falls and is convex, so
  // the steps come from one side, and they are few because patches are thin.
  [[nodiscard]] double smallest() const {
    constexpr int kMostSteps = 40;
    const double c0 = determinant(), c1 = minors(), c2 = trace();
    if (c1 <= kNothing * c2 * c2) return 0.0;  // points on a line
    const double enough = 1e-8 * c1;           // next to the middle eigenvalue: the error left is the square of it
    double value = 0.0;
    for (int i = 0; i < kMostSteps; ++i) {
      const double slope = c1 - value * (2.0 * c2 - 3.0 * value);
      if (!(slope > 0.0)) break;  // two or three are the same
      const double step = (c0 - value * (c1 - value * (c2 - value))) / slope;
      value += step;
      if (std::abs(step) * c2 <= enough) break;
    }
    return value;
  }

  // Of the other two eigenvalues the smaller.
  [[nodiscard]] double middle() const {
    const double least = smallest();
    const double sum = trace() - least;
    const double product = minors() - least * sum;
    const double root = std::sqrt(std::max(0.0, sum * sum - 4.0 * product));
    return sum + root > 0.0 ? 2.0 * product / (sum + root) : 0.0;
  }

  // The unit eigenvector of an eigenvalue: the longest column of the adjugate of what is left without that. None is
  // long when two eigenvalues are the same; any direction across the points does then.
  [[nodiscard]] Eigen::Vector3d direction_of(double value) const {
    const double a = xx - value, b = yy - value, c = zz - value;
    const Eigen::Vector3d of_x(b * c - yz * yz, xz * yz - xy * c, xy * yz - b * xz);
    const Eigen::Vector3d of_y(of_x.y(), a * c - xz * xz, xy * xz - a * yz);
    const Eigen::Vector3d of_z(of_x.z(), of_y.z(), a * b - xy * xy);
    const double x = std::abs(of_x.x()), y = std::abs(of_y.y()), z = std::abs(of_z.z());
    const Eigen::Vector3d& longest = z >= x && z >= y ? of_z : (y >= x ? of_y : of_x);
    const double length = std::sqrt(longest.squaredNorm());
    if (length > kNothing * trace() * trace()) return longest / length;
    return across_line();
  }

 private:
  // A unit vector across the line that the points lie on, or any when they are one point.
  [[nodiscard]] Eigen::Vector3d across_line() const {
    const Eigen::Vector3d along = xx >= yy && xx >= zz ? Eigen::Vector3d(xx, xy, xz)
                                  : yy >= zz           ? Eigen::Vector3d(xy, yy, yz)
                                                       : Eigen::Vector3d(xz, yz, zz);
    const double length2 = along.squaredNorm();
    if (!(length2 > 0.0)) return Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d seed =
        along.z() * along.z() < 0.5 * length2 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    return (seed - (along.dot(seed) / length2) * along).normalized();
  }
};

Plane PointSums::fit() const {
  const Scatter scatter(*this);
  Plane plane;
  plane.normal = scatter.direction_of(scatter.smallest());
  plane.offset = plane.normal.dot(mean());
  if (plane.offset > 0.0) {
    plane.normal = -plane.normal;
    plane.offset = -plane.offset;
  }
  return plane;
}

double PointSums::narrow_spread() const { return std::max(0.0, Scatter(*this).middle()); }

double PointSums::mean_squared_distance(const Plane& plane) const {
  const Scatter scatter(*this);
  const Eigen::Vector3d& n = plane.normal;
  const double off = plane.distance(mean());
  const double spread = n.x() * (scatter.xx * n.x() + 2.0 * scatter.xy * n.y()) +
                        n.y() * (scatter.yy * n.y() + 2.0 * scatter.yz * n.z()) +
                        n.z() * (scatter.zz * n.z() + 2.0 * scatter.xz * n.x());
  return std::max(0.0, spread) + off * off;
}

}  // namespace foresight
