#include "common/segmentation.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <string>

#include "common/errors.h"
#include "common/patch_merging.h"
#include "common/plane_fit.h"

namespace foresight {
namespace {

// Regions under construction: a label a cell, 0 = free, i + 1 = planes[i].
struct Growth {
  const RangeImage& image;
  const SegmentationOptions& options;
  CellConnectivity connectivity;
  std::vector<int> labels;
  std::vector<Plane> planes;

  [[nodiscard]] int& label(int cell) { return labels[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] double distance(int cell, int label) const {
    return std::abs(planes[static_cast<std::size_t>(label - 1)].distance(image[cell].cast<double>()));
  }
  [[nodiscard]] double reach() const { return options.grow_tolerance * options.plane_sigma; }
};

void add_planes(Growth& growth, const std::vector<std::vector<int>>& found) {
  for (const std::vector<int>& cells : found) {
    PointSums sums;
    for (const int cell : cells) sums.add(growth.image[cell].cast<double>());
    growth.planes.push_back(sums.fit());
    const int label = static_cast<int>(growth.planes.size());
    for (const int cell : cells) growth.label(cell) = label;
  }
}

// Best-first region growing by cells: of all free cells beside a region, the one nearest to that region's plane joins first.
void grow(Growth& growth) {
  struct Candidate {
    double distance;
    int cell, label;
    bool operator>(const Candidate& other) const {
      if (distance != other.distance) return distance > other.distance;
      return cell != other.cell ? cell > other.cell : label > other.label;
    }
  };
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
  const auto offer = [&](int cell, int label) {
    growth.connectivity.for_each_neighbour(cell, [&](int neighbour) {
      if (growth.label(neighbour) != 0) return;
      const double distance = growth.distance(neighbour, label);
      if (distance <= growth.reach()) queue.push({distance, neighbour, label});
    });
  };
  for (int cell = 0; cell < growth.image.size(); ++cell) {
    if (growth.label(cell) != 0) offer(cell, growth.label(cell));
  }
  while (!queue.empty()) {
    const Candidate best = queue.top();
    queue.pop();
    if (growth.label(best.cell) != 0) continue;
    growth.label(best.cell) = best.label;
    offer(best.cell, best.label);
  }
}

// Patches straddle creases and growth overruns them: a cell beside another region goes to the plane it is nearer to.
void settle_creases(Growth& growth) {
  constexpr int kMostPasses = 16;  // a pass moves a border by a cell; patches are at most 16 cells wide
  for (int pass = 0; pass < kMostPasses; ++pass) {
    std::vector<std::pair<int, int>> moves;
    for (int cell = 0; cell < growth.image.size(); ++cell) {
      const int own = growth.label(cell);
      if (own == 0) continue;
      int best = own;
      double nearest = growth.distance(cell, own);
      growth.connectivity.for_each_neighbour(cell, [&](int neighbour) {
        const int other = growth.label(neighbour);
        if (other == 0 || other == own) return;
        const double distance = growth.distance(cell, other);
        if (distance < nearest || (distance == nearest && other < best)) {
          nearest = distance;
          best = other;
        }
      });
      if (best != own) moves.emplace_back(cell, best);
    }
    if (moves.empty()) return;
    for (const auto& [cell, label] : moves) growth.label(cell) = label;
  }
}

// Planes from the cells as they stand now. Cells out of reach are set free.
void refit(Growth& growth) {
  std::vector<PointSums> sums(growth.planes.size());
  for (int cell = 0; cell < growth.image.size(); ++cell) {
    if (growth.label(cell) != 0) sums[static_cast<std::size_t>(growth.label(cell) - 1)].add(growth.image[cell].cast<double>());
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].count() >= 3) growth.planes[i] = sums[i].fit();
  }
  for (int cell = 0; cell < growth.image.size(); ++cell) {
    if (growth.label(cell) != 0 && growth.distance(cell, growth.label(cell)) > growth.reach()) growth.label(cell) = 0;
  }
}

// Splits regions into connected pieces; frees those that are too small.
std::vector<std::vector<int>> connected_pieces(Growth& growth) {
  std::vector<std::vector<int>> pieces;
  std::vector<bool> seen(static_cast<std::size_t>(growth.image.size()), false);
  for (int start = 0; start < growth.image.size(); ++start) {
    if (growth.label(start) == 0 || seen[static_cast<std::size_t>(start)]) continue;
    std::vector<int> piece = {start};
    seen[static_cast<std::size_t>(start)] = true;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      growth.connectivity.for_each_neighbour(piece[i], [&](int neighbour) {
        if (seen[static_cast<std::size_t>(neighbour)] || growth.label(neighbour) != growth.label(start)) return;
        seen[static_cast<std::size_t>(neighbour)] = true;
        piece.push_back(neighbour);
      });
    }
    if (static_cast<int>(piece.size()) >= growth.options.smallest_region) pieces.push_back(std::move(piece));
  }
  return pieces;
}

