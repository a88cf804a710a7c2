#include "common/seed_patches.h"

#include <algorithm>

namespace foresight {
namespace {

double square(double x) { return x * x; }
double largest_rms(const SegmentationOptions& options) { return options.merge_tolerance * options.plane_sigma; }
double error_of(const PointSums& sums) { return fit_error(sums, sums.fit()); }

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

// Squares of the image on a grid, of one size.
struct Squares {
  int rows = 0;
  int columns = 0;
  std::vector<PointSums> sums;  // by position
  std::vector<double> error;    // by position: mean squared distance from the own plane; negative: not flat

  Squares(int rows_, int columns_)
      : rows(rows_),
        columns(columns_),
        sums(static_cast<std::size_t>(rows_ * columns_)),
        error(static_cast<std::size_t>(rows_ * columns_), -1.0) {}
  [[nodiscard]] std::size_t at(int row, int column) const { return static_cast<std::size_t>(row * columns + column); }
};

// Which blocks of the grid hold together with the one to the right and the one below: at least half of the facing cells
// do.
struct BlockLinks {
  std::vector<char> right, down;  // by position
};

BlockLinks link_blocks(const RangeImage& image, const CellConnectivity& connectivity, const Squares& blocks, int side) {
  BlockLinks links{std::vector<char>(blocks.sums.size(), 0), std::vector<char>(blocks.sums.size(), 0)};
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

// Nearly all cells valid, flat within the tolerance. Scanners drop single cells and columns.
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
      const double error = error_of(sums);
      if (error <= square(largest_rms(options))) blocks.error[at] = error;
    }
  }
  return blocks;
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
      double own_error = 0.0;
      bool flat = true;
      for (const std::size_t i : part) {
        flat = flat && parts.error[i] >= 0.0;
        sums.add(parts.sums[i]);
        own_error += parts.sums[i].count() * parts.error[i];
      }
      if (!flat || !hold_together(row, column)) continue;
      const double error = error_of(sums);
      if (error <= kHardlyWorse * own_error / sums.count() + floor) joined.error[joined.at(row, column)] = error;
    }
  }
  return joined;
}

// Patches of unequal size that tile the flat part of the grid.
struct Patches {
  std::vector<PointSums> sums;  // by patch
  std::vector<int> patch_of;    // by block: patch, or -1
};

Patches largest_squares(const std::vector<Squares>& sizes) {
  const Squares& blocks = sizes.front();
  Patches patches{{}, std::vector<int>(blocks.sums.size(), -1)};
  for (int level = static_cast<int>(sizes.size()) - 1; level >= 0; --level) {
    const Squares& squares = sizes[static_cast<std::size_t>(level)];
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
  return patches;
}

std::vector<std::pair<int, int>> touching_patches(const Squares& blocks, const BlockLinks& links,
                                                  const Patches& patches) {
  std::vector<std::pair<int, int>> touching;
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
  return touching;
}

// Whether the four blocks around one are of the same plane; beyond the grid there is no other plane.
bool inside(const Squares& blocks, const std::vector<int>& plane_of, int row, int column) {
  const int own = plane_of[blocks.at(row, column)];
  const auto same = [&](int r, int c) {
    return r < 0 || c < 0 || r >= blocks.rows || c >= blocks.columns || plane_of[blocks.at(r, c)] == own;
  };
  return same(row - 1, column) && same(row + 1, column) && same(row, column - 1) && same(row, column + 1);
}

// Labels the cells of blocks, by block: plane or -1.
void label_blocks(const RangeImage& image, const Squares& blocks, int side, const std::vector<int>& plane_of,
                  PlaneLabels& found) {
  for (int row = 0; row < blocks.rows; ++row) {
    for (int column = 0; column < blocks.columns; ++column) {
      const int plane = plane_of[blocks.at(row, column)];
      if (plane < 0) continue;
      found.sums[static_cast<std::size_t>(plane)].add(blocks.sums[blocks.at(row, column)]);
      for (int r = 0; r < side; ++r) {
        const int first = image.cell(row * side + r, column * side);
        for (int cell = first; cell < first + side; ++cell) {
          if (image.valid(cell)) found.labels[static_cast<std::size_t>(cell)] = plane + 1;
        }
      }
    }
  }
}

int fewest_cells(const SegmentationOptions& options, int side) {
  return std::max(2 * side * side, options.smallest_region / 2);
}

// Numbers the merged planes that are large enough from `first` on. By patch; -1 = too small.
std::vector<int> number_planes(const std::vector<int>& merged, const std::vector<PointSums>& sums, int fewest,
                               int first) {
  std::vector<int> plane_of(merged.size(), -1);
  for (std::size_t patch = 0; patch < merged.size(); ++patch) {
    if (merged[patch] == static_cast<int>(patch) && sums[patch].count() >= fewest) plane_of[patch] = first++;
  }
  std::vector<int> numbered(merged.size());
  for (std::size_t patch = 0; patch < merged.size(); ++patch)
    numbered[patch] = plane_of[static_cast<std::size_t>(merged[patch])];
  return numbered;
}

void fit_planes_from(std::size_t first, PlaneLabels& found) {
  found.planes.resize(found.sums.size());
  for (std::size_t i = first; i < found.sums.size(); ++i) found.planes[i] = found.sums[i].fit();
}

// Windows of free cells, and the cells they cover.
struct Windows {
  std::vector<PointSums> patches;
  std::vector<int> patch_of;  // by cell, -1 = none
  std::vector<int> covered;   // cells, window by window
};

Windows flat_windows(const RangeImage& image, const SegmentationOptions& options, int side, const PlaneLabels& found) {
  Windows windows{{}, std::vector<int>(found.labels.size(), -1), {}};
  // By cell: side of the largest square of free cells that ends there.
  std::vector<unsigned char> room(found.labels.size(), 0);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const int cell = image.cell(row, column);
      const auto at = static_cast<std::size_t>(cell);
      if (found.labels[at] != 0 || !image.valid(cell)) continue;
      room[at] = 1;
      if (row > 0 && column > 0) {
        const auto up = at - static_cast<std::size_t>(image.columns);
        room[at] = static_cast<unsigned char>(std::min(side, 1 + std::min({room[at - 1], room[up], room[up - 1]})));
      }
      if (room[at] < side) continue;
      const int first = cell - (side - 1) * (image.columns + 1);
      const PointSums sums = sums_of_square(image, first, side);
      if (error_of(sums) > square(largest_rms(options))) continue;
      for (int r = 0; r < side; ++r) {
        for (int c = first + r * image.columns; c < first + r * image.columns + side; ++c) {
          room[static_cast<std::size_t>(c)] = 0;
          windows.patch_of[static_cast<std::size_t>(c)] = static_cast<int>(windows.patches.size());
          windows.covered.push_back(c);
        }
      }
      windows.patches.push_back(sums);
    }
  }
  return windows;
}

