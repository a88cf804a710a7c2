// foresight segment: the feature extraction alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "common/scan_file.h"
#include "tests/programs/workshop.h"

namespace foresight::test {
namespace {

// The number of regions it printed; fails the test when it did not.
std::size_t segment(const std::string& scan, const std::string& output, const std::vector<std::string>& options = {}) {
  std::vector<std::string> arguments = {"segment", scan, "-o", output};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = foresight(arguments);
  expect_code(outcome, 0);
  EXPECT_TRUE(outcome.out.starts_with(scan + ": ") && outcome.out.ends_with(" regions\n")) << outcome.out;
  return outcome.out.size() > scan.size() + 2 ? std::stoul(outcome.out.substr(scan.size() + 2)) : 0;
}

TEST(SegmentProgram, writes_one_label_a_region) {
  const std::string output = workshop().file("labels.png");
  const std::size_t regions = segment(stick_scene().scan, output);
  EXPECT_GE(regions, 3U);
  int rows = 0, columns = 0;
  const std::vector<int> labels = read_grey_png(output, rows, columns);
  EXPECT_EQ(rows, 240);
  EXPECT_EQ(columns, 256);
  std::set<int> expected;
  for (int label = 0; label <= static_cast<int>(regions); ++label) expected.insert(label);
  EXPECT_EQ(std::set<int>(labels.begin(), labels.end()), expected);
  // What is no data point is in no region.
  const RangeImage image = read_scan(stick_scene().scan).image;
  for (int cell = 0; cell < image.size(); ++cell) {
    ASSERT_TRUE(image.valid(cell) || labels[static_cast<std::size_t>(cell)] == 0) << cell;
  }
}

TEST(SegmentProgram, extracts_what_recognition_sees) {
  const std::string output = workshop().file("with_database.png");
  const std::size_t regions = segment(stick_scene().scan, output, {"--database", one_object()});
  const Outcome outcome = foresight({"recognize", one_object(), stick_scene().scan, "--format", "json"});
  EXPECT_EQ(regions, Json::parse(outcome.out)["statistics"]["regions"].get<std::size_t>());
}

TEST(SegmentProgram, writes_the_same_bytes_twice) {
  const std::string a = workshop().file("a.png"), b = workshop().file("b.png");
  (void)segment(stick_scene().scan, a);
  (void)segment(stick_scene().scan, b);
  EXPECT_EQ(file_content(a), file_content(b));
}

TEST(SegmentProgram, colors_the_regions_for_eyes) {
  const std::string labels = workshop().file("grey.png"), picture = workshop().file("color.png");
  EXPECT_EQ(segment(stick_scene().scan, labels), segment(stick_scene().scan, picture, {"--color"}));
  const std::string bytes = file_content(picture);
  ASSERT_GT(bytes.size(), 33U);
  EXPECT_EQ(bytes.substr(0, 24), file_content(labels).substr(0, 24)) << "kind of file, width and height";
  EXPECT_EQ(bytes[24], 8) << "bits";
  EXPECT_EQ(bytes[25], 2) << "colour type RGB";
}

TEST(SegmentProgram, reads_depth_png_with_its_camera) {
  const std::string folder = workshop().file("depth");
  must_succeed(foresightc({"simulate", stick(), "-o", folder, "--scenes", "1", "--format", "png"}));
  EXPECT_GE(segment(folder + "/scan_0000.png", workshop().file("c.png"), {"--camera", folder + "/camera.json"}), 1U);
}

// Points strewn in space hold no planes: that is an answer, not an error.
TEST(SegmentProgram, ends_with_one_where_there_are_no_regions) {
  RangeImage image(64, 64);
  for (int row = 0; row < 64; row += 4) {
    for (int column = 0; column < 64; column += 4) {
      const float z = 800.0F + static_cast<float>((row * 37 + column * 101) % 211);
      image[image.cell(row, column)] = {z * static_cast<float>(column - 32) / 300.0F,
                                        z * static_cast<float>(row - 32) / 300.0F, z};
    }
  }
  const std::string scan = workshop().file("strewn.pcd"), output = workshop().file("strewn.png");
  write_pcd(scan, image);
  const Outcome outcome = foresight({"segment", scan, "-o", output});
  expect_code(outcome, 1);
  EXPECT_EQ(outcome.out, scan + ": 0 regions\n");
  int rows = 0, columns = 0;
  const std::vector<int> labels = read_grey_png(output, rows, columns);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), 0), 64 * 64);
}

}  // namespace
}  // namespace foresight::test
