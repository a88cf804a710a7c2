#include "runtime/interpenetration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/runtime/box_scene.h"

namespace foresight {
namespace {

using test::box_model;
using test::box_pose;

Pose shifted(double distance, int axis) {
  Pose pose = box_pose();
  pose.translation += distance * box_pose().rotation.col(axis);
  return pose;
}

TEST(ShareInside, nothing_of_a_solid_lies_inside_one_that_stands_apart) {
  for (int axis = 0; axis < 3; ++axis) {
    const double side = 2.0 * test::box_half_size()[axis];
    EXPECT_EQ(share_inside(box_model(), shifted(1.02 * side, axis), box_model(), box_pose(), 0.0), 0.0) << axis;
    EXPECT_EQ(share_inside(box_model(), shifted(20.0 * side, axis), box_model(), box_pose(), 0.0), 0.0) << axis;
  }
}

// Pushed half into the other along one axis: of the box's points, those whose coordinates lie inside.
TEST(ShareInside, counts_the_surface_that_lies_inside) {
  const CompiledModel box = box_model();
  for (const double depth : {1.0, 4.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      const double shift = 0.9 * test::box_half_size()[axis];
      int expected = 0;
      for (const TemplatePoint& point : box.surface.points) {
        Eigen::Vector3d at = point.position.cast<double>() - box.centre;
        at[axis] += shift;
        expected += (test::box_half_size() - at.cwiseAbs()).minCoeff() > depth ? 1 : 0;
      }
      const double share = share_inside(box, shifted(shift, axis), box, box_pose(), depth);
      EXPECT_NEAR(share, expected / static_cast<double>(box.surface.points.size()), 1e-12) << axis << " " << depth;
      EXPECT_GT(share, 0.0);
    }
  }
}

TEST(ShareInside, what_lies_less_deep_does_not_count) {
  double last = 1.0;
  for (const double depth : {0.5, 2.0, 5.0, 9.0, 100.0}) {
    const double share = share_inside(box_model(), shifted(12.0, 0), box_model(), box_pose(), depth);
    EXPECT_LE(share, last) << depth;
    last = share;
  }
  EXPECT_EQ(last, 0.0);
  // The surfaces of one solid twice at the same place: nothing is below the other's surface.
  EXPECT_EQ(share_inside(box_model(), box_pose(), box_model(), box_pose(), 0.5), 0.0);
}

TEST(ShareInside, does_not_depend_on_where_both_stand) {
  const Pose motion{rotation_from_vector({0.3, -1.2, 0.5}), {120.0, -40.0, 300.0}};
  const Pose a = shifted(15.0, 1);
  EXPECT_NEAR(share_inside(box_model(), a, box_model(), box_pose(), 2.0),
              share_inside(box_model(), motion * a, box_model(), motion * box_pose(), 2.0), 1e-12);
}

// A small solid wholly inside a large one: all of its surface is inside, none of the other's.
TEST(ShareInside, sees_a_solid_swallowed_by_another) {
  CompiledModel small = box_model();
  for (Eigen::Vector3f& vertex : small.vertices)
    vertex = small.centre.cast<float>() + 0.3F * (vertex - small.centre.cast<float>());
  for (TemplatePoint& point : small.surface.points) {
    point.position = small.centre.cast<float>() + 0.3F * (point.position - small.centre.cast<float>());
  }
  EXPECT_EQ(share_inside(small, box_pose(), box_model(), box_pose(), 2.0), 1.0);
  EXPECT_EQ(share_inside(box_model(), box_pose(), small, box_pose(), 2.0), 0.0);
}

}  // namespace
}  // namespace foresight
