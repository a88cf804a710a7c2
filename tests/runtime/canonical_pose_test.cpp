#include "runtime/canonical_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "common/random.h"

namespace foresight {
namespace {

// A square bar, 40 x 40 x 100 mm, about a point: faces -x, +x, -y, +y, -z, +z, and its seven exact symmetries; near: a
// quarter turn about x.
CompiledModel bar(const Eigen::Vector3d& centre) {
  CompiledModel model;
  model.diameter = std::sqrt(40.0 * 40.0 + 40.0 * 40.0 + 100.0 * 100.0);
  model.centre = centre;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      ModelFace face;
      face.normal = sign * Eigen::Vector3d::Unit(axis);
      face.centroid = centre + (axis == 2 ? 50.0 : 20.0) * face.normal;
      face.offset = face.normal.dot(face.centroid);
      face.area = axis == 2 ? 1600.0 : 4000.0;
      model.faces.push_back(face);
    }
  }
  const auto add = [&](const Eigen::Vector3d& turn, bool exact) {
    const Eigen::Matrix3d rotation = rotation_from_vector(turn);
    model.symmetries.push_back({{rotation, centre - rotation * centre}, exact, exact ? 1.0 : 0.75});
  };
  constexpr double kPi = std::numbers::pi;
  for (const double angle : {kPi / 2, kPi, -kPi / 2}) add({0, 0, angle}, true);
  for (const double angle : {0.0, kPi / 4, kPi / 2, 3 * kPi / 4})
    add(kPi * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0), true);
  add({kPi / 2, 0, 0}, false);
  return model;
}

Pose random_pose(Random& random) {
  const Eigen::Matrix3d rotation = random.rotation();
  return {rotation, {random.uniform(-100, 100), random.uniform(-100, 100), random.uniform(700, 900)}};
}

void expect_same(const Pose& a, const Pose& b) {
  EXPECT_LT((a.rotation - b.rotation).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((a.translation - b.translation).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(CanonicalPose, is_the_same_from_every_equivalent_pose) {
  Random random(21);
  const CompiledModel model = bar({12, -5, 30});
  for (int i = 0; i < 200; ++i) {
    const Pose pose = random_pose(random);
    for (const Symmetry& symmetry : model.symmetries) {
      if (symmetry.exact)
        expect_same(canonical_pose(model, pose * symmetry.T_model_model), canonical_pose(model, pose));
    }
  }
}

TEST(CanonicalPose, is_the_same_from_every_equivalent_pose_where_turns_are_equal) {
  const CompiledModel model = bar({12, -5, 30});
  constexpr double kEighth = std::numbers::pi / 4;
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0, 0, kEighth), Eigen::Vector3d(0, 0, 3 * kEighth), Eigen::Vector3d(2 * kEighth, 0, 0),
        Eigen::Vector3d(0, 2 * kEighth, 0), Eigen::Vector3d(0, 0, 0)}) {
    const Pose pose{rotation_from_vector(turn), {0, 0, 900}};
    for (const Symmetry& symmetry : model.symmetries) {
      if (symmetry.exact)
        expect_same(canonical_pose(model, pose * symmetry.T_model_model), canonical_pose(model, pose));
    }
  }
}

TEST(CanonicalPose, is_an_equivalent_pose_turned_least) {
  Random random(22);
  const CompiledModel model = bar({0, 0, 0});
  for (int i = 0; i < 100; ++i) {
    const Pose pose = random_pose(random);
    const CanonicalPose chosen = canonical_choice(model, pose);
    expect_same(chosen.T_sensor_model, pose * chosen.T_model_model);
    bool listed = chosen.T_model_model.rotation.isIdentity();
    for (const Symmetry& symmetry : model.symmetries) {
      if (!symmetry.exact) continue;
      listed = listed || symmetry.T_model_model.rotation == chosen.T_model_model.rotation;
      EXPECT_GE(rotation_angle((pose * symmetry.T_model_model).rotation) + 1e-6,
                rotation_angle(chosen.T_sensor_model.rotation));
    }
    EXPECT_TRUE(listed);
  }
}

TEST(CanonicalPose, stays_under_small_changes) {
  const CompiledModel model = bar({12, -5, 30});
  Random random(23);
  const Pose pose{rotation_from_vector({0.2, 0.3, 0.1}), {10, 20, 900}};
  for (const Symmetry& symmetry : model.symmetries) {
    if (!symmetry.exact) continue;
    const Pose changed{rotation_from_vector(0.05 * random.direction()) * pose.rotation, pose.translation};
    expect_same(canonical_pose(model, changed * symmetry.T_model_model), changed);
  }
}

TEST(CanonicalPose, of_an_object_without_exact_symmetries_is_the_pose_itself) {
  Random random(24);
  CompiledModel model = bar({12, -5, 30});
  std::erase_if(model.symmetries, [](const Symmetry& symmetry) { return symmetry.exact; });
  const Pose pose = random_pose(random);
  EXPECT_EQ(canonical_pose(model, pose).rotation, pose.rotation);
  EXPECT_EQ(canonical_pose(model, pose).translation, pose.translation);
  EXPECT_EQ(canonical_pose(CompiledModel{}, pose).rotation, pose.rotation);
}

TEST(MovedFaces, lie_where_the_given_ones_lay) {
  Random random(25);
  const CompiledModel model = bar({12, -5, 30});
  const PoolVector<int> faces = {0, 1, 2, 3, 4, 5};
  for (const Symmetry& symmetry : model.symmetries) {
    if (!symmetry.exact) continue;
    const Pose pose = random_pose(random);
    const Pose other = pose * symmetry.T_model_model;
    const PoolVector<int> moved = moved_faces(model, faces, symmetry.T_model_model);
    ASSERT_EQ(moved.size(), faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const ModelFace& before = model.faces[static_cast<std::size_t>(faces[i])];
      const ModelFace& after = model.faces[static_cast<std::size_t>(moved[i])];
      EXPECT_LT((pose * before.centroid - other * after.centroid).norm(), 1e-9);
      EXPECT_LT((pose.rotation * before.normal - other.rotation * after.normal).norm(), 1e-9);
    }
  }
  EXPECT_EQ(moved_faces(model, {5, 0}, Pose{}), (PoolVector<int>{5, 0}));
}

TEST(MovedFaces, tell_a_disc_from_the_ring_around_it) {
  CompiledModel model = bar({0, 0, 0});
  model.faces.push_back(model.faces[0]);  // the same plane and centroid
  model.faces.back().area = 500.0;
  EXPECT_EQ(moved_faces(model, {0, 6}, Pose{}), (PoolVector<int>{0, 6}));
}

TEST(NearSymmetricPoses, are_those_of_the_near_symmetries_alone) {
  Random random(26);
  CompiledModel model = bar({12, -5, 30});
  const Pose pose = random_pose(random);
  const PoolVector<Pose> poses = near_symmetric_poses(model, pose);
  ASSERT_EQ(poses.size(), 1U);
  expect_same(poses[0], pose * model.symmetries.back().T_model_model);
  EXPECT_TRUE(near_symmetric_poses(CompiledModel{}, pose).empty());
}

}  // namespace
}  // namespace foresight
