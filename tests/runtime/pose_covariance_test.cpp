#include "runtime/pose_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/random.h"
#include "tests/runtime/box_scene.h"

namespace foresight {
namespace {

using Eigen::Vector3d;
using test::box_pose;
using test::kBoxCentre;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kDistance = 100.0;

PosePrior prior_at(const Vector3d& about) {
  PosePrior prior;
  prior.about = about;
  prior.distance = kDistance;
  return prior;
}

// A square of n x n points of one plane, 40 mm wide.
void add_plane(PoolVector<PoseConstraint>& constraints, const Vector3d& centre, const Vector3d& normal, int group,
               int n = 10, double shared = 0.0) {
  const Vector3d u = normal.unitOrthogonal();
  const Vector3d v = normal.cross(u);
  for (int i = 0; i < n * n; ++i) {
    PoseConstraint c;
    c.point = centre + 40.0 * ((i % n + 0.5) / n - 0.5) * u + 40.0 * ((i / n + 0.5) / n - 0.5) * v;
    c.direction = normal;
    c.sigma = 0.5;
    c.shared = shared;
    c.group = group;
    constraints.push_back(c);
  }
}

const Vector3d kCorner(30.0, -20.0, 900.0);

// Three planes that fix all of a pose.
PoolVector<PoseConstraint> corner(double shared = 0.0) {
  PoolVector<PoseConstraint> constraints;
  add_plane(constraints, kCorner + 20.0 * Vector3d(1, 0.1, 0), Vector3d(0.9, 0.1, -0.4).normalized(), 0, 10, shared);
  add_plane(constraints, kCorner + 20.0 * Vector3d(0, 1, 0.2), Vector3d(-0.2, 0.8, -0.5).normalized(), 1, 12, shared);
  add_plane(constraints, kCorner + 20.0 * Vector3d(0, 0, -1), Vector3d(-0.3, -0.4, -0.8).normalized(), 2, 8, shared);
  return constraints;
}

PoolVector<PoseConstraint> one_plane(double shared = 0.0) {
  PoolVector<PoseConstraint> constraints;
  add_plane(constraints, kCorner, -Vector3d::UnitZ(), 0, 10, shared);
  return constraints;
}

// What a small error of the pose about a place makes of the offsets.
void displace(PoolVector<PoseConstraint>& constraints, const Vector6& error, const Vector3d& about) {
  for (PoseConstraint& c : constraints) {
    const Vector3d moved = error.head<3>() + error.tail<3>().cross(c.point - about);
    c.offset += c.direction.dot(moved);
  }
}

void add_noise(PoolVector<PoseConstraint>& constraints, double factor, Random& random) {
  for (PoseConstraint& c : constraints) c.offset += factor * c.sigma * random.gaussian();
}

void expect_symmetric_positive_definite(const PoseCovariance& covariance) {
  EXPECT_TRUE(covariance.allFinite());
  EXPECT_EQ(covariance, PoseCovariance(covariance.transpose()));
  EXPECT_EQ(covariance.llt().info(), Eigen::Success);
}

double squared(const PoseCovariance& covariance, const Vector6& error) {
  return error.dot(covariance.ldlt().solve(error));
}

TEST(PoseCovariance, is_symmetric_and_positive_definite_whatever_the_data_say) {
  Random random(3);
  const Vector3d origin(-200.0, 90.0, 1500.0);  // CAD origins may be far from the object
  for (const double shared : {0.0, 0.03}) {
    for (PoolVector<PoseConstraint> constraints : {corner(shared), one_plane(shared), PoolVector<PoseConstraint>{}}) {
      expect_symmetric_positive_definite(covariance_of(constraints, prior_at(kCorner), kCorner));
      add_noise(constraints, 3.0, random);
      expect_symmetric_positive_definite(covariance_of(constraints, prior_at(kCorner), origin));
    }
  }
}

TEST(PoseCovariance, turns_with_the_scene_and_does_not_depend_on_its_place) {
  Random random(4);
  const Eigen::Matrix3d turn = rotation_from_vector({0.4, -1.1, 0.7});
  const Vector3d shift(50.0, -300.0, 120.0);
  PoolVector<PoseConstraint> constraints = corner(0.02);
  add_noise(constraints, 1.0, random);
  const Vector3d origin = kCorner + Vector3d(11.0, -40.0, 25.0);
  const PoseCovariance before = covariance_of(constraints, prior_at(kCorner), origin);
  for (PoseConstraint& c : constraints) {
    c.point = turn * c.point + shift;
    c.direction = turn * c.direction;
  }
  const PoseCovariance after = covariance_of(constraints, prior_at(turn * kCorner + shift), turn * origin + shift);
  PoseCovariance both = PoseCovariance::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = turn;
  EXPECT_LT((after - both * before * both.transpose()).norm(), 1e-9 * before.norm());
}

TEST(PoseCovariance, halves_deviations_with_four_times_the_data) {
  const PoolVector<PoseConstraint> once = corner();
  PoolVector<PoseConstraint> four_times;
  for (int i = 0; i < 4; ++i) four_times.insert(four_times.end(), once.begin(), once.end());
  const PoseCovariance a = covariance_of(once, prior_at(kCorner), kCorner);
  const PoseCovariance b = covariance_of(four_times, prior_at(kCorner), kCorner);
  EXPECT_LT((a - 4.0 * b).norm(), 1e-3 * a.norm());  // the prior adds next to nothing
}

TEST(PoseCovariance, does_not_average_away_what_a_plane_shares) {
  constexpr double kShared = 0.1;
  const PoseCovariance alone = covariance_of(one_plane(), prior_at(kCorner), kCorner);
  const PoseCovariance together = covariance_of(one_plane(kShared), prior_at(kCorner), kCorner);
  EXPECT_NEAR(alone(2, 2), 0.25 / 100.0, 1e-5);  // sigma^2 / n
  EXPECT_NEAR(together(2, 2), alone(2, 2) + kShared * kShared, 1e-5);
  EXPECT_NEAR(together(3, 3), alone(3, 3), 1e-9);  // a shared offset tilts nothing
}

TEST(PoseCovariance, leaves_to_the_prior_what_a_single_plane_does_not_decide) {
  const PoseCovariance covariance = covariance_of(one_plane(), prior_at(kCorner), kCorner);
  EXPECT_NEAR(covariance(0, 0), kDistance * kDistance / 3.0, 1.0);  // sliding
  EXPECT_NEAR(covariance(1, 1), kDistance * kDistance / 3.0, 1.0);
  EXPECT_NEAR(covariance(5, 5), std::numbers::pi * std::numbers::pi / 3.0, 1e-3);  // turning on the plane
  EXPECT_LT(covariance(2, 2), 0.01);
  EXPECT_LT(covariance(3, 3), 1e-4);
  EXPECT_LT(covariance(4, 4), 1e-4);
}

TEST(PoseCovariance, counts_the_step_that_the_pose_falls_short_of) {
  Vector6 error;
  error << 0.3, -0.2, 0.25, 0.004, -0.006, 0.005;
  PoolVector<PoseConstraint> constraints = corner();
  const PoseCovariance there = covariance_of(constraints, prior_at(kCorner), kCorner);
  displace(constraints, error, kCorner);
  const PoseCovariance off = covariance_of(constraints, prior_at(kCorner), kCorner);
  EXPECT_LT((off - there - error * error.transpose()).norm(), 1e-3 * off.norm());
  EXPECT_GT(squared(there, error), 100.0);
  EXPECT_LT(squared(off, error), 1.0);
}

TEST(PoseCovariance, grows_with_data_that_scatter_more_than_the_sensors_noise) {
  Random random(5);
  PoolVector<PoseConstraint> noisy = corner();
  PoolVector<PoseConstraint> exact = corner();
  add_noise(noisy, 3.0, random);
  const PoseCovariance a = covariance_of(exact, prior_at(kCorner), kCorner);
  const PoseCovariance b = covariance_of(noisy, prior_at(kCorner), kCorner);
  EXPECT_GT((a.inverse() * b).trace(), 6.0 * 7.0);  // 9, and the step
}

TEST(PoseCovariance, of_another_origin_is_that_of_the_same_error) {
  Random random(6);
  const PoseCovariance here = covariance_of(corner(), prior_at(kCorner), kCorner);
  const Vector3d origin = kCorner + Vector3d(-70.0, 20.0, 40.0);
  const PoseCovariance there = covariance_of(corner(), prior_at(kCorner), origin);
  for (int i = 0; i < 10; ++i) {
    Vector6 error;
    for (double& number : error) number = random.gaussian();
    Vector6 moved = error;
    moved.head<3>() += error.tail<3>().cross(origin - kCorner);
    EXPECT_NEAR(squared(there, moved), squared(here, error), 1e-6 * squared(here, error));
  }
}

SensorModel noisy_sensor() {
  SensorModel sensor;
  sensor.depth_noise = 0.5;
  return sensor;
}

RangeImage with_noise(RangeImage image, const SensorModel& sensor, Random& random) {
  for (int cell = 0; cell < image.size(); ++cell) {
    if (!image.valid(cell)) continue;
    const double z = static_cast<double>(image[cell].z());
    const double step = sensor.depth_quantization;
    const double measured = step * std::round((z + sensor.depth_noise * random.gaussian()) / step);
    image[cell] *= static_cast<float>(measured / z);
  }
  return image;
}

// The truth as an error (d, w) of a pose.
Vector6 error_of(const Pose& reported, const Pose& truth) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(truth.rotation * reported.rotation.transpose()));
  Vector6 error;
  error << truth.translation - reported.translation, turn.angle() * turn.axis();
  return error;
}

