#include "common/patch_merging.h"

#include <cmath>
#include <queue>

namespace foresight {
namespace {

struct Patches {
  int rows = 0;
  int columns = 0;
  int block = 0;
  std::vector<int> index;        // by position on the patch grid: patch, or -1
  std::vector<PointSums> sums;   // by patch; of the whole cluster once it represents one
  std::vector<int> origin;       // by patch: its first cell
  std::vector<int> parent;       // by patch: union-find forest, larger clusters absorb smaller ones

  [[nodiscard]] int at(int row, int column) const { return index[static_cast<std::size_t>(row * columns + column)]; }
  int representative(int patch) {
    while (parent[static_cast<std::size_t>(patch)] != patch) {
      int& up = parent[static_cast<std::size_t>(patch)];
      up = parent[static_cast<std::size_t>(up)];
      patch = up;
    }
    return patch;
  }
};

// All cells free, valid and holding together, flat within the tolerance.
bool collect_patch(const RangeImage& image, const CellConnectivity& connectivity, const std::vector<int>& labels,
                   int first_cell, int block, double largest_mse, PointSums& sums) {
  for (int r = 0; r < block; ++r) {
    for (int c = 0; c < block; ++c) {
      const int cell = first_cell + r * image.columns + c;
      if (labels[static_cast<std::size_t>(cell)] != 0 || !image.valid(cell)) return false;
      if (c + 1 < block && !connectivity.right(cell)) return false;
      if (r + 1 < block && !connectivity.down(cell)) return false;
      sums.add(image[cell].cast<double>());
    }
  }
  return sums.mean_squared_distance(sums.fit()) <= largest_mse;
}

Patches make_patches(const RangeImage& image, const CellConnectivity& connectivity, const std::vector<int>& labels,
                     int block, double largest_mse) {
  Patches patches;
  patches.block = block;
  patches.rows = image.rows / block;
  patches.columns = image.columns / block;
  patches.index.assign(static_cast<std::size_t>(patches.rows * patches.columns), -1);
  for (int row = 0; row < patches.rows; ++row) {
    for (int column = 0; column < patches.columns; ++column) {
      PointSums sums;
      const int first_cell = image.cell(row * block, column * block);
      if (!collect_patch(image, connectivity, labels, first_cell, block, largest_mse, sums)) continue;
      const int patch = static_cast<int>(patches.sums.size());
      patches.index[static_cast<std::size_t>(row * patches.columns + column)] = patch;
      patches.sums.push_back(sums);
      patches.origin.push_back(first_cell);
      patches.parent.push_back(patch);
    }
  }
  return patches;
}

// The worse of the two parts' mean squared distances from their common plane: a small patch cannot hide in a large one.
double common_error(const PointSums& a, const PointSums& b) {
  PointSums both = a;
  both.add(b);
  const Plane plane = both.fit();
  return std::max(a.mean_squared_distance(plane), b.mean_squared_distance(plane));
}

struct Pair {
  double error;
  int a, b;       // patches that touch
  double stamp;   // cells of both clusters when the error was computed; a different number now means it is out of date

