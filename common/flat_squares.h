// Squares of the image that lie on a plane.
#pragma once

#include <utility>

#include "common/memory_pool.h"
#include "common/patch_merging.h"

namespace foresight {

// No part of a plane is farther than this from it (rms), where the plane faces the sensor. Unit: mm.
[[nodiscard]] inline double largest_rms(const SegmentationOptions& options) {
  return options.merge_tolerance * options.plane_sigma;
}

// Of the valid cells of a square.
[[nodiscard]] PointSums sums_of_square(const RangeImage& image, int first_cell, int side);

// fit_error() about the points' own plane.
[[nodiscard]] double own_error(const PointSums& sums);

// Squares of the image on a grid, of one size.
struct Squares {
  int rows = 0;
  int columns = 0;
  PoolVector<PointSums> sums;  // by position
  PoolVector<double> error;    // by position: mean squared distance from the own plane; negative: not flat

  Squares(int rows_, int columns_)
      : rows(rows_),
        columns(columns_),
        sums(static_cast<std::size_t>(rows_ * columns_)),
        error(static_cast<std::size_t>(rows_ * columns_), -1.0) {}
  [[nodiscard]] std::size_t at(int row, int column) const { return static_cast<std::size_t>(row * columns + column); }
};

// Patches of unequal size that tile the flat part of a grid of blocks, and which of them touch.
struct Patches {
  PoolVector<PointSums> sums;                // by patch
  PoolVector<int> patch_of;                  // by block: patch, or -1
  PoolVector<std::pair<int, int>> touching;  // patches, the lower first; ascending
};

// Nearly all cells valid, flat within the tolerance. Scanners drop single cells and columns.
[[nodiscard]] Squares flat_blocks(const RangeImage& image, const SegmentationOptions& options);

// Blocks and larger squares of them: four squares that are one plane as well as each is alone make one of twice the
// size, and merging then starts from few patches.
[[nodiscard]] Patches tile_with_squares(const RangeImage& image, const CellConnectivity& connectivity,
                                        const SegmentationOptions& options, const Squares& blocks);

}  // namespace foresight
