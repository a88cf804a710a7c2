#include "benchmarks/box_scans.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "common/errors.h"
#include "common/scan_file.h"
#include "compiler/sensor_file.h"
#include "tests/benchmarks/solids.h"
#include "tests/support.h"

namespace foresight {
namespace {

const PinholeCamera kCamera{100, 120, 500.0, 500.0, 59.5, 49.5};

// A surface at 1000 mm on the left, at 1100 mm on the right.
RangeImage step_image(int left_columns) {
  RangeImage image(kCamera.rows, kCamera.columns);
  for (int cell = 0; cell < image.size(); ++cell) {
    const int column = cell % image.columns;
    image[cell] = ((column < left_columns ? 1000.0 : 1100.0) * kCamera.ray(cell / image.columns, column)).cast<float>();
  }
  return image;
}

std::vector<int> block(int first_row, int first_column, int rows, int columns) {
  std::vector<int> cells;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      cells.push_back((first_row + row) * kCamera.columns + first_column + column);
  }
  return cells;
}

TEST(BoxMask, of_a_whole_top_is_wholly_visible) {
  // 50 x 30 cells of 2 mm.
  const BoxMask mask =
      describe_mask(block(20, 20, 30, 50), test::cuboid(100, 60, 40), step_image(kCamera.columns), kCamera);
  EXPECT_NEAR(mask.visible, 1.0, 1e-6);
  EXPECT_NEAR(mask.top.region.normal.z(), -1.0, 1e-6);
  EXPECT_NEAR(std::abs(mask.top.major_axis.x()), 1.0, 1e-6);
}

TEST(BoxMask, over_an_edge_has_the_plane_that_most_of_it_lies_on) {
  const BoxMask mask = describe_mask(block(20, 20, 30, 50), test::cuboid(100, 60, 40), step_image(55), kCamera);
  EXPECT_NEAR(mask.top.region.offset, -1000.0, 0.01);
  EXPECT_EQ(mask.top.region.cells.size(), 35U * 30U);
  EXPECT_EQ(mask.cells.size(), 50U * 30U);
  EXPECT_NEAR(mask.visible, 1.0, 1e-6);  // all of the mask, seen along the rays, on that plane
}

TEST(BoxMask, without_part_of_its_data_is_less_visible) {
  RangeImage image = step_image(kCamera.columns);
  for (const int cell : block(20, 20, 15, 50)) image[cell].setConstant(std::nanf(""));
  EXPECT_NEAR(describe_mask(block(20, 20, 30, 50), test::cuboid(100, 60, 40), image, kCamera).visible, 0.5, 1e-6);
}

// A data folder with both frames, flat at 1000 mm, and a mask image with one box each.
class BoxFolder : public testing::Test {
 protected:
  BoxFolder() : models_{test::cuboid(100, 60, 40), test::cuboid(120, 80, 40)} {
    for (const char* part : {"scans", "masks"}) std::filesystem::create_directories(folder_.file(part));
    models_[0].name = "small_box";
    models_[1].name = "medium_box";
    for (const char* scan : {"scans/pallet_0.png", "scans/pallet_1.png"})
      write_depth_png(folder_.file(scan), step_image(60), 1.0);
    write_mask("pallet_0_small_box", {{7, block(10, 10, 30, 40)}, {2, block(60, 10, 30, 40)}});
    write_mask("pallet_1_medium_box", {{1, block(10, 10, 30, 40)}});
  }

  void write_mask(const std::string& name, const std::vector<std::pair<int, std::vector<int>>>& boxes,
                  int rows = kCamera.rows) {
    std::vector<int> labels(static_cast<std::size_t>(rows * kCamera.columns), 0);
    for (const auto& [label, cells] : boxes) {
      for (const int cell : cells) labels[static_cast<std::size_t>(cell)] = label;
    }
    write_label_png(folder_.file("masks/" + name + ".png"), rows, kCamera.columns, labels);
  }

  [[nodiscard]] std::vector<BoxFrame> read() const { return read_box_frames(folder_.path(), models_, kCamera); }

  test::TemporaryFolder folder_;
  std::vector<CadModel> models_;
};

TEST_F(BoxFolder, is_read_with_depth_in_millimetres_and_masks_by_value) {
  const std::vector<BoxFrame> frames = read();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].name, "pallet_0");
  ASSERT_EQ(frames[0].masks.size(), 2U);
  EXPECT_EQ(frames[0].masks[0].name, "small_box 2");
  EXPECT_EQ(frames[0].masks[1].name, "small_box 7");
  EXPECT_EQ(frames[0].masks[1].cells, block(10, 10, 30, 40));
  ASSERT_EQ(frames[1].masks.size(), 1U);
  EXPECT_EQ(frames[1].masks[0].object, 1);
  EXPECT_EQ(frames[0].image[0].z(), 1000.0F);
  EXPECT_NEAR(frames[0].image[0].x(), -119.0, 1e-4);
}

TEST_F(BoxFolder, without_the_model_of_a_mask_is_refused) {
  models_.pop_back();
  EXPECT_THROW((void)read(), InputError);
}

TEST_F(BoxFolder, with_images_of_another_size_is_refused) {
  write_mask("pallet_1_medium_box", {{1, block(10, 10, 30, 40)}}, kCamera.rows + 1);
  EXPECT_THROW((void)read(), InputError);
}

TEST_F(BoxFolder, with_a_mask_of_less_than_a_surface_is_refused) {
  write_mask("pallet_1_medium_box", {{1, {5, 6}}});
  EXPECT_THROW((void)read(), InputError);
}

TEST_F(BoxFolder, without_a_file_is_refused) {
  std::filesystem::remove(folder_.file("masks/pallet_0_small_box.png"));
  EXPECT_THROW((void)read(), InputError);
}

TEST(BoxFrames, are_not_there_in_an_empty_folder) {
  const test::TemporaryFolder folder;
  testing::internal::CaptureStdout();
  EXPECT_FALSE(has_box_frames(folder.path(), "an experiment"));
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_NE(said.find("an experiment: skipped"), std::string::npos) << said;
}

TEST(BoxFrames, show_each_top_by_more_than_half) {
  const std::string data = test::real_data_folder();
  if (data.empty()) GTEST_SKIP() << "no real data beside the checkout";
  std::vector<CadModel> models = {test::cuboid(255, 155, 100), test::cuboid(340, 250, 95)};
  models[0].name = "small_box";
  models[1].name = "medium_box";
  const PinholeCamera camera = read_sensor_file(test::project_file("models/sensors/depth_camera.textproto")).camera;
  const std::vector<BoxFrame> frames = read_box_frames(data + "/boxes", models, camera);
  EXPECT_EQ(frames[0].masks.size(), 11U);
  EXPECT_EQ(frames[1].masks.size(), 2U);
  for (const BoxFrame& frame : frames) {
    for (const BoxMask& mask : frame.masks) {
      EXPECT_GT(mask.visible, 0.5) << mask.name;
      EXPECT_LT(mask.top.region.normal.z(), -0.9) << mask.name;  // they lie flat
    }
  }
}

}  // namespace
}  // namespace foresight
