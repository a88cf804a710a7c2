#include "common/segmentation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/border_settling.h"
#include "common/cell_connectivity.h"
#include "common/errors.h"
#include "common/patch_merging.h"
#include "common/region_growth.h"
#include "common/seed_patches.h"

namespace foresight {
namespace {

// Connected pieces of the planes, by cell: -1 = none. Numbered in the order of their first cells.
struct Pieces {
  std::vector<int> piece_of;
  std::vector<int> cells;  // by piece
};

Pieces connected_pieces(const CellConnectivity& connectivity, const PlaneLabels& found) {
  // A union-find forest of cells whose roots are the first cells of the pieces.
  std::vector<int> parent(found.labels.size(), -1);
  const auto root_of = [&](int cell) {
    while (parent[static_cast<std::size_t>(cell)] != cell) {
      int& up = parent[static_cast<std::size_t>(cell)];
      up = parent[static_cast<std::size_t>(up)];
      cell = up;
    }
    return cell;
  };
  for (int cell = 0; cell < static_cast<int>(parent.size()); ++cell) {
    const auto at = static_cast<std::size_t>(cell);
    if (found.labels[at] == 0) continue;
    parent[at] = cell;
    const auto join = [&](int before) {
      if (before < 0 || found.labels[static_cast<std::size_t>(before)] != found.labels[at]) return;
      const int a = root_of(before);
      const int b = root_of(cell);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    };
    join(connectivity.left(cell));
    join(connectivity.up(cell));
  }
  Pieces pieces{std::move(parent), {}};
  for (std::size_t at = 0; at < pieces.piece_of.size(); ++at) {  // a parent always comes before its children
    int& own = pieces.piece_of[at];
    if (own < 0) continue;
    if (own == static_cast<int>(at)) {
      own = static_cast<int>(pieces.cells.size());
      pieces.cells.push_back(1);
    } else {
      own = pieces.piece_of[static_cast<std::size_t>(own)];
      ++pieces.cells[static_cast<std::size_t>(own)];
    }
  }
  return pieces;
}

// Every connected piece becomes a plane of its own. Pieces that are too small or not steady are free again.
void split_planes(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                  PlaneLabels& found) {
  const Pieces pieces = connected_pieces(connectivity, found);
  const auto is_large = [&](int piece) {
    return piece >= 0 && pieces.cells[static_cast<std::size_t>(piece)] >= options.smallest_region;
  };
  // The first piece of a plane, mostly all of it, has the sums of the plane less those of the other pieces.
  std::vector<PointSums> sums(pieces.cells.size());
  std::vector<int> first_piece(found.planes.size(), -1);
  for (std::size_t at = 0; at < found.labels.size(); ++at) {
    const int piece = pieces.piece_of[at];
    if (piece < 0) continue;
    const auto plane = static_cast<std::size_t>(found.labels[at] - 1);
    if (first_piece[plane] < 0) {
      first_piece[plane] = piece;
      sums[static_cast<std::size_t>(piece)] = found.sums[plane];
    }
    if (first_piece[plane] == piece) continue;
    const Eigen::Vector3d point = image.points[at].cast<double>();
    sums[static_cast<std::size_t>(first_piece[plane])].remove(point);
    sums[static_cast<std::size_t>(piece)].add(point);
  }
  found.planes.clear();
  found.sums.clear();
  std::vector<int> label_of(sums.size(), 0);
  for (std::size_t piece = 0; piece < sums.size(); ++piece) {
    if (!is_large(static_cast<int>(piece))) continue;
    const Plane plane = sums[piece].fit();
    if (!is_steady(sums[piece], plane, options)) continue;
    found.sums.push_back(sums[piece]);
    found.planes.push_back(plane);
    label_of[piece] = static_cast<int>(found.planes.size());
  }
  for (std::size_t at = 0; at < found.labels.size(); ++at) {
    const int piece = pieces.piece_of[at];
    found.labels[at] = piece < 0 ? 0 : label_of[static_cast<std::size_t>(piece)];
  }
}

// From seeds to planes grown to their borders.
void finish_round(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                  PlaneLabels& found) {
  grow_planes(image, connectivity, options, found);
  settle_borders(image, connectivity, options, found);
  refit_planes(image, options, found);
  split_planes(image, connectivity, options, found);
  merge_touching_planes(connectivity, options, found);
  settle_borders(image, connectivity, options, found);
  refit_planes(image, options, found);
  grow_planes(image, connectivity, options, found);
}

// Regions of the planes' cells, without those that the last fit has put out of reach.
std::vector<Region> regions_of(const RangeImage& image, const SegmentationOptions& options, const PlaneLabels& found) {
  std::vector<Region> regions(found.planes.size());
  std::vector<double> reach(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Plane& plane = found.planes[i];
    regions[i] = {{}, plane.normal, plane.offset, std::sqrt(found.sums[i].mean_squared_distance(plane))};
    regions[i].cells.reserve(static_cast<std::size_t>(found.sums[i].count()));
    reach[i] = options.grow_tolerance * options.plane_sigma * relative_noise(plane);
  }
  for (int cell = 0; cell < image.size(); ++cell) {
    const int label = found.labels[static_cast<std::size_t>(cell)];
    if (label == 0) continue;
    const auto i = static_cast<std::size_t>(label - 1);
    if (std::abs(found.planes[i].distance(image[cell].cast<double>())) <= reach[i]) regions[i].cells.push_back(cell);
  }
  return regions;
}

void require(bool holds, const char* field, const char* limit) {
  if (!holds)
    throw UsageError(std::string("segmentation.") + field, "outside its limits", std::string("give ") + limit);
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
  require(options.largest_depth_step > 1 && std::isfinite(options.largest_depth_step), "largest_depth_step",
          "a number above 1");
}

SegmentationOptions segmentation_options_for(const SensorModel& sensor) {
  SegmentationOptions options;
  const double cell = sensor.working_distance() / std::sqrt(sensor.camera.fx * sensor.camera.fy);
  // Without any noise a plane would have to be perfect: a twenty-fifth of a cell is the floor.
  options.plane_sigma = std::max(sensor.depth_sigma(), 0.04 * cell);
  // The normal of a block of b x b cells is known to about sigma sqrt(12) / (b^2 cell) radians; seeds want 0.1 or
  // better.
  const double block = std::sqrt(options.plane_sigma * std::sqrt(12.0) / (kNormalAccuracy * cell));
  options.seed_block = std::clamp(static_cast<int>(std::ceil(block)), 3, 8);
  // Three such blocks make a plane whose normal is worth matching.
  options.smallest_region = std::max(12, static_cast<int>(std::ceil(3.0 * block * block)));
  return options;
}

std::vector<Region> segment(const RangeImage& image, const SegmentationOptions& options) {
  const CellConnectivity connectivity(image, options);
  PlaneLabels found(image.size());
  seed_on_grid(image, connectivity, options, found);
  finish_round(image, connectivity, options, found);
  seed_between(image, connectivity, options, (options.seed_block + 1) / 2,
               found);  // thin and small faces between the large ones
  finish_round(image, connectivity, options, found);

  split_planes(image, connectivity, options, found);

  std::vector<Region> regions = regions_of(image, options, found);
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
