#include "common/segmentation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/border_settling.h"
#include "common/cell_connectivity.h"
#include "common/errors.h"
#include "common/patch_merging.h"
#include "common/plane_splitting.h"
#include "common/region_growth.h"
#include "common/seed_patches.h"

namespace foresight {
namespace {

// From seeds to planes grown to their borders. Whether it came to its end.
bool finish_round(const RangeImage& image, const Coordinates& points, const CellConnectivity& connectivity,
                  const SegmentationOptions& options, PlaneLabels& found, const Stop& stop) {
  const auto grow = [&] { grow_planes(image, connectivity, options, found, stop); };
  const auto settle = [&] { settle_borders(image, connectivity, options, found, stop); };
  const auto refit = [&] { refit_planes(points, options, found); };
  const auto split = [&] { split_planes(image, connectivity, options, found); };
  const auto merge = [&] { merge_touching_planes(connectivity, options, found); };
  bool whole = true;
  const auto unless_stopped = [&](const auto& step) {
    whole = whole && !(stop && stop());
    if (whole) step();
  };
  unless_stopped(grow);
  unless_stopped(settle);
  unless_stopped(refit);
  unless_stopped(split);
  unless_stopped(merge);
  unless_stopped(settle);
  unless_stopped(refit);
  unless_stopped(grow);
  return whole;
}

// Regions of the planes' cells, without those that the last fit has put out of reach.
PoolVector<Region> regions_of(const Coordinates& points, const SegmentationOptions& options, const PlaneLabels& found) {
  PoolVector<Region> regions(found.planes.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Plane& plane = found.planes[i];
    regions[i] = {{}, plane.normal, plane.offset, std::sqrt(found.sums[i].mean_squared_distance(plane))};
    regions[i].cells.reserve(static_cast<std::size_t>(found.sums[i].count()));
  }
  const PoolVector<ReachTest> within_reach = reach_tests(points, options, found.planes);
  const int* labels = found.labels.data();
  const auto take_block = [&](int first) {
    const int label = labels[first];
    if (!all_are(label, labels + first)) return false;
    if (label == 0) return true;
    const auto i = static_cast<std::size_t>(label - 1);
    if (!within_reach[i].holds_for_block(first)) return false;
    for (int cell = first; cell < first + kBlock; ++cell) regions[i].cells.push_back(cell);
    return true;
  };
  visit_cells(0, points.size(), take_block, [&](int cell) {
    if (labels[cell] == 0) return;
    const auto i = static_cast<std::size_t>(labels[cell] - 1);
    if (within_reach[i].holds(cell)) regions[i].cells.push_back(cell);
  });
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

PoolVector<Region> segment(const RangeImage& image, const SegmentationOptions& options, const Stop& stop) {
  const auto stopped = [&stop] { return stop && stop(); };
  const Coordinates points(image);
  const CellConnectivity connectivity(points, options);
  PlaneLabels found(image.size());
  if (stopped()) return {};
  seed_on_grid(image, connectivity, options, found, stop);
  if (!finish_round(image, points, connectivity, options, found, stop)) return {};
  seed_between(image, connectivity, options, (options.seed_block + 1) / 2, found,
               stop);  // thin and small faces between the large ones
  if (!finish_round(image, points, connectivity, options, found, stop)) return {};

  split_planes(image, connectivity, options, found);
  if (stopped()) return {};

  PoolVector<Region> regions = regions_of(points, options, found);
  std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) {
    return a.cells.size() != b.cells.size() ? a.cells.size() > b.cells.size() : a.cells.front() < b.cells.front();
  });
  return regions;
}

PoolVector<int> label_image(const PoolVector<Region>& regions, int cells) {
  PoolVector<int> labels(static_cast<std::size_t>(cells), 0);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    for (const int cell : regions[i].cells) labels[static_cast<std::size_t>(cell)] = static_cast<int>(i) + 1;
  }
  return labels;
}

}  // namespace foresight
