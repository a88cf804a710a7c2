// Rectangular faces laid over a region in its plane, edge to edge; for flush_faces.cpp only.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "runtime/flush_faces.h"

namespace foresight {

// Full lengths of a rectangular face. Unit: mm.
struct Rectangle {
  double along = 0.0;
  double across = 0.0;
};

// A grid in the plane of a region, along the directions in which most of the region's border runs.
struct PlaneGrid {
  Eigen::Vector3d origin, u, v;
  double step = 1.0;  // Unit: mm.
  int rows = 0, columns = 0;
  std::vector<char> filled;   // by node: the region's
  std::vector<char> unknown;  // by node: the face may go on there: data of another region in the plane, none, no image
  std::vector<char> behind;   // by node: nothing of the plane is there, the sensor saw something farther

  [[nodiscard]] std::size_t at(int row, int column) const { return static_cast<std::size_t>(row * columns + column); }
};

// Counts in rectangles of the grid; what lies beyond it is empty.
class GridCounts {
 public:
  GridCounts(const std::vector<char>& nodes, int rows, int columns)
      : rows_(rows), columns_(columns), sums_(static_cast<std::size_t>((rows + 1) * (columns + 1)), 0) {
    for (int row = 0; row < rows; ++row) {
      int of_row = 0;
      for (int column = 0; column < columns; ++column) {
        of_row += nodes[static_cast<std::size_t>(row * columns + column)];
        sums_[at(row + 1, column + 1)] = sums_[at(row, column + 1)] + of_row;
      }
    }
  }
  // first included, last not.
  [[nodiscard]] int in(int first_row, int last_row, int first_column, int last_column) const {
    const int top = std::clamp(first_row, 0, rows_);
    const int bottom = std::clamp(last_row, top, rows_);
    const int left = std::clamp(first_column, 0, columns_);
    const int right = std::clamp(last_column, left, columns_);
    return sums_[at(bottom, right)] - sums_[at(top, right)] - sums_[at(bottom, left)] + sums_[at(top, left)];
  }

 private:
  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row * (columns_ + 1) + column);
  }
  int rows_, columns_;
  std::vector<int> sums_;
};

// A face laid on the grid: first included, last not. Both may lie beyond the grid.
struct Tile {
  int first_row = 0, last_row = 0, first_column = 0, last_column = 0;
  double value = 0.0;     // how well it sits: share filled and share of the outline at which nothing goes on
  double outline = 0.0;   // of it, where the region itself ends
  double seen_end = 0.0;  // of it, where something farther is seen beyond

  [[nodiscard]] int rows() const { return last_row - first_row; }
  [[nodiscard]] int columns() const { return last_column - first_column; }
  [[nodiscard]] int area() const { return rows() * columns(); }
  [[nodiscard]] bool holds(int row, int column) const {
    return row >= first_row && row < last_row && column >= first_column && column < last_column;
  }
};

// What a sensor leaves open about outlines. Unit: nodes of the grid.
struct OutlineDoubt {
  int margin = 1;  // that the outline of a region is uncertain by. Limit: >= 1.
  int loss = 0;    // that a region ends before its face does, at steps in depth
};

// The layout that explains the whole region best, with faces of one size or of any. Where there is none, the faces that
// the outline of the region speaks for by itself; maybe none.
[[nodiscard]] std::vector<Tile> lay_faces(const PlaneGrid& grid, const std::vector<Rectangle>& faces,
                                          const OutlineDoubt& doubt, const FlushFaceOptions& options);

}  // namespace foresight
