#include "benchmarks/truth_file.h"

#include <gtest/gtest.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "tests/support.h"

namespace foresight {
namespace {

std::string document(const std::string& pose) {
  return R"({"scans": [{"scan": "s_1", "camera": "c", "objects": [{"object": "tee", "visible_fraction": 0.5, "T_sensor_model": )" +
         pose + R"(, "equally_good_poses": [)" + pose + "]}]}]}";
}

const char* const kPose = "[[0,-1,0,10],[1,0,0,20],[0,0,1,900],[0,0,0,1]]";

std::vector<ScanTruth> read(const std::string& text) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.file("truth.json"), text);
  return read_truth_file(folder.file("truth.json"));
}

TEST(TruthFile, gives_scans_objects_and_all_good_poses) {
  const std::vector<ScanTruth> scans = read(document(kPose));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].scan, "s_1");
  EXPECT_EQ(scans[0].camera, "c");
  ASSERT_EQ(scans[0].objects.size(), 1U);
  EXPECT_EQ(scans[0].objects[0].object, "tee");
  ASSERT_EQ(scans[0].objects[0].poses.size(), 2U);
  EXPECT_EQ(scans[0].objects[0].poses[0].translation, Eigen::Vector3d(10, 20, 900));
}

TEST(TruthFile, needs_neither_camera_nor_equally_good_poses) {
  const std::vector<ScanTruth> scans = read(
      R"({"scans": [{"scan": "scan_0000.pcd", "objects": [{"object": "tee", "visible_fraction": 1, "T_sensor_model": )" +
      std::string(kPose) + "}]}]}");
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].camera, "");
  ASSERT_EQ(scans[0].objects.size(), 1U);
  EXPECT_EQ(scans[0].objects[0].poses.size(), 1U);
}

TEST(TruthFile, that_is_none_is_refused_by_name) {
  for (const std::string& text :
       {std::string(), std::string("scans"), std::string("{}"), std::string(R"({"scans": [{}]})"),
        document("[[1,0,0]]"), document("[[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]"), document("7")}) {
    EXPECT_THROW((void)read(text), InputError) << text;
  }
  EXPECT_THROW((void)read_truth_file("/nowhere/truth.json"), InputError);
}

TEST(TruthFile, of_the_real_scans_reads) {
  const std::string folder = test::real_data_folder();
  if (folder.empty()) GTEST_SKIP() << "no folder of real scans";
  EXPECT_EQ(read_truth_file(folder + "/abw/truth.json").size(), 15U);
}

}  // namespace
}  // namespace foresight
