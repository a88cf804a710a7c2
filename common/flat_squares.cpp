#include "common/flat_squares.h"

#include <algorithm>

namespace foresight {
namespace {

double square(double x) { return x * x; }

// Which blocks of the grid hold together with the one to the right and the one below: at least half of the facing cells
// do.
struct BlockLinks {
  PoolVector<char> right, down;  // by position
};

BlockLinks link_blocks(const RangeImage& image, const CellConnectivity& connectivity, const Squares& blocks, int side) {
  BlockLinks links{PoolVector<char>(blocks.sums.size(), 0), PoolVector<char>(blocks.sums.size(), 0)};
  for (int row = 0; row < blocks.rows; ++row) {
    for (int column = 0; column < blocks.columns; ++column) {
      const int last = side - 1;
      int rightwards = 0, downwards = 0;
      for (int i = 0; i < side; ++i) {
        rightwards += connectivity.right(image.cell(row * side + i, column * side + last)) >= 0 ? 1 : 0;
        downwards += connectivity.down(image.cell(row * side + last, column * side + i)) >= 0 ? 1 : 0;
      }
      links.right[blocks.at(row, column)] = column + 1 < blocks.columns && 2 * rightwards >= side ? 1 : 0;
      links.down[blocks.at(row, column)] = row + 1 < blocks.rows && 2 * downwards >= side ? 1 : 0;
    }
  }
  return links;
}

// Four squares, each of side x side blocks, that are one plane as well as each is alone make a larger square; merging
// then starts from few patches.
Squares join_fours(const Squares& parts, int side, const BlockLinks& links, const Squares& blocks, double floor) {
  constexpr double kHardlyWorse = 1.25;
  Squares joined(parts.rows / 2, parts.columns / 2);
  const auto hold_together = [&](int row, int column) {
    for (int i = 0; i < 2 * side; ++i) {
      const std::size_t across = blocks.at(2 * row * side + i, 2 * column * side + side - 1);
      const std::size_t below = blocks.at(2 * row * side + side - 1, 2 * column * side + i);
      if (links.right[across] == 0 || links.down[below] == 0) return false;
    }
    return true;
  };
  for (int row = 0; row < joined.rows; ++row) {
    for (int column = 0; column < joined.columns; ++column) {
      const std::size_t part[] = {parts.at(2 * row, 2 * column), parts.at(2 * row, 2 * column + 1),
                                  parts.at(2 * row + 1, 2 * column), parts.at(2 * row + 1, 2 * column + 1)};
      PointSums& sums = joined.sums[joined.at(row, column)];
      double error_of_parts = 0.0;
      bool flat = true;
      for (const std::size_t i : part) {
        flat = flat && parts.error[i] >= 0.0;
        sums.add(parts.sums[i]);
        error_of_parts += parts.sums[i].count() * parts.error[i];
      }
      if (!flat || !hold_together(row, column)) continue;
      const double error = own_error(sums);
      if (error <= kHardlyWorse * error_of_parts / sums.count() + floor) joined.error[joined.at(row, column)] = error;
    }
  }
  return joined;
}

// The largest squares first.
void tile(const Squares& blocks, const PoolVector<Squares>& joined, Patches& patches) {
  patches.patch_of.assign(blocks.sums.size(), -1);
  for (int level = static_cast<int>(joined.size()); level >= 0; --level) {
    const Squares& squares = level == 0 ? blocks : joined[static_cast<std::size_t>(level - 1)];
    const int side = 1 << level;
    for (int row = 0; row < squares.rows; ++row) {
      for (int column = 0; column < squares.columns; ++column) {
        if (squares.error[squares.at(row, column)] < 0.0) continue;
        if (patches.patch_of[blocks.at(row * side, column * side)] >= 0) continue;
        for (int r = 0; r < side; ++r) {
          const auto first = patches.patch_of.begin() + static_cast<long>(blocks.at(row * side + r, column * side));
          std::fill(first, first + side, static_cast<int>(patches.sums.size()));
        }
        patches.sums.push_back(squares.sums[squares.at(row, column)]);
      }
    }
  }
}

void find_touching(const Squares& blocks, const BlockLinks& links, Patches& patches) {
  PoolVector<std::pair<int, int>>& touching = patches.touching;
  const auto touch = [&](std::size_t a, std::size_t b) {
    const int in_a = patches.patch_of[a];
    const int in_b = patches.patch_of[b];
    if (in_a >= 0 && in_b >= 0 && in_a != in_b) touching.push_back(std::minmax(in_a, in_b));
  };
  for (std::size_t at = 0; at < blocks.sums.size(); ++at) {
    if (links.right[at] != 0) touch(at, at + 1);
    if (links.down[at] != 0) touch(at, at + static_cast<std::size_t>(blocks.columns));
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
}

}  // namespace

PointSums sums_of_square(const RangeImage& image, int first_cell, int side) {
  PointSums sums;
  for (int r = 0; r < side; ++r) {
    for (int cell = first_cell + r * image.columns; cell < first_cell + r * image.columns + side; ++cell) {
      if (image.valid(cell)) sums.add(image[cell].cast<double>());
    }
  }
  const PointSums result = sums;  // the sums themselves stay in registers
  return result;
}

double own_error(const PointSums& sums) { return fit_error(sums, sums.fit()); }

Squares flat_blocks(const RangeImage& image, const SegmentationOptions& options) {
  constexpr double kSmallestShare = 0.7;
  const int side = options.seed_block;
  Squares blocks(image.rows / side, image.columns / side);
  for (int row = 0; row < blocks.rows; ++row) {
    for (int column = 0; column < blocks.columns; ++column) {
      const std::size_t at = blocks.at(row, column);
      PointSums& sums = blocks.sums[at];
      sums = sums_of_square(image, image.cell(row * side, column * side), side);
      if (sums.count() < std::max(3.0, kSmallestShare * side * side)) continue;
      const double error = own_error(sums);
      if (error <= square(largest_rms(options))) blocks.error[at] = error;
    }
  }
  return blocks;
}

Patches tile_with_squares(const RangeImage& image, const CellConnectivity& connectivity,
                          const SegmentationOptions& options, const Squares& blocks) {
  const BlockLinks links = link_blocks(image, connectivity, blocks, options.seed_block);
  const double floor = 0.05 * square(options.plane_sigma);
  PoolVector<Squares> joined;  // by how often the side was doubled
  const Squares* largest = &blocks;
  for (int side = 1; std::min(largest->rows, largest->columns) >= 2; side *= 2) {
    joined.push_back(join_fours(*largest, side, links, blocks, floor));
    largest = &joined.back();
  }
  Patches patches;
  tile(blocks, joined, patches);
  find_touching(blocks, links, patches);
  return patches;
}

}  // namespace foresight
