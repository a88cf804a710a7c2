#include "common/patch_merging.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <set>

namespace foresight {
namespace {

// Sets of patches that have become one plane: a union-find forest in which the larger absorbs the smaller.
struct Clusters {
  std::vector<PointSums> sums;   // by patch; of the whole cluster at its representative
  std::vector<int> parent;       // by patch

  void add(const PointSums& patch) {
    parent.push_back(static_cast<int>(sums.size()));
    sums.push_back(patch);
  }
  int representative(int patch) {
    while (parent[static_cast<std::size_t>(patch)] != patch) {
      int& up = parent[static_cast<std::size_t>(patch)];
      up = parent[static_cast<std::size_t>(up)];
      patch = up;
    }
    return patch;
  }
};

// Square patches on a grid over the image.
struct PatchGrid {
  int rows = 0;
  int columns = 0;
  int block = 0;
  std::vector<int> index;        // by position: patch, or -1
  std::vector<int> origin;       // by patch: its first cell
  Clusters clusters;

  [[nodiscard]] int at(int row, int column) const { return index[static_cast<std::size_t>(row * columns + column)]; }
};

// Nearly all cells free and valid, flat within the tolerance. A tenth may be missing: scanners drop single cells and columns.
bool collect_patch(const RangeImage& image, const std::vector<int>& labels, int first_cell, int block, double largest_mse,
                   PointSums& sums) {
  for (int r = 0; r < block; ++r) {
    for (int c = 0; c < block; ++c) {
      const int cell = first_cell + r * image.columns + c;
      if (labels[static_cast<std::size_t>(cell)] != 0) return false;
      if (image.valid(cell)) sums.add(image[cell].cast<double>());
    }
  }
  constexpr double kSmallestShare = 0.7;
  if (sums.count() < std::max(3.0, kSmallestShare * block * block)) return false;
  return sums.mean_squared_distance(sums.fit()) <= largest_mse;
}

PatchGrid make_patches(const RangeImage& image, const std::vector<int>& labels, int block, double largest_mse) {
  PatchGrid patches;
  patches.block = block;
  patches.rows = image.rows / block;
  patches.columns = image.columns / block;
  patches.index.assign(static_cast<std::size_t>(patches.rows * patches.columns), -1);
  for (int row = 0; row < patches.rows; ++row) {
    for (int column = 0; column < patches.columns; ++column) {
      PointSums sums;
      const int first_cell = image.cell(row * block, column * block);
      if (!collect_patch(image, labels, first_cell, block, largest_mse, sums)) continue;
      patches.index[static_cast<std::size_t>(row * patches.columns + column)] = static_cast<int>(patches.origin.size());
      patches.origin.push_back(first_cell);
      patches.clusters.add(sums);
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

Pair make_pair_of(Clusters& clusters, int a, int b) {
  const PointSums& in_a = clusters.sums[static_cast<std::size_t>(clusters.representative(a))];
  const PointSums& in_b = clusters.sums[static_cast<std::size_t>(clusters.representative(b))];
  return {common_error(in_a, in_b), a, b, in_a.count() + in_b.count()};
}

// Touching patches whose facing cells hold together, at least half of them.
bool touch(const CellConnectivity& connectivity, int first_cell, int step, int block, bool rightwards) {
  int together = 0;
  for (int i = 0; i < block; ++i) {
    const int cell = first_cell + i * step;
    together += (rightwards ? connectivity.right(cell) : connectivity.down(cell)) >= 0 ? 1 : 0;
  }
  return 2 * together >= block;
}

PairQueue neighbouring_pairs(const RangeImage& image, const CellConnectivity& connectivity, PatchGrid& patches) {
  PairQueue queue;
  const int block = patches.block;
  for (int row = 0; row < patches.rows; ++row) {
    for (int column = 0; column < patches.columns; ++column) {
      const int patch = patches.at(row, column);
      if (patch < 0) continue;
      const int origin = patches.origin[static_cast<std::size_t>(patch)];
      const int right = column + 1 < patches.columns ? patches.at(row, column + 1) : -1;
      if (right >= 0 && touch(connectivity, origin + block - 1, image.columns, block, true)) {
        queue.push(make_pair_of(patches.clusters, patch, right));
      }
      const int below = row + 1 < patches.rows ? patches.at(row + 1, column) : -1;
      if (below >= 0 && touch(connectivity, origin + (block - 1) * image.columns, 1, block, false)) {
        queue.push(make_pair_of(patches.clusters, patch, below));
      }
    }
  }
  return queue;
}

// Pairs whose clusters have grown since their error was computed are brought up to date when they come up, not before:
// a cluster has as many pairs as its outline has patches, and most never come up again.
void merge_best_first(Clusters& clusters, PairQueue queue, double largest_mse) {
  while (!queue.empty()) {
    const Pair top = queue.top();
    queue.pop();
    const int a = clusters.representative(top.a);
    const int b = clusters.representative(top.b);
    if (a == b) continue;
    PointSums& in_a = clusters.sums[static_cast<std::size_t>(a)];
    PointSums& in_b = clusters.sums[static_cast<std::size_t>(b)];
    if (in_a.count() + in_b.count() != top.stamp) {
      queue.push(make_pair_of(clusters, top.a, top.b));
      continue;
    }
    if (top.error > largest_mse) continue;
    const bool a_absorbs = in_a.count() != in_b.count() ? in_a.count() > in_b.count() : a < b;
    (a_absorbs ? in_a : in_b).add(a_absorbs ? in_b : in_a);
    clusters.parent[static_cast<std::size_t>(a_absorbs ? b : a)] = a_absorbs ? a : b;
  }
}

double largest_mse_of(const SegmentationOptions& options) {
  const double tolerance = options.merge_tolerance * options.plane_sigma;
  return tolerance * tolerance;
}

}  // namespace

CellConnectivity::CellConnectivity(const RangeImage& image, const SegmentationOptions& options)
    : columns_(image.columns), bits_(static_cast<std::size_t>(image.size()), 0) {
  const auto together = [&](int a, int b) {
    const Eigen::Vector3f step = image[b] - image[a];
    const double lateral = std::hypot(step.x(), step.y());
    return std::abs(step.z()) <= options.largest_depth_step * lateral + 4.0 * options.plane_sigma;
  };
  // Cells to the next valid one within `room`, 0 when there is none or a depth step lies between.
  const auto gap_to_next = [&](int cell, int stride, int room) -> unsigned {
    for (int gap = 1; gap <= std::min(2, room); ++gap) {
      const int next = cell + gap * stride;
      if (image.valid(next)) return together(cell, next) ? static_cast<unsigned>(gap) : 0U;
    }
    return 0U;
  };
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const int cell = image.cell(row, column);
      if (!image.valid(cell)) continue;
      const unsigned across = gap_to_next(cell, 1, image.columns - 1 - column);
      const unsigned below = gap_to_next(cell, image.columns, image.rows - 1 - row);
      bits_[static_cast<std::size_t>(cell)] = static_cast<unsigned char>(across | (below << 2));
    }
  }
}

std::vector<std::vector<int>> merge_patches(const RangeImage& image, const CellConnectivity& connectivity,
                                            const std::vector<int>& labels, int block, int fewest_cells,
                                            const SegmentationOptions& options) {
  const double largest_mse = largest_mse_of(options);
  PatchGrid patches = make_patches(image, labels, block, largest_mse);
  Clusters& clusters = patches.clusters;
  merge_best_first(clusters, neighbouring_pairs(image, connectivity, patches), largest_mse);

  std::vector<std::vector<int>> planes;
  std::vector<int> plane_of(clusters.sums.size(), -1);
  for (int patch = 0; patch < static_cast<int>(clusters.sums.size()); ++patch) {
    const auto top = static_cast<std::size_t>(clusters.representative(patch));
    if (clusters.sums[top].count() < fewest_cells) continue;
    if (plane_of[top] < 0) {
      plane_of[top] = static_cast<int>(planes.size());
      planes.emplace_back();
    }
    std::vector<int>& cells = planes[static_cast<std::size_t>(plane_of[top])];
    const int origin = patches.origin[static_cast<std::size_t>(patch)];
    for (int r = 0; r < block; ++r) {
      for (int c = 0; c < block; ++c) {
        const int cell = origin + r * image.columns + c;
        if (image.valid(cell)) cells.push_back(cell);
      }
    }
  }
  return planes;
}

void merge_regions(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                   std::vector<int>& labels) {
  const int count = *std::max_element(labels.begin(), labels.end());
  std::vector<PointSums> sums(static_cast<std::size_t>(count));
  std::set<std::pair<int, int>> touching;
  for (int cell = 0; cell < image.size(); ++cell) {
    const int own = labels[static_cast<std::size_t>(cell)];
    if (own == 0) continue;
    sums[static_cast<std::size_t>(own - 1)].add(image[cell].cast<double>());
    for (const int next : {connectivity.right(cell), connectivity.down(cell)}) {
      const int other = next < 0 ? 0 : labels[static_cast<std::size_t>(next)];
      if (other != 0 && other != own) touching.insert(std::minmax(own - 1, other - 1));
    }
  }
  Clusters clusters;
  for (const PointSums& region : sums) clusters.add(region);
  PairQueue queue;
  for (const auto& [a, b] : touching) queue.push(make_pair_of(clusters, a, b));
  merge_best_first(clusters, std::move(queue), largest_mse_of(options));
  for (int& label : labels) {
    if (label != 0) label = clusters.representative(label - 1) + 1;
  }
}

}  // namespace foresight
