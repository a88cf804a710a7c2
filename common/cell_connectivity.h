// Which cells of a range image lie on one surface with their neighbours.
#pragma once

#include "common/coordinates.h"
#include "common/memory_pool.h"
#include "common/segmentation.h"

namespace foresight {

// Which cells hold together: neighbours in a row or a column, both valid, no depth step between. A single cell without
// data in between is bridged, because scanners drop single cells and whole columns of a surface.
class CellConnectivity {
 public:
  CellConnectivity(const Coordinates& points, const SegmentationOptions& options);
  CellConnectivity(const RangeImage& image, const SegmentationOptions& options)
      : CellConnectivity(Coordinates(image), options) {}

  [[nodiscard]] int columns() const { return columns_; }

  // The connected cell to the right of, below, to the left of or above a cell, or -1.
  [[nodiscard]] int right(int cell) const { return step(cell, kRight, 1); }
  [[nodiscard]] int down(int cell) const { return step(cell, kDown, columns_); }
  [[nodiscard]] int left(int cell) const { return step(cell, kRight + kBackwards, -1); }
  [[nodiscard]] int up(int cell) const { return step(cell, kDown + kBackwards, -columns_); }

  // Whether any cell of a block is connected with another.
  [[nodiscard]] bool any_connected(int first) const;
  // Whether all cells of a block are with the very cells to the left and above.
  [[nodiscard]] bool all_linked_back(int first) const { return all_have(kForwards << kBackwards, first); }

  // Calls visit(neighbour) for each of the up to four connected neighbours.
  template <typename Visit>
  void for_each_neighbour(int cell, Visit&& visit) const {
    const int gaps = gaps_[static_cast<std::size_t>(cell)];  // read once, whatever visit() writes
    if (const int gap = gaps >> kRight & 3; gap > 0) visit(cell + gap);
    if (const int gap = gaps >> kDown & 3; gap > 0) visit(cell + gap * columns_);
    if (const int gap = gaps >> (kRight + kBackwards) & 3; gap > 0) visit(cell - gap);
    if (const int gap = gaps >> (kDown + kBackwards) & 3; gap > 0) visit(cell - gap * columns_);
  }

 private:
  // Where a cell's byte holds its two bits for the way to the right and down, and how much higher for the way back.
  static constexpr int kRight = 0, kDown = 2, kBackwards = 4;
  static constexpr int kForwards = 1 << kRight | 1 << kDown;  // connected to the very next cell both ways

  [[nodiscard]] int step(int cell, int shift, int stride) const {
    const int gap = (gaps_[static_cast<std::size_t>(cell)] >> shift) & 3;
    return gap == 0 ? -1 : cell + gap * stride;
  }
  [[nodiscard]] bool all_have(int gaps, int first) const;
  void link_small_steps(int first, int count, int stride, int shift, const unsigned char* is_small);
  void link(int cell, int gap, int shift, int stride);

  int columns_;
  PoolVector<unsigned char> gaps_;  // by cell: cells to the connected neighbour each way, 0 = none
};

}  // namespace foresight
