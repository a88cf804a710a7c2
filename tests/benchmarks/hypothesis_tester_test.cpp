#include "benchmarks/hypothesis_tester.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "compiler/compile.h"
#include "compiler/scene_generator.h"
#include "compiler/sensor_file.h"
#include "tests/solids.h"

namespace foresight {
namespace {

// A step alone in a view that shows three of its faces, and what its regions truly are.
struct StepScene {
  CadModel cad = test::make_step();
  SensorModel sensor = paper_sensor();
  ScoredObject object = scored_object(cad);
  std::vector<CompiledModel> models;
  Scene scene;
  PoolVector<DescribedRegion> regions;
  Clique truth;

  StepScene() {
    CompileOptions compile;
    compile.samples.views = 20;
    models.push_back(compile_model(cad, sensor, compile));
    for (std::uint64_t i = 0; truth.matches.size() < 3; ++i) {
      scene = generate_scene({cad}, sensor, {}, 3, i);
      regions = extract_regions(scene.scan.image, sensor.camera, segmentation_options_for(sensor));
      truth.matches.clear();
      for (const RegionFace& pair : pair_regions_with_faces(regions, scene.scan.labels)) {
        if (truth.matches.size() < 3) truth.matches.push_back({pair.region, pair.face});
      }
    }
  }
  [[nodiscard]] HypothesisTester tester() const {
    return {scene.scan.image, sensor.camera, regions, models, {0, scene.objects.front().T_sensor_model, &object}};
  }
};

const StepScene& step_scene() {
  static const StepScene scene;
  return scene;
}

TEST(HypothesisTester, finds_the_true_clique_right) {
  HypothesisTester tester = step_scene().tester();
  const HypothesisTest& result = tester.test(step_scene().truth);
  EXPECT_TRUE(result.tested);
  EXPECT_TRUE(result.accepted);
  EXPECT_TRUE(result.right);
  for (const RegionAsFace& match : step_scene().truth.matches) {
    EXPECT_TRUE(std::binary_search(result.explained.begin(), result.explained.end(), match.region));
  }
}

TEST(HypothesisTester, calls_nothing_right_that_is_accepted_elsewhere_than_the_truth) {
  const StepScene& step = step_scene();
  Pose elsewhere = step.scene.objects.front().T_sensor_model;
  elsewhere.translation.x() += 50.0;
  HypothesisTester tester(step.scene.scan.image, step.sensor.camera, step.regions, step.models,
                          {0, elsewhere, &step.object});
  EXPECT_TRUE(tester.test(step.truth).accepted);
  EXPECT_FALSE(tester.test(step.truth).right);
}

TEST(HypothesisTester, tests_each_clique_once) {
  HypothesisTester tester = step_scene().tester();
  Clique other = step_scene().truth;
  other.matches.pop_back();
  (void)tester.test(step_scene().truth);
  (void)tester.test(other);
  (void)tester.test(step_scene().truth);
  EXPECT_EQ(tester.tests(), 2U);
}

}  // namespace
}  // namespace foresight
