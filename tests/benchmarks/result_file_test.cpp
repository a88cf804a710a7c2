#include "benchmarks/result_file.h"

#include <gtest/gtest.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "runtime/result_writer.h"
#include "tests/support.h"

namespace foresight {
namespace {

std::vector<ScanResult> read(const std::string& text) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.file("results.json"), text);
  return read_result_file(folder.file("results.json"));
}

RecognitionResult result_with(const Pose& pose) {
  Detection detection;
  detection.object = "tee";
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      detection.T_sensor_model[static_cast<std::size_t>(4 * row + column)] = pose.rotation(row, column);
    detection.T_sensor_model[static_cast<std::size_t>(4 * row + 3)] = pose.translation[row];
  }
  detection.T_sensor_model[15] = 1.0;
  RecognitionResult result;
  result.detections.push_back(detection);
  return result;
}

TEST(ResultFile, reads_back_what_the_runtime_writes) {
  const Pose pose{rotation_from_vector({0.3, -0.2, 0.9}), {10, 20, 900}};
  const std::vector<ScanResult> results =
      read(result_json("a/scan.pcd", result_with(pose), 1.0) + "\n" + result_json("b.pcd", {}, 1.0) + "\n");
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].scan, "a/scan.pcd");
  ASSERT_EQ(results[0].detections.size(), 1U);
  EXPECT_EQ(results[0].detections[0].object, "tee");
  EXPECT_TRUE(results[0].detections[0].T_sensor_model.rotation.isApprox(pose.rotation, 1e-12));
  EXPECT_EQ(results[0].detections[0].T_sensor_model.translation, pose.translation);
  EXPECT_TRUE(results[1].detections.empty());
}

TEST(ResultFile, reads_alternatives_where_there_are_any) {
  RecognitionResult result = result_with({rotation_from_vector({0.3, 0, 0}), {10, 20, 900}});
  result.detections[0].ambiguous_with = {{"castle", result.detections[0].T_sensor_model, 0.5}};
  const std::vector<ScanResult> results = read(result_json("a.pcd", result, 1.0) + "\n");
  ASSERT_EQ(results[0].detections[0].ambiguous_with.size(), 1U);
  EXPECT_EQ(results[0].detections[0].ambiguous_with[0].object, "castle");
  EXPECT_EQ(results[0].detections[0].ambiguous_with[0].T_sensor_model.translation, Eigen::Vector3d(10, 20, 900));
  // Results of versions before them.
  const std::string text =
      R"({"scan": "a", "detections": [{"object": "tee", "pose": [[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]})";
  EXPECT_TRUE(read(text)[0].detections[0].ambiguous_with.empty());
}

TEST(ResultFile, that_is_none_is_refused_by_name) {
  const Pose mirror{Eigen::Vector3d(1, 1, -1).asDiagonal().toDenseMatrix(), {0, 0, 900}};
  for (const std::string& text :
       {std::string(), std::string("scan.pcd: 1 recognized\n"), std::string("{}\n"), std::string("[]\n"),
        std::string(R"({"scan": "a", "detections": [{"object": "tee", "pose": [[1, 0]]}]})"),
        result_json("a", {}, 1.0) + "\n\n", result_json("a", result_with(mirror), 1.0)}) {
    EXPECT_THROW((void)read(text), InputError) << text;
  }
  EXPECT_THROW((void)read_result_file("/nowhere/results.json"), InputError);
}

}  // namespace
}  // namespace foresight