void keep_only(Growth& growth, const std::vector<std::vector<int>>& pieces) {
  std::fill(growth.labels.begin(), growth.labels.end(), 0);
  growth.planes.clear();
  add_planes(growth, pieces);
}

// One round: planes from patches of one size among the free cells, grown to their borders.
void extract_round(Growth& growth, int block) {
  const int fewest = std::max(2 * block * block, growth.options.smallest_region / 2);
  add_planes(growth, merge_patches(growth.image, growth.connectivity, growth.labels, block, fewest, growth.options));
  for (int repeat = 0; repeat < 2; ++repeat) {
    grow(growth);
    settle_creases(growth);
    refit(growth);
  }
  keep_only(growth, connected_pieces(growth));
  if (growth.planes.empty()) return;
  merge_regions(growth.image, growth.connectivity, growth.options, growth.labels);
  refit(growth);
  keep_only(growth, connected_pieces(growth));
}

Region make_region(const RangeImage& image, std::vector<int> cells) {
  std::sort(cells.begin(), cells.end());
  PointSums sums;
  for (const int cell : cells) sums.add(image[cell].cast<double>());
  const Plane plane = sums.fit();
  return {std::move(cells), plane.normal, plane.offset, std::sqrt(sums.mean_squared_distance(plane))};
}

void require(bool holds, const char* field, const char* limit) {
  if (!holds) throw UsageError(std::string("segmentation.") + field, "outside its limits", std::string("give ") + limit);
}

}  // namespace

bool operator==(const SegmentationOptions& a, const SegmentationOptions& b) {
  return a.plane_sigma == b.plane_sigma && a.merge_tolerance == b.merge_tolerance &&
         a.grow_tolerance == b.grow_tolerance && a.seed_block == b.seed_block &&
         a.smallest_region == b.smallest_region && a.largest_depth_step == b.largest_depth_step;
}

void check(const SegmentationOptions& options) {
  require(options.plane_sigma > 0 && std::isfinite(options.plane_sigma), "plane_sigma", "a positive number of mm");
  require(options.merge_tolerance > 1 && std::isfinite(options.merge_tolerance), "merge_tolerance", "a number above 1");
  require(options.grow_tolerance > 1 && std::isfinite(options.grow_tolerance), "grow_tolerance", "a number above 1");
  require(options.seed_block >= 2 && options.seed_block <= 16, "seed_block", "2 to 16 cells");
  require(options.smallest_region >= 3, "smallest_region", "at least 3 cells");
  require(options.largest_depth_step > 1 && std::isfinite(options.largest_depth_step), "largest_depth_step", "a number above 1");
}

SegmentationOptions segmentation_options_for(const SensorModel& sensor) {
  SegmentationOptions options;
  const double cell = sensor.working_distance() / std::sqrt(sensor.camera.fx * sensor.camera.fy);
  // Without any noise a plane would have to be perfect: a twenty-fifth of a cell is the floor.
  options.plane_sigma = std::max(sensor.depth_sigma(), 0.04 * cell);
  // The normal of a block of b x b cells is known to about sigma sqrt(12) / (b^2 cell) radians; seeds want 0.1 or better.
  const double block = std::sqrt(options.plane_sigma * std::sqrt(12.0) / (0.1 * cell));
  options.seed_block = std::clamp(static_cast<int>(std::ceil(block)), 3, 8);
  // Three such blocks make a plane whose normal is worth matching.
  options.smallest_region = std::max(12, static_cast<int>(std::ceil(3.0 * block * block)));
  return options;
}

std::vector<Region> segment(const RangeImage& image, const SegmentationOptions& options) {
  Growth growth{image, options, CellConnectivity(image, options), std::vector<int>(image.points.size(), 0), {}};
  extract_round(growth, options.seed_block);
  extract_round(growth, (options.seed_block + 1) / 2);  // thin and small faces between the large ones

  std::vector<Region> regions;
  for (std::vector<int>& piece : connected_pieces(growth)) regions.push_back(make_region(image, std::move(piece)));
  std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) {
    return a.cells.size() != b.cells.size() ? a.cells.size() > b.cells.size() : a.cells.front() < b.cells.front();
  });
  return regions;
}

std::vector<int> label_image(const std::vector<Region>& regions, int cells) {
  std::vector<int> labels(static_cast<std::size_t>(cells), 0);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    for (const int cell : regions[i].cells) labels[static_cast<std::size_t>(cell)] = static_cast<int>(i) + 1;
  }
  return labels;
}

}  // namespace foresight
