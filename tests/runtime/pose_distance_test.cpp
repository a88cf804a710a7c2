#include "runtime/pose_distance.h"

#include <gtest/gtest.h>

#include <numbers>

namespace foresight {
namespace {

// A square plate, its quarter turns exact symmetries, and one near symmetry that does not count.
CompiledModel plate() {
  CompiledModel model;
  model.vertices = {{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}};
  model.diameter = 141.0;
  for (int quarter = 1; quarter < 4; ++quarter)
    model.symmetries.push_back(
        {{rotation_from_vector({0, 0, 0.5 * std::numbers::pi * quarter}), {0, 0, 0}}, true, 1.0});
  model.symmetries.push_back({{rotation_from_vector({0, 0, 0.25 * std::numbers::pi}), {0, 0, 0}}, false, 0.8});
  return model;
}

Pose turned(double degrees) {
  return {rotation_from_vector({0, 0, degrees * std::numbers::pi / 180.0}), {10.0, 20.0, 900.0}};
}

TEST(ScoredObject, has_the_identity_and_the_exact_symmetries) {
  const ScoredObject object = scored_object(plate());
  ASSERT_EQ(object.symmetries.size(), 4U);
  EXPECT_TRUE(object.symmetries[0].rotation.isIdentity());
  EXPECT_EQ(object.vertices.size(), 4U);
  EXPECT_EQ(object.diameter, 141.0);
}

TEST(ScoredObject, tolerates_five_millimetres_or_a_share_of_its_diameter) {
  ScoredObject object;
  object.diameter = 20.0;
  EXPECT_EQ(object.tolerance(), 5.0);
  object.diameter = 200.0;
  EXPECT_DOUBLE_EQ(object.tolerance(), 10.0);
}

TEST(Mssd, is_zero_at_exact_symmetries_and_not_at_near_ones) {
  const ScoredObject object = scored_object(plate());
  for (const double quarter : {0.0, 90.0, 180.0, 270.0}) EXPECT_NEAR(mssd(object, turned(quarter), turned(0)), 0, 1e-9);
  EXPECT_GT(mssd(object, turned(45.0), turned(0.0)), object.tolerance());
}

TEST(NearestEqual, is_the_symmetric_pose_that_the_distance_is_measured_to) {
  const ScoredObject object = scored_object(plate());
  const Pose reported = turned(93.0);
  const Pose equal = nearest_equal(object, reported, turned(0.0));
  EXPECT_NEAR(rotation_angle(reported.rotation * equal.rotation.transpose()), 3.0 * std::numbers::pi / 180.0, 1e-9);
  double farthest = 0.0;
  for (const Eigen::Vector3d& vertex : object.vertices)
    farthest = std::max(farthest, (reported * vertex - equal * vertex).norm());
  EXPECT_NEAR(mssd(object, reported, turned(0.0)), farthest, 1e-12);
}

}  // namespace
}  // namespace foresight
