// Verdicts of runtime/selftest.h on results made by hand; selftest_test.cpp has those of recognition itself.
#include <gtest/gtest.h>

#include <numbers>

#include "runtime/selftest.h"

namespace foresight {
namespace {

// A bar of 120 mm along x, which looks the same after half a turn about z; its true pose is at(0).
CompiledModel bar() {
  CompiledModel model;
  model.name = "bar";
  model.vertices = {{-60, -10, 0}, {60, -10, 0}, {60, 10, 0}, {-60, 10, 0}};
  model.diameter = 121.7;
  model.symmetries = {{{rotation_from_vector({0, 0, std::numbers::pi}), {0, 0, 0}}, true, 1.0}};
  model.golden_scan.emplace().T_sensor_model.translation.z() = 900.0;
  return model;
}

std::array<double, 16> at(double x, double degrees = 0.0) {
  const Eigen::Matrix3d rotation = rotation_from_vector({0, 0, degrees * std::numbers::pi / 180.0});
  std::array<double, 16> T{};
  for (int i = 0; i < 9; ++i) T[static_cast<std::size_t>(i / 3 * 4 + i % 3)] = rotation(i / 3, i % 3);
  T[3] = x;
  T[11] = 900.0;
  T[15] = 1.0;
  return T;
}

Detection reported(const std::array<double, 16>& T, double score,
                   const std::vector<std::array<double, 16>>& alternatives = {}) {
  Detection detection;
  detection.object = "bar";
  detection.T_sensor_model = T;
  detection.score = score;
  for (const auto& other : alternatives) detection.ambiguous_with.push_back({"bar", other, score - 0.1});
  return detection;
}

ObjectSelftest judged(const std::vector<Detection>& detections) {
  RecognitionResult result;
  result.detections = detections;
  result.milliseconds.total = 7.0;
  return judge_golden_scan(result, bar());
}

TEST(JudgeGoldenScan, takes_a_pose_within_the_tolerance_or_its_equal_for_right) {
  for (const double degrees : {0.0, 180.0}) {
    const ObjectSelftest result = judged({reported(at(3.0, degrees), 0.9)});
    EXPECT_EQ(result.object, "bar");
    EXPECT_EQ(result.verdict, SelftestVerdict::right);
    EXPECT_NEAR(result.position_error, 3.0, 1e-9);
    EXPECT_NEAR(result.angle_error, 0.0, 1e-6);
    EXPECT_EQ(result.score, 0.9);
    EXPECT_EQ(result.milliseconds, 7.0);
  }
  EXPECT_NEAR(judged({reported(at(0.0, 182.0), 0.9)}).angle_error, 2.0 * std::numbers::pi / 180.0, 1e-9);
  EXPECT_EQ(judged({reported(at(6.0), 0.9)}).verdict, SelftestVerdict::right);  // 5 % of the diameter are 6.1 mm
  EXPECT_EQ(judged({reported(at(6.2), 0.9)}).verdict, SelftestVerdict::wrong);
}

TEST(JudgeGoldenScan, takes_a_right_alternative_for_ambiguous) {
  const ObjectSelftest result = judged({reported(at(50.0), 0.9, {at(-40.0), at(1.0), at(30.0)})});
  EXPECT_EQ(result.verdict, SelftestVerdict::ambiguous);
  EXPECT_NEAR(result.position_error, 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(result.score, 0.8);
  EXPECT_FALSE(is_failure(result.verdict));
}

TEST(JudgeGoldenScan, prefers_what_is_reported_to_alternatives) {
  const ObjectSelftest result = judged({reported(at(80.0), 0.9, {at(0.0)}), reported(at(4.0), 0.6)});
  EXPECT_EQ(result.verdict, SelftestVerdict::right);
  EXPECT_NEAR(result.position_error, 4.0, 1e-9);
  EXPECT_EQ(result.score, 0.6);
}

TEST(JudgeGoldenScan, fails_with_wrong_poses_and_with_none) {
  const ObjectSelftest wrong = judged({reported(at(70.0), 0.9, {at(55.0)}), reported(at(60.0), 0.8)});
  EXPECT_EQ(wrong.verdict, SelftestVerdict::wrong);
  EXPECT_NEAR(wrong.position_error, 60.0, 1e-9);  // of the nearest one that is reported
  EXPECT_TRUE(is_failure(wrong.verdict));
  const ObjectSelftest nothing = judged({});
  EXPECT_EQ(nothing.verdict, SelftestVerdict::not_found);
  EXPECT_EQ(nothing.score, 0.0);
  EXPECT_TRUE(is_failure(nothing.verdict));
}

}  // namespace
}  // namespace foresight
