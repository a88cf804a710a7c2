#include "compiler/sensor_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/errors.h"
#include "tests/support.h"

namespace foresight {
namespace {

const std::string kCamera = "camera { rows: 100 columns: 200 fx: 300 fy: 400 cx: 99.5 cy: 49.5 }\n";
const std::string kRange = "nearest_distance_mm: 500 farthest_distance_mm: 600\n";
const std::string kIncidence = "largest_incidence_deg: 60\n";
const std::string kSmallest = "name: 's'\n" + kCamera + kRange + kIncidence;

// The message of the error, or "" when the text was accepted.
std::string error_of(const std::string& text) {
  try {
    (void)parse_sensor(text, "s.textproto");
    return "";
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "s.textproto");
    EXPECT_FALSE(error.mend().empty());
    return error.cause();
  }
}

void expect_error(const std::string& text, const std::string& part) {
  EXPECT_NE(error_of(text).find(part), std::string::npos) << "got: " << error_of(text) << "\nfor: " << text;
}

TEST(SensorFile, reads_every_field_in_its_unit) {
  const SensorModel sensor = parse_sensor(kSmallest +
                                              "projector_mm { x: 1 y: -2 z: 3 } depth_quantization_mm: 0.25\n"
                                              "depth_noise_mm: 0.5 background: true  # a comment\n"
                                              "matching_window_cells: 9",
                                          "s");
  SensorModel expected;
  expected.name = "s";
  expected.camera = {100, 200, 300, 400, 99.5, 49.5};
  expected.projector = Eigen::Vector3d(1, -2, 3);
  expected.nearest_distance = 500;
  expected.farthest_distance = 600;
  expected.depth_quantization = 0.25;
  expected.depth_noise = 0.5;
  expected.largest_incidence = sensor.largest_incidence;
  expected.background = true;
  expected.matching_window = 9;
  EXPECT_EQ(sensor, expected);
  EXPECT_NEAR(sensor.largest_incidence, 1.0471975511965976, 1e-15);
}

TEST(SensorFile, takes_left_out_fields_as_none) {
  const SensorModel sensor = parse_sensor(kSmallest, "s");
  EXPECT_FALSE(sensor.projector);
  EXPECT_EQ(sensor.depth_quantization, 0.0);
  EXPECT_EQ(sensor.depth_noise, 0.0);
  EXPECT_FALSE(sensor.background);
  EXPECT_EQ(sensor.matching_window, 1);
}

TEST(SensorFile, paper_sensor_is_what_its_file_says) {
  EXPECT_EQ(paper_sensor(), read_sensor_file(test::project_file("models/sensors/paper.textproto")));
  EXPECT_NEAR(paper_sensor().cell_size(), 1.17, 1e-5);
}

TEST(SensorFile, every_sensor_of_the_project_is_read) {
  for (const std::string name : {"paper", "scanner", "abw", "depth_camera"}) {
    const SensorModel sensor = read_sensor_file(test::project_file("models/sensors/" + name + ".textproto"));
    EXPECT_EQ(sensor.name, name);
  }
}

TEST(SensorFile, scanner_has_what_the_paper_leaves_out) {
  const SensorModel sensor = read_sensor_file(test::project_file("models/sensors/scanner.textproto"));
  EXPECT_EQ(sensor.camera, paper_sensor().camera);
  EXPECT_TRUE(sensor.projector);
  EXPECT_TRUE(sensor.background);
  EXPECT_GT(sensor.depth_noise, 0.0);
  EXPECT_DOUBLE_EQ(sensor.working_distance(), 900.0);
}

TEST(SensorFile, depth_camera_stands_above_a_pallet) {
  const SensorModel sensor = read_sensor_file(test::project_file("models/sensors/depth_camera.textproto"));
  EXPECT_TRUE(sensor.projector);
  EXPECT_TRUE(sensor.background);
  // A carton of a quarter of a metre has room, and its edges can be found to a few millimetres.
  EXPECT_GT(sensor.field_of_view(), 4.0 * 250.0);
  EXPECT_LT(sensor.cell_size(), 3.0);
  EXPECT_GT(sensor.depth_sigma(), sensor.depth_noise);
}

TEST(SensorFile, says_line_and_column_of_text_that_does_not_parse) {
  expect_error("name: 's'\ncamera { rows: many }", "line 2, column 16");
  expect_error("name 's'", "line 1, column 6");
  expect_error(kSmallest + "background: perhaps", "line 5, column 20");
  expect_error("camera {", "line 1");
  expect_error("name: 'unfinished", "line 1");
  expect_error("{\"name\": \"json\"}", "line 1");
  expect_error(std::string("\x89PNG\r\n\x1a\n\0\0", 10), "line 1");
}

TEST(SensorFile, names_unknown_and_repeated_fields) {
  expect_error(kSmallest + "noise: 1", "noise");
  expect_error("name: 's' camera { focal: 1 }", "focal");
  expect_error(kSmallest + "name: 't'", "name");
  expect_error(kSmallest + "largest_incidence_rad: 1", "largest_incidence");
  expect_error("name: 's' camera { rows: 99999999999 }", "99999999999");
}

TEST(SensorFile, names_missing_fields) {
  expect_error("", "name");
  expect_error(kCamera + kRange + kIncidence, "name");
  expect_error("name: ''\n" + kCamera + kRange + kIncidence, "name");
  expect_error("name: 's'\n" + kRange + kIncidence, "camera");
  expect_error("name: 's'\n" + kCamera + kIncidence, "nearest_distance_mm");
  expect_error("name: 's'\n" + kCamera + kRange, "largest_incidence_deg");
  for (const std::string field : {"rows: 100 ", "columns: 200 ", "fx: 300 ", "fy: 400 ", "cx: 99.5 ", "cy: 49.5 "}) {
    std::string text = kSmallest;
    text.erase(text.find(field), field.size());
    expect_error(text, "camera." + field.substr(0, field.find(':')));
  }
}

TEST(SensorFile, takes_a_principal_point_at_zero) {
  std::string text = kSmallest;
  text.replace(text.find("99.5"), 4, "0");
  EXPECT_EQ(parse_sensor(text, "s").camera.cx, 0.0);
}

TEST(SensorFile, refuses_values_outside_their_limits) {
  const auto replaced = [](const std::string& from, const std::string& to) {
    std::string text = kSmallest;
    return text.replace(text.find(from), from.size(), to);
  };
  expect_error(replaced("rows: 100", "rows: 31"), "31");
  expect_error(replaced("columns: 200", "columns: -200"), "-200");
  expect_error(replaced("fx: 300", "fx: -300"), "focal length");
  expect_error(replaced("fy: 400", "fy: nan"), "focal length");
  expect_error(replaced("cx: 99.5", "cx: inf"), "principal point");
  expect_error(replaced("mm: 600", "mm: 400"), "working range");
  expect_error(replaced("deg: 60", "deg: 91"), "incidence");
  expect_error(replaced("deg: 60", "deg: -1"), "incidence");
  expect_error(kSmallest + "depth_noise_mm: -1", "depth_noise");
  expect_error(kSmallest + "matching_window_cells: 4", "matching_window");
  expect_error(kSmallest + "matching_window_cells: -3", "matching_window");
  expect_error(kSmallest + "depth_quantization_mm: -1", "depth_quantization");
  expect_error(kSmallest + "projector_mm { z: nan }", "projector");
  EXPECT_EQ(error_of(replaced("deg: 60", "deg: 90")), "");
}

TEST(SensorFile, refuses_a_missing_file) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)read_sensor_file(folder.file("none.textproto")), InputError);
}

TEST(SensorFile, names_the_file_it_was_given) {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("bad.textproto");
  std::ofstream(file) << "nonsense";
  try {
    (void)read_sensor_file(file);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), file);
  }
}

}  // namespace
}  // namespace foresight