TEST(PoseCovariance, of_noisy_scans_of_a_box_is_the_mean_square_of_the_errors) {
  const SensorModel sensor = noisy_sensor();
  const RangeImage clean = test::box_image(box_pose(), sensor.camera);
  double sum = 0.0;
  constexpr int kScans = 60;
  for (int i = 0; i < kScans; ++i) {
    Random random(7, static_cast<std::uint64_t>(i));
    const Pose reported = test::moved(box_pose(), 0.1 * random.direction(), 0.002 * random.direction());
    const RangeImage image = with_noise(clean, sensor, random);
    const PoseCovariance covariance = pose_covariance(test::box_model(), reported, image, sensor.camera, sensor);
    expect_symmetric_positive_definite(covariance);
    EXPECT_LT(covariance.diagonal().head<3>().maxCoeff(), 1.0);
    sum += squared(covariance, error_of(reported, box_pose()));
  }
  EXPECT_GT(sum / kScans, 4.0);  // 6 for the right covariance; 95 % of means of 60 lie within 0.9 of it
  EXPECT_LT(sum / kScans, 7.0);
}

// The box with one face straight before the sensor.
Pose facing_pose() {
  Pose pose;
  pose.translation = Vector3d(0.0, 0.0, 900.0) - kBoxCentre;
  return pose;
}

