// Best-first merging of square patches of the image into planes: the first half of region growing.
//
// After Feng, Taguchi, Kamat, "Fast plane extraction in organized point clouds using agglomerative hierarchical
// clustering", ICRA 2014, with pairs instead of patches in the queue: the neighbouring pair of least common fit error merges first.
#pragma once

#include <vector>

#include "common/plane_fit.h"
#include "common/range_image.h"
#include "common/segmentation.h"

namespace foresight {

// Which cells hold together: neighbours in a row or a column, both valid, no depth step between. A single cell without
// data in between is bridged, because scanners drop single cells and whole columns of a surface.
class CellConnectivity {
 public:
  CellConnectivity(const RangeImage& image, const SegmentationOptions& options);

  // The connected cell to the right of or below a cell, or -1.
  [[nodiscard]] int right(int cell) const { return step(cell, 0, 1); }
  [[nodiscard]] int down(int cell) const { return step(cell, 2, columns_); }

  // Calls visit(neighbour) for each of the up to four connected neighbours.
  template <typename Visit>
  void for_each_neighbour(int cell, Visit&& visit) const {
    if (const int next = right(cell); next >= 0) visit(next);
    if (const int next = down(cell); next >= 0) visit(next);
    for (int gap = 1; gap <= 2; ++gap) {
      if (cell % columns_ >= gap && right(cell - gap) == cell) visit(cell - gap);
      if (cell >= gap * columns_ && down(cell - gap * columns_) == cell) visit(cell - gap * columns_);
    }
  }

 private:
  [[nodiscard]] int step(int cell, int shift, int stride) const {
    const int gap = (bits_[static_cast<std::size_t>(cell)] >> shift) & 3;
    return gap == 0 ? -1 : cell + gap * stride;
  }

  int columns_;
  std::vector<unsigned char> bits_;  // bits 0-1: cells to the right neighbour, 0 = none; bits 2-3: the same downwards
};

// Merges patches of block x block cells among the cells of label 0, until no pair fits one plane within the merge
// tolerance. Returns the cells of each merged plane of at least `fewest_cells`, in deterministic order.
[[nodiscard]] std::vector<std::vector<int>> merge_patches(const RangeImage& image, const CellConnectivity& connectivity,
                                                          const std::vector<int>& labels, int block, int fewest_cells,
                                                          const SegmentationOptions& options);

// Merges touching regions of a label image (0 = none) that fit one plane within the merge tolerance: pieces of one face that
// grew from apart. Every label that occurs must stand for at least three cells.
void merge_regions(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                   std::vector<int>& labels);

}  // namespace foresight
