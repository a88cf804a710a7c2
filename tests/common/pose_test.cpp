#include "common/pose.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/random.h"

namespace foresight {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Pose random_pose(Random& random) { return {random.rotation(), 500.0 * random.direction()}; }

TEST(Pose, inverse_undoes_the_motion) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = random_pose(random);
    const Vector3d point = 300.0 * random.direction();
    EXPECT_NEAR((pose.inverse() * (pose * point) - point).norm(), 0.0, 1e-10);
    EXPECT_NEAR((pose * (pose.inverse() * point) - point).norm(), 0.0, 1e-10);
    const Pose nothing = pose * pose.inverse();
    EXPECT_NEAR((nothing.rotation - Matrix3d::Identity()).norm(), 0.0, 1e-13);
    EXPECT_NEAR(nothing.translation.norm(), 0.0, 1e-10);
  }
}

TEST(Pose, product_applies_the_right_factor_first_and_is_associative) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(random);
    const Pose b = random_pose(random);
    const Pose c = random_pose(random);
    const Vector3d point = 300.0 * random.direction();
    EXPECT_NEAR(((a * b) * point - a * (b * point)).norm(), 0.0, 1e-10);
    EXPECT_NEAR((((a * b) * c) * point - (a * (b * c)) * point).norm(), 0.0, 1e-10);
  }
}

TEST(Pose, default_moves_nothing) {
  const Vector3d point(1, 2, 3);
  EXPECT_EQ(Pose{} * point, point);
}

TEST(RotationFromVector, turns_by_the_length_about_the_direction) {
  const Matrix3d quarter = rotation_from_vector({0, 0, std::numbers::pi / 2});
  EXPECT_NEAR((quarter * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 0.0, 1e-15);
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vector3d axis = random.direction();
    const double angle = random.uniform(0.0, std::numbers::pi);
    const Matrix3d rotation = rotation_from_vector(angle * axis);
    EXPECT_TRUE(is_rotation(rotation, 1e-13));
    EXPECT_NEAR((rotation * axis - axis).norm(), 0.0, 1e-13);
    EXPECT_NEAR(rotation_angle(rotation), angle, 1e-12);
    EXPECT_NEAR((rotation_from_vector(-angle * axis) - rotation.transpose()).norm(), 0.0, 1e-13);
  }
}

TEST(RotationFromVector, of_a_tiny_or_zero_vector_is_finite_and_first_order_exact) {
  EXPECT_EQ(rotation_from_vector(Vector3d::Zero()), Matrix3d::Identity());
  const Matrix3d tiny = rotation_from_vector({1e-9, -2e-9, 3e-9});
  EXPECT_NEAR(tiny(2, 1), 1e-9, 1e-17);
  EXPECT_NEAR(tiny(0, 2), -2e-9, 1e-17);
  EXPECT_NEAR(tiny(1, 0), 3e-9, 1e-17);
}

TEST(RotationAngle, is_precise_near_zero_and_near_pi) {
  const Vector3d axis = Vector3d(1, -2, 0.5).normalized();
  EXPECT_EQ(rotation_angle(Matrix3d::Identity()), 0.0);
  for (const double angle : {1e-12, 1e-9, 1e-6, 1e-3}) {
    EXPECT_NEAR(rotation_angle(rotation_from_vector(angle * axis)) / angle, 1.0, 1e-3);
    EXPECT_NEAR(rotation_angle(rotation_from_vector((std::numbers::pi - angle) * axis)), std::numbers::pi - angle,
                1e-14);
  }
  EXPECT_NEAR(rotation_angle(rotation_from_vector(std::numbers::pi * axis)), std::numbers::pi, 1e-14);
}

TEST(RotationAngle, does_not_depend_on_the_frame) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const Matrix3d rotation = random.rotation();
    const Matrix3d frame = random.rotation();
    EXPECT_NEAR(rotation_angle(frame * rotation * frame.transpose()), rotation_angle(rotation), 1e-12);
  }
}

TEST(NearestRotation, leaves_rotations_and_takes_away_scale_and_noise) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Matrix3d rotation = random.rotation();
    EXPECT_NEAR((nearest_rotation(rotation) - rotation).norm(), 0.0, 1e-13);
    EXPECT_NEAR((nearest_rotation(7.0 * rotation) - rotation).norm(), 0.0, 1e-13);
    Matrix3d noisy = rotation;
    for (int k = 0; k < 9; ++k) noisy(k / 3, k % 3) += 1e-3 * random.gaussian();
    const Matrix3d mended = nearest_rotation(noisy);
    EXPECT_TRUE(is_rotation(mended, 1e-13));
    // Nearest: no rotation close by is closer.
    for (int k = 0; k < 20; ++k) {
      const Matrix3d other = rotation_from_vector(1e-3 * random.direction()) * mended;
      EXPECT_LE((mended - noisy).norm(), (other - noisy).norm());
    }
  }
}

TEST(NearestRotation, of_a_reflection_is_proper) {
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    const Matrix3d reflection = random.rotation() * Vector3d(1.0, 1.1, -0.9).asDiagonal() * random.rotation();
    EXPECT_TRUE(is_rotation(nearest_rotation(reflection), 1e-12));
  }
}

TEST(IsRotation, refuses_reflections_scales_shears_and_nan) {
  EXPECT_TRUE(is_rotation(Matrix3d::Identity()));
  EXPECT_FALSE(is_rotation(-Matrix3d::Identity()));
  EXPECT_FALSE(is_rotation(1.001 * Matrix3d::Identity()));
  EXPECT_FALSE(is_rotation(Matrix3d::Zero()));
  Matrix3d sheared = Matrix3d::Identity();
  sheared(0, 1) = 1e-3;
  EXPECT_FALSE(is_rotation(sheared));
  EXPECT_TRUE(is_rotation(sheared, 1e-2));
  sheared(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_rotation(sheared));
}

}  // namespace
}  // namespace foresight
