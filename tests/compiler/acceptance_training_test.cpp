#include "compiler/acceptance_training.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "compiler/compile.h"
#include "compiler/scene_generator.h"
#include "compiler/sensor_file.h"
#include "runtime/pose_evidence.h"
#include "tests/support.h"

namespace foresight {
namespace {

const CadModel& stick() {
  static const CadModel cad = read_cad_model(test::project_file("models/stick.off"));
  return cad;
}

CompileOptions few() {
  CompileOptions options;
  options.samples.views = 20;
  options.acceptance.scenes = 9;
  return options;
}

const CompiledModel& compiled_stick() {
  static const CompiledModel model = compile_model(stick(), paper_sensor(), few());
  return model;
}

AcceptanceModel trained(const AcceptanceTrainingOptions& options) {
  return train_acceptance(stick(), compiled_stick(), new_database(paper_sensor(), few()), options);
}

// Scenes of the stick alone that training did not see, its probability at the true pose moved by a share of its
// diameter.
std::vector<double> probabilities(double share) {
  const SensorModel sensor = paper_sensor();
  const CompiledModel& model = compiled_stick();
  std::vector<double> found;
  for (std::uint64_t index = 0; index < 8; ++index) {
    const Scene scene = generate_scene({stick()}, sensor, {1, 1, false}, 4711, index);
    const auto regions = extract_regions(scene.scan.image, sensor.camera, segmentation_options_for(sensor));
    const LabelledScan scan = label_scan(scene.scan.image, sensor.camera, sensor, regions);
    Pose pose = scene.objects[0].T_sensor_model;
    pose.translation.y() += share * model.diameter;
    found.push_back(probability_right(model.acceptance, gather_evidence(model, pose, scan)));
  }
  return found;
}

TEST(AcceptanceTraining, the_true_pose_is_probable_in_scenes_it_did_not_see) {
  for (const double probability : probabilities(0.0)) EXPECT_GT(probability, 0.5);
}

TEST(AcceptanceTraining, a_displaced_pose_is_improbable_in_scenes_it_did_not_see) {
  for (const double probability : probabilities(0.3)) EXPECT_LT(probability, 0.5);
}

TEST(AcceptanceTraining, gives_what_the_runtime_can_use) {
  const AcceptanceModel& model = compiled_stick().acceptance;
  for (const double weight : model.weights) EXPECT_TRUE(std::isfinite(weight));
  EXPECT_TRUE(std::isfinite(model.bias));
  EXPECT_GE(model.least_quality, 0.0);
  EXPECT_LE(model.least_quality, 1.0);
  EXPECT_GT(model.samples, 9);
  EXPECT_GT(model.weights[kOwnedShare], 0.0);
  EXPECT_LT(model.weights[kContradictedShare], 0.0);
}

TEST(AcceptanceTraining, gives_the_same_bits_for_any_number_of_threads) {
  const AcceptanceModel& first = compiled_stick().acceptance;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const AcceptanceModel second = trained(few().acceptance);
  EXPECT_EQ(first.weights, second.weights);
  EXPECT_EQ(first.bias, second.bias);
  EXPECT_EQ(first.least_quality, second.least_quality);
  EXPECT_EQ(first.samples, second.samples);
}

TEST(AcceptanceTraining, looks_at_other_scenes_for_another_seed) {
  AcceptanceTrainingOptions other = few().acceptance;
  other.seed = 2;
  EXPECT_NE(trained(other).weights, compiled_stick().acceptance.weights);
}

}  // namespace
}  // namespace foresight