std::vector<std::pair<int, int>> touching_windows(const CellConnectivity& connectivity, const Windows& windows) {
  std::vector<std::pair<int, int>> touching;
  for (const int cell : windows.covered) {
    for (const int next : {connectivity.right(cell), connectivity.down(cell)}) {
      if (next < 0) continue;
      const int a = windows.patch_of[static_cast<std::size_t>(cell)];
      const int b = windows.patch_of[static_cast<std::size_t>(next)];
      if (b >= 0 && a != b) touching.push_back(std::minmax(a, b));
    }
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  return touching;
}

}  // namespace

void seed_on_grid(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                  PlaneLabels& found) {
  const int side = options.seed_block;
  std::vector<Squares> sizes = {flat_blocks(image, options)};
  const BlockLinks links = link_blocks(image, connectivity, sizes.front(), side);
  for (int blocks_a_side = 1; std::min(sizes.back().rows, sizes.back().columns) >= 2; blocks_a_side *= 2) {
    sizes.push_back(join_fours(sizes.back(), blocks_a_side, links, sizes.front(), 0.05 * square(options.plane_sigma)));
  }
  const Squares& blocks = sizes.front();
  Patches patches = largest_squares(sizes);
  const std::vector<int> merged =
      merge_best_first(patches.sums, touching_patches(blocks, links, patches), largest_rms(options));
  const std::vector<int> plane_of_patch = number_planes(merged, patches.sums, fewest_cells(options, side), 0);

  std::vector<int> plane_of(blocks.sums.size(), -1);
  for (std::size_t at = 0; at < plane_of.size(); ++at) {
    if (patches.patch_of[at] >= 0) plane_of[at] = plane_of_patch[static_cast<std::size_t>(patches.patch_of[at])];
  }
  const int planes = plane_of.empty() ? 0 : *std::max_element(plane_of.begin(), plane_of.end()) + 1;
  std::vector<char> is_inside(plane_of.size(), 0);
  std::vector<int> blocks_inside(static_cast<std::size_t>(planes), 0);
  for (int row = 0; row < blocks.rows; ++row) {
    for (int column = 0; column < blocks.columns; ++column) {
      const std::size_t at = blocks.at(row, column);
      if (plane_of[at] < 0 || !inside(blocks, plane_of, row, column)) continue;
      is_inside[at] = 1;
      ++blocks_inside[static_cast<std::size_t>(plane_of[at])];
    }
  }
  constexpr int kEnoughInside = 2;
  for (std::size_t at = 0; at < plane_of.size(); ++at) {
    if (plane_of[at] >= 0 && is_inside[at] == 0 &&
        blocks_inside[static_cast<std::size_t>(plane_of[at])] >= kEnoughInside)
      plane_of[at] = -1;
  }
  found.sums.resize(static_cast<std::size_t>(planes));
  label_blocks(image, blocks, side, plane_of, found);
  fit_planes_from(0, found);
}

void seed_between(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                  int side, PlaneLabels& found) {
  Windows windows = flat_windows(image, options, side, found);
  const std::size_t before = found.planes.size();
  const std::vector<int> merged =
      merge_best_first(windows.patches, touching_windows(connectivity, windows), largest_rms(options));
  const std::vector<int> plane_of =
      number_planes(merged, windows.patches, fewest_cells(options, side), static_cast<int>(before));
  found.sums.resize(static_cast<std::size_t>(
      1 + std::max(static_cast<int>(before) - 1,
                   plane_of.empty() ? -1 : *std::max_element(plane_of.begin(), plane_of.end()))));
  for (const int cell : windows.covered) {
    const int plane = plane_of[static_cast<std::size_t>(windows.patch_of[static_cast<std::size_t>(cell)])];
    if (plane < 0) continue;
    found.labels[static_cast<std::size_t>(cell)] = plane + 1;
    found.sums[static_cast<std::size_t>(plane)].add(image[cell].cast<double>());
  }
  fit_planes_from(before, found);
}

}  // namespace foresight
