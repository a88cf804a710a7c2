#include "common/sensor_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "common/errors.h"
#include "common/random.h"

namespace foresight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(SensorModel, default_passes_the_check_and_is_the_papers_grid) {
  const SensorModel sensor;
  EXPECT_NO_THROW(check(sensor, "sensor"));
  EXPECT_EQ(sensor.camera.rows, 240);
  EXPECT_EQ(sensor.camera.columns, 256);
  EXPECT_FALSE(sensor.projector);
  EXPECT_EQ(sensor.depth_noise, 0.0);
}

TEST(SensorModel, depth_sigma_is_the_deviation_of_a_noisy_quantized_depth) {
  SensorModel sensor;
  sensor.depth_noise = 0.3;
  sensor.depth_quantization = 1.0;
  Random random(1);
  const int count = 20000;
  double squares = 0.0;
  for (int i = 0; i < count; ++i) {
    const double z = random.uniform(800.0, 900.0);
    const double error = std::round(z + 0.3 * random.gaussian()) - z;
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / count), sensor.depth_sigma(), 0.01);
  sensor.depth_noise = 0.0;
  sensor.depth_quantization = 0.0;
  EXPECT_EQ(sensor.depth_sigma(), 0.0);
}

TEST(SensorModel, cell_size_and_field_of_view_are_what_the_rays_span) {
  SensorModel sensor;
  sensor.camera = {100, 200, 400.0, 500.0, 99.5, 49.5};
  sensor.nearest_distance = 700;
  sensor.farthest_distance = 900;
  EXPECT_DOUBLE_EQ(sensor.working_distance(), 800.0);
  const auto& camera = sensor.camera;
  const double across = 800.0 * (camera.ray(50, 101) - camera.ray(50, 100)).norm();
  const double down = 800.0 * (camera.ray(51, 100) - camera.ray(50, 100)).norm();
  EXPECT_NEAR(sensor.cell_size(), std::max(across, down), 1e-12);
  const double width = 800.0 * (camera.ray(0, 199.5) - camera.ray(0, -0.5)).norm();
  const double height = 800.0 * (camera.ray(99.5, 0) - camera.ray(-0.5, 0)).norm();
  EXPECT_NEAR(sensor.field_of_view(), std::min(width, height), 1e-9);
}

TEST(SensorModel, equality_compares_every_field) {
  const std::function<void(SensorModel&)> changes[] = {
      [](SensorModel& s) { s.name = "other"; },
      [](SensorModel& s) { s.camera.fx += 1; },
      [](SensorModel& s) { s.projector = Eigen::Vector3d(1, 0, 0); },
      [](SensorModel& s) { s.nearest_distance -= 1; },
      [](SensorModel& s) { s.farthest_distance += 1; },
      [](SensorModel& s) { s.depth_quantization = 0; },
      [](SensorModel& s) { s.depth_noise = 1; },
      [](SensorModel& s) { s.largest_incidence = 1; },
      [](SensorModel& s) { s.background = true; },
      [](SensorModel& s) { s.matching_window = 3; },
  };
  EXPECT_TRUE(SensorModel{} == SensorModel{});
  for (const auto& change : changes) {
    SensorModel changed;
    change(changed);
    EXPECT_FALSE(changed == SensorModel{});
    EXPECT_NO_THROW(check(changed, "sensor"));
  }
}

TEST(SensorModel, check_refuses_every_field_outside_its_limits) {
  const std::function<void(SensorModel&)> faults[] = {
      [](SensorModel& s) { s.camera.rows = kSmallestImageSide - 1; },
      [](SensorModel& s) { s.camera.rows = kLargestImageSide + 1; },
      [](SensorModel& s) { s.camera.columns = kSmallestImageSide - 1; },
      [](SensorModel& s) { s.camera.columns = kLargestImageSide + 1; },
      [](SensorModel& s) { s.camera.rows = -240; },
      [](SensorModel& s) { s.camera.fx = 0; },
      [](SensorModel& s) { s.camera.fx = kNan; },
      [](SensorModel& s) { s.camera.fy = -1; },
      [](SensorModel& s) { s.camera.fy = kInfinity; },
      [](SensorModel& s) { s.camera.cx = kNan; },
      [](SensorModel& s) { s.camera.cy = kInfinity; },
      [](SensorModel& s) { s.nearest_distance = 0; },
      [](SensorModel& s) { s.nearest_distance = kNan; },
      [](SensorModel& s) { s.nearest_distance = s.farthest_distance + 1; },
      [](SensorModel& s) { s.farthest_distance = kInfinity; },
      [](SensorModel& s) { s.farthest_distance = kNan; },
      [](SensorModel& s) { s.depth_quantization = -0.1; },
      [](SensorModel& s) { s.depth_quantization = kNan; },
      [](SensorModel& s) { s.depth_noise = -0.1; },
      [](SensorModel& s) { s.depth_noise = kInfinity; },
      [](SensorModel& s) { s.largest_incidence = 0; },
      [](SensorModel& s) { s.matching_window = 0; },
      [](SensorModel& s) { s.matching_window = 4; },
      [](SensorModel& s) { s.matching_window = 33; },
      [](SensorModel& s) { s.largest_incidence = std::numbers::pi / 2 + 1e-6; },
      [](SensorModel& s) { s.largest_incidence = kNan; },
      [](SensorModel& s) { s.projector = Eigen::Vector3d(0, kNan, 0); },
  };
  for (const auto& spoil : faults) {
    SensorModel sensor;
    spoil(sensor);
    try {
      check(sensor, "my.textproto");
      ADD_FAILURE() << "fault " << (&spoil - faults) << " passed";
    } catch (const InputError& error) {
      EXPECT_EQ(error.file(), "my.textproto");
      EXPECT_FALSE(error.cause().empty());
      EXPECT_FALSE(error.mend().empty());
    }
  }
}

}  // namespace
}  // namespace foresight
