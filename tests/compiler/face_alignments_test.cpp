#include "compiler/face_alignments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/compiler/solids.h"
#include "tests/solids.h"

namespace foresight {
namespace {

bool holds(const std::vector<Pose>& poses, const Pose& wanted) {
  return std::any_of(poses.begin(), poses.end(), [&](const Pose& pose) {
    return (pose.rotation - wanted.rotation).norm() < 1e-6 && (pose.translation - wanted.translation).norm() < 1e-6;
  });
}

TEST(FaceAlignments, are_rigid_motions_and_bounded) {
  for (const CadModel& model : {test::box(50, 54, 80), test::angle_block(), test::make_step()}) {
    const std::vector<Pose> poses = face_alignments(model, {});
    EXPECT_FALSE(poses.empty());
    EXPECT_LE(poses.size(), 8192U);
    for (const Pose& pose : poses) EXPECT_TRUE(is_rotation(pose.rotation));
  }
}

TEST(FaceAlignments, hold_the_quarter_turn_of_a_nearly_square_box) {
  const Pose quarter{rotation_from_vector({0, 0, std::numbers::pi / 2}), {}};
  const Eigen::Vector3d centre(25, 27, 40);
  EXPECT_TRUE(
      holds(face_alignments(test::box(50, 54, 80), {}), {quarter.rotation, centre - quarter.rotation * centre}));
}

TEST(FaceAlignments, hold_the_shift_that_lays_one_step_on_the_next) {
  // Stairs of three steps, each 30 wide and 20 high.
  const CadModel stairs =
      test::make_extrusion({{0, 0}, {90, 0}, {90, 20}, {60, 20}, {60, 40}, {30, 40}, {30, 60}, {0, 60}}, 100.0);
  const std::vector<Pose> poses = face_alignments(stairs, {});
  EXPECT_TRUE(std::any_of(poses.begin(), poses.end(), [](const Pose& pose) {
    return rotation_angle(pose.rotation) < 1e-6 && (pose.translation - Eigen::Vector3d(-30, 20, 0)).norm() < 1e-6;
  }));
}

TEST(FaceAlignments, leave_out_turns_that_bring_too_little_together) {
  const std::vector<Pose> poses = face_alignments(test::box(20, 60, 100), {4.0, 0.95});
  for (const Pose& pose : poses) {
    const Eigen::Vector3d turned = pose.rotation.col(2).cwiseAbs();
    EXPECT_GT(turned.maxCoeff(), 0.99);  // normals go to normals
  }
  EXPECT_EQ(surface_centre(test::box(20, 60, 100)), Eigen::Vector3d(10, 30, 50));
}

}  // namespace
}  // namespace foresight
