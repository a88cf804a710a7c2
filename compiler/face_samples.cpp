#include "compiler/face_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <numbers>
#include <set>

#include "common/viewing_sphere.h"

namespace foresight {
namespace {

// The model alone, centred on the optical axis, seen from one direction: distance and turn about the axis are drawn, so
// that the grid meets the faces at every angle. The paper states one distance; a sensor of one distance gives just
// that.
SimulatedScan view_scan(const CadModel& model, const Eigen::Vector3d& direction, const SensorModel& sensor,
                        Random random) {
  const PlacedObject object{&model, sampled_pose(model, direction, sensor, random)};
  return SimulatedScene(std::span(&object, 1)).scan(sensor, random);
}

}  // namespace

Pose sampled_pose(const CadModel& model, const Eigen::Vector3d& direction, const SensorModel& sensor, Random& random) {
  const double distance = random.uniform(sensor.nearest_distance, sensor.farthest_distance);
  const double roll = random.uniform(0.0, 2.0 * std::numbers::pi);
  return view_pose(direction, 0.5 * (model.lowest() + model.highest()), distance, roll);
}

std::vector<RegionFace> pair_regions_with_faces(const PoolVector<DescribedRegion>& regions,
                                                const std::vector<CellLabel>& labels, double smallest_share) {
  std::vector<RegionFace> pairs;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const PoolVector<int>& cells = regions[i].region.cells;
    std::map<int, int> votes;
    for (const int cell : cells) ++votes[labels[static_cast<std::size_t>(cell)].face];
    const auto most =
        std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == votes.end() || most->first < 0) continue;
    if (most->second >= smallest_share * static_cast<double>(cells.size())) {
      pairs.push_back({static_cast<int>(i), most->first});
    }
  }
  return pairs;
}

ViewSample view_sample(const PoolVector<DescribedRegion>& regions, const std::vector<RegionFace>& paired) {
  ViewSample sample;
  for (std::size_t i = 0; i < paired.size(); ++i) {
    const DescribedRegion& region = regions[static_cast<std::size_t>(paired[i].region)];
    sample.faces.push_back({paired[i].face, region.attributes});
    for (std::size_t j = 0; j < i; ++j) {
      if (paired[i].face == paired[j].face) continue;
      const auto [first, second] = std::minmax(paired[i].face, paired[j].face);
      sample.pairs.push_back({first, second, relate(region, regions[static_cast<std::size_t>(paired[j].region)])});
    }
  }
  return sample;
}

void keep_faces_found_most(std::vector<ViewSample>& views, std::size_t most) {
  std::map<int, std::set<std::size_t>> views_of;
  for (std::size_t view = 0; view < views.size(); ++view) {
    for (const auto& [face, attributes] : views[view].faces) views_of[face].insert(view);
  }
  if (views_of.size() <= most) return;
  std::vector<std::pair<std::size_t, int>> order;  // views it was not found in, face
  for (const auto& [face, found] : views_of) order.emplace_back(views.size() - found.size(), face);
  std::sort(order.begin(), order.end());
  std::set<int> kept;
  for (std::size_t i = 0; i < most; ++i) kept.insert(order[i].second);
  for (ViewSample& view : views) {
    std::erase_if(view.faces, [&](const auto& seen) { return !kept.contains(seen.face); });
    std::erase_if(view.pairs,
                  [&](const auto& seen) { return !kept.contains(seen.first) || !kept.contains(seen.second); });
  }
}

std::vector<ViewSample> sample_directions(const CadModel& model, const SensorModel& sensor,
                                          const SegmentationOptions& segmentation,
                                          std::span<const Eigen::Vector3d> directions, std::uint64_t seed,
                                          const std::function<void(int)>& progress) {
  std::vector<ViewSample> samples(directions.size());
  std::atomic<int> done = 0;
  tbb::parallel_for(std::size_t{0}, directions.size(), [&](std::size_t view) {
    const SimulatedScan scan = view_scan(model, directions[view], sensor, Random(seed, view));
    const auto regions = extract_regions(scan.image, sensor.camera, segmentation);
    samples[view] = view_sample(regions, pair_regions_with_faces(regions, scan.labels));
    const int count = ++done;
    if (progress) progress(count);
  });
  return samples;
}

std::vector<ViewSample> sample_views(const CadModel& model, const SensorModel& sensor,
                                     const SegmentationOptions& segmentation, const FaceSampleOptions& options,
                                     const std::function<void(int)>& progress) {
  const ViewingSphere sphere(options.views);
  std::vector<Eigen::Vector3d> directions;
  for (int view = 0; view < sphere.size(); ++view) directions.push_back(sphere.centre(view));
  return sample_directions(model, sensor, segmentation, directions, options.seed, progress);
}

}  // namespace foresight
