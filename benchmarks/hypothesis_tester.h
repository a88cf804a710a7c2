// Tests hypotheses of one scan, each distinct clique once however many searches come upon it.
#pragma once

#include <map>
#include <vector>

#include "benchmarks/pose_scoring.h"
#include "benchmarks/search_cost.h"
#include "common/camera.h"
#include "common/compiled_model.h"
#include "common/range_image.h"
#include "common/viewing_sphere.h"
#include "runtime/nearest_data_point.h"

namespace foresight {

// A region explained by a face of the clique's model.
struct RegionAsFace {
  int region = 0;
  int face = 0;
  auto operator<=>(const RegionAsFace&) const = default;
};

// A hypothesis whatever the database it came from.
struct Clique {
  int model = 0;                      // index into the models given to the tester
  std::vector<RegionAsFace> matches;  // ascending
  auto operator<=>(const Clique&) const = default;
};

// What is in the scan, for scoring.
struct SceneTruth {
  int model = 0;
  Pose T_sensor_model;
  const ScoredObject* object = nullptr;
};

class HypothesisTester {
 public:
  // Everything given must outlive the tester. REQUIRES: a data point in the image.
  HypothesisTester(const RangeImage& image, const PinholeCamera& camera, const PoolVector<DescribedRegion>& regions,
                   const std::vector<CompiledModel>& models, const SceneTruth& truth);

  // Pose from the matches, localization and verification with the paper's thresholds (Section V), as recognize() does.
  [[nodiscard]] const HypothesisTest& test(const Clique& clique);

  // Distinct cliques tested so far.
  [[nodiscard]] std::size_t tests() const { return known_.size(); }

 private:
  [[nodiscard]] HypothesisTest run(const Clique& clique) const;

  const RangeImage& image_;
  const PinholeCamera& camera_;
  const PoolVector<DescribedRegion>& regions_;
  const std::vector<CompiledModel>& models_;
  SceneTruth truth_;
  NearestDataPoint data_;
  ViewingSphere sphere_{kAspectCells};
  std::map<Clique, HypothesisTest> known_;
};

}  // namespace foresight
