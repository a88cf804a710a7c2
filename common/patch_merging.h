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

// Which cells hold together with their right and lower neighbours (both valid, no depth step between).
class CellConnectivity {
 public:
  CellConnectivity(const RangeImage& image, const SegmentationOptions& options);
  [[nodiscard]] bool right(int cell) const { return (bits_[static_cast<std::size_t>(cell)] & 1U) != 0; }
  [[nodiscard]] bool down(int cell) const { return (bits_[static_cast<std::size_t>(cell)] & 2U) != 0; }

  // Calls visit(neighbour) for each of the up to four connected neighbours.
  template <typename Visit>
  void for_each_neighbour(int cell, Visit&& visit) const {
    const int column = cell % columns_;
    if (right(cell)) visit(cell + 1);
    if (down(cell)) visit(cell + columns_);
    if (column > 0 && right(cell - 1)) visit(cell - 1);
    if (cell >= columns_ && down(cell - columns_)) visit(cell - columns_);
  }

 private:
  int columns_;
  std::vector<unsigned char> bits_;
};

// Merges patches of block x block cells among the cells of label 0, until no pair fits one plane within the merge
// tolerance. Returns the cells of each merged plane of at least `fewest_cells`, in deterministic order.
[[nodiscard]] std::vector<std::vector<int>> merge_patches(const RangeImage& image, const CellConnectivity& connectivity,
                                                          const std::vector<int>& labels, int block, int fewest_cells,
                                                          const SegmentationOptions& options);

}  // namespace foresight
