// Which cells of a range image lie on one surface with their neighbours.
#pragma once

#include <vector>

#include "common/range_image.h"
#include "common/segmentation.h"

namespace foresight {

// Which cells hold together: neighbours in a row or a column, both valid, no depth step between. A single cell without
// data in between is bridged, because scanners drop single cells and whole columns of a surface.
class CellConnectivity {
 public:
  CellConnectivity(const RangeImage& image, const SegmentationOptions& options);

  [[nodiscard]] int columns() const { return columns_; }

  // The connected cell to the right of, below, to the left of or above a cell, or -1.
  [[nodiscard]] int right(int cell) const { return step(cell, 0, 1); }
  [[nodiscard]] int down(int cell) const { return step(cell, 2, columns_); }
  [[nodiscard]] int left(int cell) const { return step(cell, 4, -1); }
  [[nodiscard]] int up(int cell) const { return step(cell, 6, -columns_); }

  // Calls visit(neighbour) for each of the up to four connected neighbours.
  template <typename Visit>
  void for_each_neighbour(int cell, Visit&& visit) const {
    if (const int next = right(cell); next >= 0) visit(next);
    if (const int next = down(cell); next >= 0) visit(next);
    if (const int next = left(cell); next >= 0) visit(next);
    if (const int next = up(cell); next >= 0) visit(next);
  }

 private:
  [[nodiscard]] int step(int cell, int shift, int stride) const {
    const int gap = (gaps_[static_cast<std::size_t>(cell)] >> shift) & 3;
    return gap == 0 ? -1 : cell + gap * stride;
  }

  int columns_;
  std::vector<unsigned char> gaps_;  // cells to the connected neighbour, 0 = none; two bits each: right, down, left, up
};

}  // namespace foresight
