#include "compiler/face_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <numbers>

#include "common/viewing_sphere.h"

namespace foresight {
namespace {

// The model alone, centred on the optical axis, seen from one direction: distance and turn about the axis are drawn, so
// that the grid meets the faces at every angle. The paper states one distance; a sensor of one distance gives just
// that.
SimulatedScan view_scan(const CadModel& model, const Eigen::Vector3d& direction, const SensorModel& sensor,
                        Random random) {
  const double distance = random.uniform(sensor.nearest_distance, sensor.farthest_distance);
  const double roll = random.uniform(0.0, 2.0 * std::numbers::pi);
  const Eigen::Vector3d centre = 0.5 * (model.lowest() + model.highest());
  const PlacedObject object{&model, view_pose(direction, centre, distance, roll)};
  return SimulatedScene(std::span(&object, 1)).scan(sensor, random);
}

}  // namespace

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
