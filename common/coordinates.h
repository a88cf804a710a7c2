// The coordinates of an image's data points apart from one another, as loops over many cells want them.
#pragma once

#include <array>
#include <cmath>

#include "common/cell_blocks.h"
#include "common/memory_pool.h"
#include "common/plane_fit.h"
#include "common/range_image.h"

namespace foresight {

struct Coordinates {
  int rows;
  int columns;
  PoolVector<float> x, y, z;  // by cell, NaN where it is invalid. Unit: mm.
  float largest;              // absolute value. Unit: mm.

  explicit Coordinates(const RangeImage& image);

  [[nodiscard]] int size() const { return rows * columns; }
  [[nodiscard]] bool valid(int cell) const { return !std::isnan(z[static_cast<std::size_t>(cell)]); }
  // Whether any cell of a block is.
  [[nodiscard]] bool any_valid(int first) const;
  [[nodiscard]] Eigen::Vector3d operator[](int cell) const {
    const auto at = static_cast<std::size_t>(cell);
    return {x[at], y[at], z[at]};
  }
};

// Which data points are not farther from a plane than its reach.
class ReachTest {
 public:
  ReachTest(const Coordinates& points, const Plane& plane, double reach);

  [[nodiscard]] bool holds(int cell) const { return std::abs(plane_.distance(points_[cell])) <= reach_; }
  // Whether it surely holds for a block of cells; false may be wrong.
  [[nodiscard]] bool holds_for_block(int first) const;

 private:
  const Coordinates& points_;
  Plane plane_;
  double reach_;
  std::array<float, 3> normal_;
  float offset_;
  float sure_reach_;  // less what single precision may err
};

}  // namespace foresight