  bool operator>(const Pair& other) const {
    if (error != other.error) return error > other.error;
    return a != other.a ? a > other.a : b > other.b;
  }
};
using PairQueue = std::priority_queue<Pair, std::vector<Pair>, std::greater<>>;

Pair make_pair_of(Patches& patches, int a, int b) {
  const PointSums& in_a = patches.sums[static_cast<std::size_t>(patches.representative(a))];
  const PointSums& in_b = patches.sums[static_cast<std::size_t>(patches.representative(b))];
  return {common_error(in_a, in_b), a, b, in_a.count() + in_b.count()};
}

// Touching patches whose facing cells hold together, at least half of them.
bool touch(const CellConnectivity& connectivity, int first_cell, int step, int block, bool rightwards) {
  int together = 0;
  for (int i = 0; i < block; ++i) {
    const int cell = first_cell + i * step;
    together += (rightwards ? connectivity.right(cell) : connectivity.down(cell)) ? 1 : 0;
  }
  return 2 * together >= block;
}

PairQueue neighbouring_pairs(const RangeImage& image, const CellConnectivity& connectivity, Patches& patches) {
  PairQueue queue;
  const int block = patches.block;
  for (int row = 0; row < patches.rows; ++row) {
    for (int column = 0; column < patches.columns; ++column) {
      const int patch = patches.at(row, column);
      if (patch < 0) continue;
      const int origin = patches.origin[static_cast<std::size_t>(patch)];
      const int right = column + 1 < patches.columns ? patches.at(row, column + 1) : -1;
      if (right >= 0 && touch(connectivity, origin + block - 1, image.columns, block, true)) {
        queue.push(make_pair_of(patches, patch, right));
      }
      const int below = row + 1 < patches.rows ? patches.at(row + 1, column) : -1;
      if (below >= 0 && touch(connectivity, origin + (block - 1) * image.columns, 1, block, false)) {
        queue.push(make_pair_of(patches, patch, below));
      }
    }
  }
  return queue;
}

// Pairs whose clusters have grown since their error was computed are brought up to date when they come up, not before:
// a cluster has as many pairs as its outline has patches, and most never come up again.
void merge_best_first(Patches& patches, PairQueue queue, double largest_mse) {
  while (!queue.empty()) {
    const Pair top = queue.top();
    queue.pop();
    int a = patches.representative(top.a);
    int b = patches.representative(top.b);
    if (a == b) continue;
    PointSums& in_a = patches.sums[static_cast<std::size_t>(a)];
    PointSums& in_b = patches.sums[static_cast<std::size_t>(b)];
    if (in_a.count() + in_b.count() != top.stamp) {
      queue.push(make_pair_of(patches, top.a, top.b));
      continue;
    }
    if (top.error > largest_mse) continue;
    const bool a_absorbs = in_a.count() != in_b.count() ? in_a.count() > in_b.count() : a < b;
    (a_absorbs ? in_a : in_b).add(a_absorbs ? in_b : in_a);
    patches.parent[static_cast<std::size_t>(a_absorbs ? b : a)] = a_absorbs ? a : b;
  }
}

}  // namespace

CellConnectivity::CellConnectivity(const RangeImage& image, const SegmentationOptions& options)
    : columns_(image.columns), bits_(static_cast<std::size_t>(image.size()), 0) {
  const auto together = [&](int a, int b) {
    if (!image.valid(a) || !image.valid(b)) return false;
    const Eigen::Vector3f step = image[b] - image[a];
    const double lateral = std::hypot(step.x(), step.y());
    return std::abs(step.z()) <= options.largest_depth_step * lateral + 4.0 * options.plane_sigma;
  };
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const int cell = image.cell(row, column);
      unsigned char& bits = bits_[static_cast<std::size_t>(cell)];
      if (column + 1 < image.columns && together(cell, cell + 1)) bits |= 1U;
      if (row + 1 < image.rows && together(cell, cell + image.columns)) bits |= 2U;
    }
  }
}

std::vector<std::vector<int>> merge_patches(const RangeImage& image, const CellConnectivity& connectivity,
                                            const std::vector<int>& labels, int block, int fewest_cells,
                                            const SegmentationOptions& options) {
  const double tolerance = options.merge_tolerance * options.plane_sigma;
  const double largest_mse = tolerance * tolerance;
  Patches patches = make_patches(image, connectivity, labels, block, largest_mse);
  merge_best_first(patches, neighbouring_pairs(image, connectivity, patches), largest_mse);

  std::vector<std::vector<int>> planes;
  std::vector<int> plane_of(patches.sums.size(), -1);
  for (int patch = 0; patch < static_cast<int>(patches.sums.size()); ++patch) {
    const auto top = static_cast<std::size_t>(patches.representative(patch));
    if (patches.sums[top].count() < fewest_cells) continue;
    if (plane_of[top] < 0) {
      plane_of[top] = static_cast<int>(planes.size());
      planes.emplace_back();
    }
    std::vector<int>& cells = planes[static_cast<std::size_t>(plane_of[top])];
    const int origin = patches.origin[static_cast<std::size_t>(patch)];
    for (int r = 0; r < block; ++r) {
      for (int c = 0; c < block; ++c) cells.push_back(origin + r * image.columns + c);
    }
  }
  return planes;
}

}  // namespace foresight
