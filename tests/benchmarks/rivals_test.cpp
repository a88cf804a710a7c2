#include "benchmarks/rivals/rivals.h"

#include <gtest/gtest.h>

#include <thread>

#include "benchmarks/pose_scoring.h"
#include "benchmarks/rivals/pcl_planes.h"
#include "benchmarks/rivals/rival_scene.h"
#include "benchmarks/rivals/rival_verification.h"
#include "compiler/scene_generator.h"
#include "compiler/sensor_file.h"
#include "tests/benchmarks/solids.h"
#include "tests/support.h"

namespace foresight {
namespace {

Pose pose_of(const Detection& detection) {
  Pose pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      pose.rotation(row, column) = detection.T_sensor_model[static_cast<std::size_t>(4 * row + column)];
    }
    pose.translation[row] = detection.T_sensor_model[static_cast<std::size_t>(4 * row + 3)];
  }
  return pose;
}

CadModel castle() { return read_cad_model(test::project_file("models/castle.off")); }

Scene scene_of(const CadModel& model, const SensorModel& sensor, std::uint64_t index) {
  return generate_scene({model}, sensor, {}, 5, index);
}

bool same(const RecognitionResult& a, const RecognitionResult& b) {
  return std::equal(a.detections.begin(), a.detections.end(), b.detections.begin(), b.detections.end(),
                    [](const Detection& x, const Detection& y) {
                      return x.object == y.object && x.T_sensor_model == y.T_sensor_model && x.score == y.score;
                    });
}

class Rival : public testing::TestWithParam<std::string> {};

TEST_P(Rival, says_the_same_of_a_scan_every_time_in_any_thread) {
  const CadModel model = castle();
  const SensorModel sensor = paper_sensor();
  const Contestant rival = make_rival(GetParam(), {model}, sensor);
  EXPECT_EQ(rival.name, GetParam());
  const Scene scene = scene_of(model, sensor, 0);
  const RecognitionResult first = rival.recognize(scene.scan.image, sensor.camera);
  std::vector<RecognitionResult> again(2);
  {
    std::vector<std::jthread> threads;
    for (RecognitionResult& result : again) {
      threads.emplace_back([&] { result = rival.recognize(scene.scan.image, sensor.camera); });
    }
  }
  for (const RecognitionResult& result : again) {
    EXPECT_TRUE(same(first, result));
    EXPECT_EQ(first.statistics.verifications, result.statistics.verifications);
  }
  EXPECT_GT(first.statistics.verifications, 0);
}

TEST_P(Rival, finds_nothing_in_an_empty_image) {
  const SensorModel sensor = paper_sensor();
  const Contestant rival = make_rival(GetParam(), {test::cuboid(40, 60, 80)}, sensor);
  EXPECT_TRUE(rival.recognize(RangeImage(240, 256), sensor.camera).detections.empty());
}

// One plane leaves most of a pose open, and a flat face of an object may well lie in the wall: what is reported is not
// the question here.
TEST_P(Rival, gets_through_a_bare_wall) {
  const SensorModel sensor = paper_sensor();
  const Contestant rival = make_rival(GetParam(), {castle()}, sensor);
  RangeImage image(240, 256);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      image[image.cell(row, column)] = (900.0 * sensor.camera.ray(row, column)).cast<float>();
    }
  }
  for (const Detection& detection : rival.recognize(image, sensor.camera).detections) {
    EXPECT_TRUE(is_rotation(pose_of(detection).rotation));
    EXPECT_LE(detection.score, 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Rival, testing::ValuesIn(rival_names()), [](const auto& instance) {
  std::string name = instance.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

class PointPairRival : public testing::TestWithParam<std::string> {};

TEST_P(PointPairRival, finds_a_lone_object_in_most_clean_scans) {
  const CadModel model = castle();
  const SensorModel sensor = paper_sensor();
  const ScoredObject object = scored_object(model);
  const Contestant rival = make_rival(GetParam(), {model}, sensor);
  int right = 0;
  for (std::uint64_t index = 0; index < 3; ++index) {
    const Scene scene = scene_of(model, sensor, index);
    for (const Detection& detection : rival.recognize(scene.scan.image, sensor.camera).detections) {
      EXPECT_EQ(detection.object, model.name);
      if (mssd(object, pose_of(detection), scene.objects[0].T_sensor_model) <= object.tolerance()) ++right;
    }
  }
  EXPECT_GE(right, 2);
}

INSTANTIATE_TEST_SUITE_P(All, PointPairRival, testing::Values("pcl-ppf", "opencv-ppf"),
                         [](const auto& instance) { return instance.param == "pcl-ppf" ? "pcl" : "opencv"; });

TEST(RivalVerification, reports_the_true_pose_and_none_that_the_scan_contradicts) {
  const CadModel model = castle();
  const SensorModel sensor = paper_sensor();
  const Scene scene = scene_of(model, sensor, 1);
  const RivalScene prepared = prepare_scene(scene.scan.image, sensor.camera, sensor);
  const Pose truth = scene.objects[0].T_sensor_model;
  Pose nearer = truth;
  nearer.translation.z() -= 20.0;
  Pose aside = truth;
  aside.translation.x() += 40.0;
  const std::vector<PoseCandidate> candidates = {{0, nearer}, {0, truth}, {0, aside}, {0, truth}};
  const auto reported = poses_to_report(prepared, sensor, {sample_surface(model, 3.0, 1)}, candidates);
  ASSERT_EQ(reported.size(), 1U);  // what the first has explained counts for no second
  EXPECT_EQ(reported[0].candidate, 1);
  EXPECT_GT(reported[0].share, 0.95);
}

TEST(RivalScene, takes_the_table_away_and_leaves_the_object) {
  const CadModel model = castle();
  const SensorModel sensor = read_sensor_file(test::project_file("models/sensors/scanner.textproto"));
  SceneOptions options;
  options.background = true;
  const Scene scene = generate_scene({model}, sensor, options, 5, 0);
  const RivalScene prepared = prepare_scene(scene.scan.image, sensor.camera, sensor);
  int object = 0;
  int object_left = 0;
  int table_left = 0;
  for (int cell = 0; cell < scene.scan.image.size(); ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    if (!scene.scan.image.valid(cell)) continue;
    const bool on_object = scene.scan.labels[i].object >= 0;
    object += on_object ? 1 : 0;
    if (!prepared.background[i]) ++(on_object ? object_left : table_left);
  }
  EXPECT_GT(object_left, 0.9 * object);
  EXPECT_LT(table_left, 0.01 * scene.scan.image.size());
}

TEST(PclPlanes, finds_the_two_planes_of_a_roof) {
  const SensorModel sensor = paper_sensor();
  RangeImage image(240, 256);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {  // z = 900 + |x|
      const Eigen::Vector3d ray = sensor.camera.ray(row, column);
      image[image.cell(row, column)] = (900.0 / (1.0 - std::abs(ray.x())) * ray).cast<float>();
    }
  }
  const std::vector<int> labels = pcl_planes(image);
  ASSERT_EQ(labels.size(), static_cast<std::size_t>(image.size()));
  const int left = labels[static_cast<std::size_t>(image.cell(120, 60))];
  const int right = labels[static_cast<std::size_t>(image.cell(120, 200))];
  EXPECT_GT(left, 0);
  EXPECT_GT(right, 0);
  EXPECT_NE(left, right);
}

TEST(PclPlanes, finds_none_in_an_empty_image) {
  for (const int label : pcl_planes(RangeImage(64, 64))) EXPECT_EQ(label, 0);
}

}  // namespace
}  // namespace foresight
