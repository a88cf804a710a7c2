#include "common/seed_patches.h"

#include <algorithm>

#include "common/flat_squares.h"

namespace foresight {
namespace {

// Whether the four blocks around one are of the same plane; beyond the grid there is no other plane.
bool inside(const Squares& blocks, const PoolVector<int>& plane_of, int row, int column) {
  const int own = plane_of[blocks.at(row, column)];
  const auto same = [&](int r, int c) {
    return r < 0 || c < 0 || r >= blocks.rows || c >= blocks.columns || plane_of[blocks.at(r, c)] == own;
  };
  return same(row - 1, column) && same(row + 1, column) && same(row, column - 1) && same(row, column + 1);
}

// Labels the cells of blocks, by block: plane or -1.
void label_blocks(const RangeImage& image, const Squares& blocks, int side, const PoolVector<int>& plane_of,
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
PoolVector<int> number_planes(const PoolVector<int>& merged, const PoolVector<PointSums>& sums, int fewest, int first) {
  PoolVector<int> plane_of(merged.size(), -1);
  for (std::size_t patch = 0; patch < merged.size(); ++patch) {
    if (merged[patch] == static_cast<int>(patch) && sums[patch].count() >= fewest) plane_of[patch] = first++;
  }
  PoolVector<int> numbered(merged.size());
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
  PoolVector<PointSums> patches;
  PoolVector<int> patch_of;  // by cell, -1 = none
  PoolVector<int> covered;   // cells, window by window
};

Windows flat_windows(const RangeImage& image, const SegmentationOptions& options, int side, const PlaneLabels& found) {
  Windows windows{{}, PoolVector<int>(found.labels.size(), -1), {}};
  const double flat = largest_rms(options) * largest_rms(options);
  // By cell: side of the largest square of free cells that ends there.
  PoolVector<unsigned char> room(found.labels.size(), 0);
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
      if (own_error(sums) > flat) continue;
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

PoolVector<std::pair<int, int>> touching_windows(const CellConnectivity& connectivity, const Windows& windows) {
  PoolVector<std::pair<int, int>> touching;
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
                  PlaneLabels& found, const Stop& stop) {
  const auto stopped = [&stop] { return stop && stop(); };
  const int side = options.seed_block;
  const Squares blocks = flat_blocks(image, options);
  if (stopped()) return;
  Patches patches = tile_with_squares(image, connectivity, options, blocks);
  if (stopped()) return;
  const PoolVector<int> merged = merge_best_first(patches.sums, patches.touching, largest_rms(options));
  if (stopped()) return;
  const PoolVector<int> plane_of_patch = number_planes(merged, patches.sums, fewest_cells(options, side), 0);

  PoolVector<int> plane_of(blocks.sums.size(), -1);
  for (std::size_t at = 0; at < plane_of.size(); ++at) {
    if (patches.patch_of[at] >= 0) plane_of[at] = plane_of_patch[static_cast<std::size_t>(patches.patch_of[at])];
  }
  const int planes = plane_of.empty() ? 0 : *std::max_element(plane_of.begin(), plane_of.end()) + 1;
  PoolVector<char> is_inside(plane_of.size(), 0);
  PoolVector<int> blocks_inside(static_cast<std::size_t>(planes), 0);
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
                  int side, PlaneLabels& found, const Stop& stop) {
  Windows windows = flat_windows(image, options, side, found);
  if (stop && stop()) return;
  const std::size_t before = found.planes.size();
  const PoolVector<int> merged =
      merge_best_first(windows.patches, touching_windows(connectivity, windows), largest_rms(options));
  const PoolVector<int> plane_of =
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
