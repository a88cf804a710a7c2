#include "common/coordinates.h"

#include <algorithm>

namespace foresight {

Coordinates::Coordinates(const RangeImage& image)
    : rows(image.rows),
      columns(image.columns),
      x(image.points.size()),
      y(image.points.size()),
      z(image.points.size()),
      largest(0.0F) {
  std::array<float, kBlock> block{};
  const auto size = image.points.size();
  for (std::size_t first = 0; first < size; first += kBlock) {
    const std::size_t end = std::min(size, first + kBlock);
    for (std::size_t at = first; at < end; ++at) {
      x[at] = image.points[at].x();
      y[at] = image.points[at].y();
      z[at] = image.points[at].z();
    }
    for (std::size_t at = first; at < end; ++at) {
      // Not std::max: this one is false for NaN.
      const float most = std::max(std::abs(x[at]), std::max(std::abs(y[at]), std::abs(z[at])));
      block[at - first] = most > block[at - first] ? most : block[at - first];
    }
  }
  largest = *std::max_element(block.begin(), block.end());
}

bool Coordinates::any_valid(int first) const {
  int any = 0;
  for (int i = 0; i < kBlock; ++i) any |= valid(first + i) ? 1 : 0;
  return any != 0;
}

ReachTest::ReachTest(const Coordinates& points, const Plane& plane, double reach)
    : points_(points),
      plane_(plane),
      reach_(reach),
      normal_{static_cast<float>(plane.normal.x()), static_cast<float>(plane.normal.y()),
              static_cast<float>(plane.normal.z())},
      offset_(static_cast<float>(plane.offset)),
      // Rounding of the normal, the offset, the products and the sums: below 12.8 x 2^-24 of the largest number, and
      // neither a point nor a plane among the points is farther away than sqrt(3) of the largest coordinate.
      sure_reach_(static_cast<float>(reach) - 2e-6F * points.largest) {}

bool ReachTest::holds_for_block(int first) const {
  const float* x = points_.x.data() + first;
  const float* y = points_.y.data() + first;
  const float* z = points_.z.data() + first;
  int outside = 0;
  for (int i = 0; i < kBlock; ++i) {
    const float distance = normal_[0] * x[i] + normal_[1] * y[i] + normal_[2] * z[i] - offset_;
    outside |= std::abs(distance) > sure_reach_ ? 1 : 0;
  }
  return outside == 0;
}

}  // namespace foresight
