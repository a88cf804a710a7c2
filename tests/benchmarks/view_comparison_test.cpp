#include "benchmarks/view_comparison.h"

#include <gtest/gtest.h>

#include "compiler/sensor_file.h"
#include "tests/benchmarks/solids.h"

namespace foresight {
namespace {

Pose turned_about_sight(double angle) { return {rotation_from_vector({0, 0, angle}), {0, 0, 900}}; }

TEST(ViewComparison, of_a_pose_with_itself_agrees_everywhere) {
  const CadModel model = test::cuboid(60, 70, 90);
  EXPECT_DOUBLE_EQ(view_agreement(model, paper_sensor(), turned_about_sight(0.3), turned_about_sight(0.3), 5.0), 1.0);
}

TEST(ViewComparison, cannot_tell_what_the_view_hides) {
  // Seen squarely from the front, a box 100 mm deep and the same box turned by half a turn about the vertical look the
  // same.
  const CadModel model = test::cuboid(60, 70, 100);
  const Pose front{Eigen::Matrix3d::Identity(), {0, 0, 900}};
  const Pose nearer{Eigen::Matrix3d::Identity(), {0, 0, 890}};
  const Pose back{rotation_from_vector({0, 3.141592653589793, 0}), {0, 0, 900}};
  EXPECT_TRUE(indistinguishable(model, paper_sensor(), back, front));
  EXPECT_FALSE(indistinguishable(model, paper_sensor(), nearer, front));
}

TEST(ViewComparison, sees_a_turned_silhouette) {
  const CadModel model = test::cuboid(30, 120, 50);
  EXPECT_FALSE(indistinguishable(model, paper_sensor(), turned_about_sight(1.5), turned_about_sight(0.0)));
}

TEST(ViewComparison, of_an_object_out_of_view_agrees_nowhere) {
  const CadModel model = test::cuboid(30, 30, 30);
  const Pose behind{Eigen::Matrix3d::Identity(), {0, 0, -900}};
  EXPECT_FALSE(indistinguishable(model, paper_sensor(), behind, behind));
}

}  // namespace
}  // namespace foresight
