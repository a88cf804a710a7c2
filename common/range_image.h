// The range image: a grid of (x, y, z) with holes, as a light-stripe range finder delivers it (Section VI, last part).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "common/memory_pool.h"

namespace foresight {

inline constexpr int kSmallestImageSide = 32;
inline constexpr int kLargestImageSide = 4096;

// Sensor frame: x right, y down, z forward, origin at the camera centre. Unit: mm.
struct RangeImage {
  int rows = 0;
  int columns = 0;
  PoolVector<Eigen::Vector3f> points;  // row by row, size rows*columns; an invalid cell has NaN in all three

  RangeImage() = default;
  // An image of invalid cells.
  RangeImage(int rows, int columns);

  [[nodiscard]] int size() const { return rows * columns; }
  [[nodiscard]] int cell(int row, int column) const { return row * columns + column; }
  [[nodiscard]] bool valid(int cell) const { return !std::isnan(points[static_cast<std::size_t>(cell)].z()); }
  [[nodiscard]] const Eigen::Vector3f& operator[](int cell) const { return points[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] Eigen::Vector3f& operator[](int cell) { return points[static_cast<std::size_t>(cell)]; }
};

[[nodiscard]] int count_valid(const RangeImage& image);

}  // namespace foresight