PoseCovariance about_the_box(const PoseCovariance& covariance, const Pose& pose) {
  PoseCovariance T = PoseCovariance::Identity();
  const Vector3d lever = pose.rotation * kBoxCentre;
  T.topRightCorner<3, 3>() << 0, lever.z(), -lever.y(), -lever.z(), 0, lever.x(), lever.y(), -lever.x(), 0;
  return T * covariance * T.transpose();
}

TEST(PoseCovariance, knows_the_place_on_a_single_plane_to_about_a_cell_where_its_outline_shows) {
  const SensorModel sensor = noisy_sensor();
  const double cell = 900.0 / sensor.camera.fx;
  for (const auto& screens : {std::vector<test::Screen>{}, std::vector<test::Screen>{{1200.0}}}) {
    const RangeImage image = test::box_image(facing_pose(), sensor.camera, screens);
    const PoseCovariance covariance =
        about_the_box(pose_covariance(test::box_model(), facing_pose(), image, sensor.camera, sensor), facing_pose());
    for (const int axis : {0, 1}) {
      EXPECT_GT(std::sqrt(covariance(axis, axis)), 0.5 * cell);
      EXPECT_LT(std::sqrt(covariance(axis, axis)), 3.0 * cell);
    }
    EXPECT_LT(std::sqrt(covariance(2, 2)), 0.1);
    EXPECT_LT(std::sqrt(covariance(5, 5)), 0.2);
  }
}

TEST(PoseCovariance, leaves_open_where_a_plane_lies_whose_ends_are_hidden) {
  const SensorModel sensor = noisy_sensor();
  const CompiledModel box = test::box_model();
  const RangeImage image = test::box_image(facing_pose(), sensor.camera, {{800.0, 0, 110}, {800.0, 145, 255}});
  const PoseCovariance covariance =
      about_the_box(pose_covariance(box, facing_pose(), image, sensor.camera, sensor), facing_pose());
  EXPECT_GT(std::sqrt(covariance(0, 0)), 0.3 * box.diameter);
  EXPECT_LT(std::sqrt(covariance(0, 0)), 0.6 * box.diameter);
  EXPECT_LT(std::sqrt(covariance(1, 1)), 5.0);  // its upper and lower border show
}

TEST(PoseCovariance, of_a_pose_that_nothing_supports_is_the_prior) {
  const SensorModel sensor = noisy_sensor();
  const CompiledModel box = test::box_model();
  const RangeImage image = test::box_image(facing_pose(), sensor.camera);
  Pose elsewhere = facing_pose();
  elsewhere.translation.x() += 90.0;
  const PoseCovariance covariance =
      about_the_box(pose_covariance(box, elsewhere, image, sensor.camera, sensor), elsewhere);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(covariance(axis, axis), box.diameter * box.diameter / 3.0, 1e-6 * covariance(axis, axis));
}

TEST(PoseConstraints, need_no_faces_of_triangles) {
  const SensorModel sensor = noisy_sensor();
  CompiledModel old = test::box_model();
  old.triangle_faces.clear();
  const RangeImage image = test::box_image(box_pose(), sensor.camera);
  const auto with = pose_constraints(test::box_model(), box_pose(), image, sensor.camera, sensor);
  const auto without = pose_constraints(old, box_pose(), image, sensor.camera, sensor);
  ASSERT_EQ(with.size(), without.size());
  ASSERT_GT(with.size(), 500U);
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_EQ(with[i].offset, without[i].offset);
}

TEST(PoseConstraints, share_the_rounding_of_a_sensor_without_noise_only) {
  const auto shared_of = [](double noise) {
    SensorModel sensor;
    sensor.depth_noise = noise;
    const RangeImage image = test::box_image(facing_pose(), sensor.camera);
    return pose_constraints(test::box_model(), facing_pose(), image, sensor.camera, sensor).front().shared;
  };
  EXPECT_NEAR(shared_of(0.0), 0.1 / std::sqrt(12.0), 1e-3);
  EXPECT_LT(shared_of(0.1), 1e-9);
}

}  // namespace
}  // namespace foresight
