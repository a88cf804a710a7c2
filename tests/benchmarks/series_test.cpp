#include "benchmarks/series.h"

#include <gtest/gtest.h>

#include "benchmarks/perturbed_pose.h"
#include "compiler/sensor_file.h"
#include "tests/benchmarks/solids.h"

namespace foresight {
namespace {

TEST(Series, shows_every_model_in_turn_and_repeats_itself) {
  const std::vector<CadModel> models = {test::cuboid(60, 70, 90), test::cuboid(40, 40, 120), test::cuboid(80, 50, 50)};
  for (int i = 0; i < 6; ++i) {
    const Scene scene = single_object_scene(models, paper_sensor(), false, 11, i);
    const Scene again = single_object_scene(models, paper_sensor(), false, 11, i);
    ASSERT_EQ(scene.objects.size(), 1U);
    EXPECT_EQ(scene.objects.front().model, i % 3);
    EXPECT_EQ(scene.objects.front().T_sensor_model.rotation, again.objects.front().T_sensor_model.rotation);
    EXPECT_EQ(truth_of(scene).front().object, i % 3);
  }
}

TEST(Series, shows_other_views_with_another_seed) {
  const std::vector<CadModel> models = {test::cuboid(60, 70, 90)};
  const Scene one = single_object_scene(models, paper_sensor(), false, 1, 0);
  const Scene two = single_object_scene(models, paper_sensor(), false, 2, 0);
  EXPECT_NE(one.objects.front().T_sensor_model.rotation, two.objects.front().T_sensor_model.rotation);
}

TEST(PerturbedPose, stays_within_2_cm_and_20_degrees_about_the_centre) {
  const Eigen::Vector3d centre(10, 20, 30);
  const Pose truth{rotation_from_vector({0.2, 1.0, -0.4}), {5, -10, 900}};
  double farthest = 0.0;
  double nearest = 1e9;
  Random random(8);
  for (int i = 0; i < 300; ++i) {
    const Pose start = perturbed_pose(truth, centre, Perturbation::uniform_magnitude, random);
    const double distance = (start * centre - truth * centre).norm();
    EXPECT_LE(distance, kPerturbedBy + 1e-9);
    EXPECT_LE(rotation_angle(start.rotation * truth.rotation.transpose()), kPerturbedTurn + 1e-6);
    farthest = std::max(farthest, distance);
    nearest = std::min(nearest, distance);
  }
  EXPECT_GT(farthest, 18.0);
  EXPECT_LT(nearest, 2.0);
}

TEST(PerturbedPose, of_exact_magnitude_is_2_cm_and_20_degrees_away) {
  const Eigen::Vector3d centre(10, 20, 30);
  const Pose truth{rotation_from_vector({0.2, 1.0, -0.4}), {5, -10, 900}};
  Random random(8);
  for (int i = 0; i < 50; ++i) {
    const Pose start = perturbed_pose(truth, centre, Perturbation::exact_magnitude, random);
    EXPECT_NEAR((start * centre - truth * centre).norm(), kPerturbedBy, 1e-9);
    EXPECT_NEAR(rotation_angle(start.rotation * truth.rotation.transpose()), kPerturbedTurn, 1e-6);
  }
}

}  // namespace
}  // namespace foresight
