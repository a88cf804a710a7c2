// Sample values of region attributes for each face of a model over many simulated views (Section III, Fig. 1).
#pragma once

#include <array>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "common/region_attributes.h"
#include "common/relation_attributes.h"
#include "common/sensor_model.h"
#include "compiler/cad_model.h"
#include "compiler/sensor_simulator.h"

namespace foresight {

// A region paired with the face most of its cells show, by the simulator's labels.
struct RegionFace {
  int region = 0;
  int face = 0;
};

// Regions of which no face holds at least `smallest_share` of the cells are paired with none.
[[nodiscard]] std::vector<RegionFace> pair_regions_with_faces(const PoolVector<DescribedRegion>& regions,
                                                              const std::vector<CellLabel>& labels,
                                                              double smallest_share = 0.5);

struct FaceSampleOptions {
  int views = 320;         // of ViewingSphere. Limit: 20*4^k.
  std::uint64_t seed = 1;  // of noise, distance and roll; view i uses its own stream
};

// What one view shows.
struct ViewSample {
  struct FaceObservation {
    int face;
    AttributeVector attributes;
  };
  struct PairObservation {
    int first;
    int second;
    RelationVector relations;
  };  // first < second
  std::vector<FaceObservation> faces;
  std::vector<PairObservation> pairs;
};

// The faces and pairs of faces that regions of one image show, given which region shows which face.
[[nodiscard]] ViewSample view_sample(const PoolVector<DescribedRegion>& regions, const std::vector<RegionFace>& paired);

// Leaves the samples of the `most` faces found in most views, of equals the first, and of pairs of these.
void keep_faces_found_most(std::vector<ViewSample>& views, std::size_t most);

// T_sensor_model of the model centred on the optical axis, seen from one direction: distance and turn about the axis are
// drawn, so that the grid meets the faces at every angle. The paper states one distance; a sensor of one distance gives
// just that.
[[nodiscard]] Pose sampled_pose(const CadModel& model, const Eigen::Vector3d& direction, const SensorModel& sensor,
                                Random& random);

// Views of one model from unit directions (model frame, object towards sensor), in their order whatever the number of
// threads; distance, roll and noise of view i from stream i of the seed. progress(done) may be called from any thread.
[[nodiscard]] std::vector<ViewSample> sample_directions(const CadModel& model, const SensorModel& sensor,
                                                        const SegmentationOptions& segmentation,
                                                        std::span<const Eigen::Vector3d> directions, std::uint64_t seed,
                                                        const std::function<void(int)>& progress = {});

// All views of one model from the viewing sphere, in view order whatever the number of threads. progress(done) may be
// called from any thread.
[[nodiscard]] std::vector<ViewSample> sample_views(const CadModel& model, const SensorModel& sensor,
                                                   const SegmentationOptions& segmentation,
                                                   const FaceSampleOptions& options,
                                                   const std::function<void(int)>& progress = {});

}  // namespace foresight
