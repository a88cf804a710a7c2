#include "benchmarks/real_scans.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/errors.h"
#include "tests/support.h"

namespace foresight {
namespace {

TEST(RealScans, are_not_there_in_an_empty_folder) {
  const test::TemporaryFolder folder;
  testing::internal::CaptureStdout();
  EXPECT_FALSE(has_abw_scans(folder.path(), "an experiment"));
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_NE(said.find("an experiment: skipped"), std::string::npos) << said;
  EXPECT_NE(said.find(folder.path()), std::string::npos) << said;
}

TEST(RealScans, list_the_obj_files_by_name) {
  const test::TemporaryFolder folder;
  for (const char* name : {"b.obj", "a.obj", "c.txt"}) std::ofstream(folder.file(name)) << "\n";
  EXPECT_EQ(cad_files_in(folder.path()), (std::vector<std::string>{folder.file("a.obj"), folder.file("b.obj")}));
}

TEST(RealScans, refuse_a_folder_without_models) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)cad_files_in(folder.path()), InputError);
  EXPECT_THROW((void)cad_files_in(folder.file("missing")), InputError);
}

TEST(RealScans, refuse_a_true_object_without_a_model) {
  std::vector<CadModel> models(2);
  models[0].name = "tee";
  models[1].name = "wedge";
  const ScanTruth truth{"scan", "cal", {{"wedge", {Pose{}}, 0.7}}};
  const std::vector<TrueObject> objects = check_truth(truth, models, "truth.json");
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].object, 1);
  EXPECT_EQ(objects[0].visible_fraction, 0.7);
  models.pop_back();
  EXPECT_THROW((void)check_truth(truth, models, "truth.json"), InputError);
}

TEST(RealScans, have_labels_of_their_size) {
  const std::string data = test::real_data_folder();
  if (data.empty()) GTEST_SKIP() << "no real data beside the checkout";
  const std::vector<ScanTruth> scans = read_truth_file(data + "/abw/truth.json");
  const Scan scan = read_abw_scan(data + "/abw", scans.front());
  int rows = 0, columns = 0;
  (void)read_grey_png(data + "/abw/labels/" + scans.front().scan + ".png", rows, columns);
  EXPECT_EQ(rows, scan.image.rows);
  EXPECT_EQ(columns, scan.image.columns);
  EXPECT_TRUE(scan.camera.has_value());
}

}  // namespace
}  // namespace foresight
