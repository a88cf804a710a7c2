#include "runtime/pose_file.h"

#include <gtest/gtest.h>

#include <string>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/random.h"
#include "runtime/result_writer.h"
#include "tests/support.h"

namespace foresight {
namespace {

std::string matrix_text(const Eigen::Matrix3d& R, const std::string& last_row = "[0,0,0,1]") {
  std::string text = "[";
  for (int row = 0; row < 3; ++row) {
    text += "[";
    for (int column = 0; column < 3; ++column) {
      char number[40];
      std::snprintf(number, sizeof number, "%.17g,", R(row, column));
      text += number;
    }
    text += std::to_string(10 * (row + 1)) + "],";
  }
  return text + last_row + "]";
}

Pose read(const std::string& content) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.file("pose.json"), content);
  return read_pose_file(folder.file("pose.json"));
}

// The error's whole text, or "no error".
std::string error_of(const std::string& content) {
  try {
    static_cast<void>(read(content));
  } catch (const InputError& error) {
    EXPECT_NE(error.file().find("pose.json"), std::string::npos);
    EXPECT_FALSE(error.mend().empty());
    return error.what();
  }
  return "no error";
}

TEST(PoseFile, reads_either_key) {
  Random random(1);
  const Eigen::Matrix3d R = random.rotation();
  for (const char* key : {"pose", "T_sensor_model"}) {
    const Pose pose = read(std::string("{\"object\":\"x\",\"") + key + "\":" + matrix_text(R) + "}");
    EXPECT_TRUE(pose.rotation.isApprox(R, 1e-12));
    EXPECT_EQ(pose.translation, Eigen::Vector3d(10, 20, 30));
  }
}

TEST(PoseFile, reads_a_detection_back_to_the_same_bits) {
  Random random(2);
  Detection detection;
  const Eigen::Matrix3d R = random.rotation();
  for (int i = 0; i < 9; ++i) detection.T_sensor_model[static_cast<std::size_t>(i / 3 * 4 + i % 3)] = R(i / 3, i % 3);
  detection.T_sensor_model[3] = 0.1;
  detection.T_sensor_model[7] = -1.0 / 3.0;
  detection.T_sensor_model[11] = 912.345678901234567;
  detection.T_sensor_model[15] = 1.0;
  RecognitionResult result;
  result.detections = {detection};
  const std::string json = result_json("scan", result, 0.0);
  const std::size_t start = json.find("{\"object\"");
  const Pose pose = read(json.substr(start, json.find("}],\"statistics\"") + 1 - start));
  EXPECT_EQ(pose.rotation, R);
  EXPECT_EQ(pose.translation, Eigen::Vector3d(0.1, -1.0 / 3.0, 912.345678901234567));
}

TEST(PoseFile, cleans_a_rounded_rotation) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d R = random.rotation();
    const Eigen::Matrix3d rounded = (R * 1e4).array().round() / 1e4;
    const Pose pose = read("{\"pose\":" + matrix_text(rounded) + "}");
    EXPECT_TRUE(is_rotation(pose.rotation, 1e-12));
    EXPECT_LT((pose.rotation - R).cwiseAbs().maxCoeff(), 2e-4);
  }
}

TEST(PoseFile, names_the_deviation_of_what_is_no_rotation) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  EXPECT_NE(error_of("{\"pose\":" + matrix_text(2.0 * I) + "}").find("identity by 3,"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":" + matrix_text(1.01 * I) + "}").find("identity by 0.0201,"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":" + matrix_text(-I) + "}").find("mirrors"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":" + matrix_text(0.0 * I) + "}").find("identity by 1,"), std::string::npos);
}

TEST(PoseFile, refuses_what_is_no_pose) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  EXPECT_NE(error_of("").find("not JSON"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":").find("not JSON"), std::string::npos);
  EXPECT_NE(error_of("\xFF\xFE").find("not JSON"), std::string::npos);
  EXPECT_NE(error_of("[1,2]").find("no pose"), std::string::npos);
  EXPECT_NE(error_of("{}").find("neither pose nor"), std::string::npos);
  EXPECT_NE(error_of("{\"detections\":[]}").find("whole result"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":[[1,0,0,0],[0,1,0,0],[0,0,1,0]]}").find("not 4x4"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":[1,0,0,0]}").find("not 4x4"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":{\"0\":1}}").find("not 4x4"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":" + matrix_text(I, "[0,0,0]") + "}").find("not 4x4"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":" + matrix_text(I, "[0,0,0,2]") + "}").find("0 0 0 1"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":" + matrix_text(I, "[0,0,0,\"1\"]") + "}").find("no number"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":" + matrix_text(I, "[0,0,0,null]") + "}").find("no number"), std::string::npos);
  EXPECT_NE(error_of("{\"pose\":" + matrix_text(I, "[0,0,0,1e999]") + "}"), "no error");
  EXPECT_THROW(static_cast<void>(read_pose_file("/no/such/pose.json")), InputError);
}

}  // namespace
}  // namespace foresight
