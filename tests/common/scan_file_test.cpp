#include "common/scan_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/random.h"
#include "tests/support.h"

namespace foresight {
namespace {

constexpr int kRows = 40;
constexpr int kColumns = 48;
constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

// A tilted plane with noise in every bit, and holes.
RangeImage sample_image() {
  RangeImage image(kRows, kColumns);
  Random random(5);
  const PinholeCamera camera{kRows, kColumns, 60.0, 62.0, 23.5, 19.5};
  for (int cell = 0; cell < image.size(); ++cell) {
    if (cell % 7 == 3) continue;
    const double z = 800.0 + random.uniform(-20.0, 20.0);
    image[cell] = (camera.ray(cell / kColumns, cell % kColumns) * z).cast<float>();
  }
  return image;
}

void expect_same(const RangeImage& a, const RangeImage& b) {
  ASSERT_EQ(a.rows, b.rows);
  ASSERT_EQ(a.columns, b.columns);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (int cell = 0; cell < a.size(); ++cell) {
    ASSERT_EQ(a.valid(cell), b.valid(cell)) << cell;
    for (int axis = 0; axis < 3 && a.valid(cell); ++axis) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(a[cell][axis]), std::bit_cast<std::uint32_t>(b[cell][axis])) << cell;
    }
    if (!a.valid(cell)) {
      ASSERT_TRUE(std::isnan(b[cell].x()) && std::isnan(b[cell].y()) && std::isnan(b[cell].z()));
    }
  }
}

template <typename Number>
void append(std::string& bytes, Number number, std::endian order = std::endian::little) {
  char copy[sizeof(Number)];
  std::memcpy(copy, &number, sizeof(Number));
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    bytes += copy[order == std::endian::native ? i : sizeof(Number) - 1 - i];
  }
}

std::string text_of(float value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.9g", static_cast<double>(value));
  return buffer;
}

// Without the sync of write_file_atomically, which costs the time of these many small files.
void put_file(const std::string& file, const std::string& content) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(content.data(), static_cast<std::streamsize>(content.size()));
}

Scan read_content(const std::string& content, const ScanReadOptions& options = {}) {
  const test::TemporaryFolder folder;
  put_file(folder.file("scan"), content);
  return read_scan(folder.file("scan"), options);
}

// The error's cause, or "no error"; every error names a file and a mend.
template <typename Action>
std::string cause_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    EXPECT_FALSE(error.file().empty());
    EXPECT_FALSE(error.mend().empty());
    return error.cause();
  }
  return "no error";
}

std::string cause_of_content(const std::string& content) {
  return cause_of([&] { static_cast<void>(read_content(content)); });
}

#define EXPECT_CAUSE(part, content) \
  EXPECT_NE(cause_of_content(content).find(part), std::string::npos) << cause_of_content(content)

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string pcd_content(const RangeImage& image, PcdEncoding encoding) {
  const test::TemporaryFolder folder;
  write_pcd(folder.file("a"), image, encoding);
  return read_whole_file(folder.file("a"));
}

enum class PlyEncoding { ascii, little, big };

// One vertex a cell, or only valid vertices and a range grid; with other properties between and elements around.
std::string ply_content(const RangeImage& image, PlyEncoding encoding, bool range_grid) {
  static constexpr const char* formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  std::string text = "ply\nformat " + std::string(formats[static_cast<int>(encoding)]) + " 1.0\ncomment made here\n";
  const std::string columns = std::to_string(image.columns);
  const std::string rows = std::to_string(image.rows);
  text += range_grid ? "obj_info is_mesh 0\nobj_info num_cols " + columns + "\nobj_info num_rows " + rows + "\n"
                     : "comment width " + columns + "\ncomment height " + rows + "\n";
  const int vertices = range_grid ? count_valid(image) : image.size();
  text += "element view 2\nproperty list uchar short shift\nproperty double when\n";
  text += "element vertex " + std::to_string(vertices) + "\nproperty uchar red\n";
  text += "property float x\nproperty float y\nproperty list uchar int near\nproperty float z\n";
  if (range_grid)
    text += "element range_grid " + std::to_string(image.size()) + "\nproperty list uchar int vertex_indices\n";
  text += "element face 9\nproperty list uchar int vertex_indices\nend_header\n";
  const auto order = encoding == PlyEncoding::big ? std::endian::big : std::endian::little;
  const auto put = [&](auto number) {
    if (encoding != PlyEncoding::ascii) {
      append(text, number, order);
    } else if constexpr (std::is_floating_point_v<decltype(number)>) {
      text += text_of(static_cast<float>(number)) + " ";
    } else {
      text += std::to_string(static_cast<int>(number)) + " ";
    }
  };
  for (int view = 0; view < 2; ++view) {
    put(std::uint8_t{2});
    put(std::int16_t{-3});
    put(std::int16_t{4});
    put(0.5);
  }
  for (const Eigen::Vector3f& point : image.points) {
    if (range_grid && std::isnan(point.z())) continue;
    put(std::uint8_t{200});
    put(point.x());
    put(point.y());
    put(std::uint8_t{1});
    put(std::int32_t{-7});
    put(point.z());
    if (encoding == PlyEncoding::ascii) text += "\n";
  }
  std::int32_t vertex = 0;
  for (int cell = 0; range_grid && cell < image.size(); ++cell) {
    put(static_cast<std::uint8_t>(image.valid(cell) ? 1 : 0));
    if (image.valid(cell)) put(vertex++);
  }
  return text;  // the faces may be missing: nobody reads them
}

TEST(Pcd, reads_back_the_same_bits_in_every_encoding) {
  const RangeImage image = sample_image();
  for (const auto encoding : {PcdEncoding::ascii, PcdEncoding::binary, PcdEncoding::binary_compressed}) {
    const Scan scan = read_content(pcd_content(image, encoding));
    expect_same(image, scan.image);
    EXPECT_FALSE(scan.camera.has_value());
  }
}

TEST(Pcd, compresses_what_repeats_and_survives_what_does_not) {
  RangeImage image(64, 64);
  for (Eigen::Vector3f& point : image.points) point = {1.0F, 2.0F, 900.0F};
  const std::string packed = pcd_content(image, PcdEncoding::binary_compressed);
  EXPECT_LT(packed.size(), 1500U);
  expect_same(image, read_content(packed).image);
  Random random(3);
  for (int cell = 0; cell < image.size(); ++cell) {
    for (int axis = 0; axis < 3; ++axis) image[cell][axis] = static_cast<float>(random.uniform(100.0, 5000.0));
  }
  EXPECT_EQ(pcd_content(image, PcdEncoding::binary_compressed), pcd_content(image, PcdEncoding::binary_compressed));
  expect_same(image, read_content(pcd_content(image, PcdEncoding::binary_compressed)).image);
}

TEST(Pcd, skips_other_fields_of_any_type_size_and_count) {
  const RangeImage image = sample_image();
  const std::string counts = "WIDTH 48\nHEIGHT 40\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1920\n";
  std::string binary = "VERSION .7\nFIELDS label z _ x rgb histogram y\nSIZE 1 8 1 4 4 2 4\nTYPE U F U F F I F\n";
  binary += "COUNT 1 1 3 1 1 5 1\n" + counts + "DATA ";
  std::string planes = binary + "binary_compressed\n";
  std::string ascii = binary + "ascii\r\n";
  binary += "binary\n";
  for (const Eigen::Vector3f& point : image.points) {
    append(binary, std::uint8_t{9});
    append(binary, static_cast<double>(point.z()));
    binary += "abc";
    append(binary, point.x());
    append(binary, 1.0F);
    binary += "0123456789";
    append(binary, point.y());
    ascii += "9 " + text_of(point.z()) + " 1 2 3 " + text_of(point.x()) + " 1e-99 5 4 3 2 -1  " + text_of(point.y()) +
             "\r\n";
  }
  expect_same(image, read_content(binary).image);
  expect_same(image, read_content(ascii).image);
  // All of one field after all of another, as literal runs of LZF.
  std::string fields(1920, '\x09');
  for (const auto& point : image.points) append(fields, static_cast<double>(point.z()));
  fields += std::string(1920 * 3, 'a');
  for (const auto& point : image.points) append(fields, point.x());
  fields += std::string(1920 * (4 + 10), 'b');
  for (const auto& point : image.points) append(fields, point.y());
  std::string packed;
  for (std::size_t at = 0; at < fields.size(); at += 32) {
    const std::string run = fields.substr(at, 32);
    packed += static_cast<char>(run.size() - 1) + run;
  }
  append(planes, static_cast<std::uint32_t>(packed.size()));
  append(planes, static_cast<std::uint32_t>(fields.size()));
  expect_same(image, read_content(planes + packed).image);
}

TEST(Scan, marks_cells_without_a_point_in_front_of_the_sensor_invalid) {
  RangeImage image = sample_image();
  const float infinity = std::numeric_limits<float>::infinity();
  image[0] = {0.0F, 0.0F, 0.0F};
  image[1] = {1.0F, 2.0F, -500.0F};
  image[2] = {1.0F, 2.0F, infinity};
  image[4] = {infinity, 2.0F, 500.0F};
  image[5] = {1.0F, kHole, 500.0F};
  RangeImage expected = image;
  for (const int cell : {0, 1, 2, 4, 5}) expected[cell].setConstant(kHole);
  for (const auto encoding : {PcdEncoding::ascii, PcdEncoding::binary, PcdEncoding::binary_compressed}) {
    expect_same(expected, read_content(pcd_content(image, encoding)).image);
  }
  expect_same(expected, read_content(ply_content(image, PlyEncoding::ascii, false)).image);
  expect_same(expected, read_content(ply_content(image, PlyEncoding::big, false)).image);
}

TEST(Scan, reads_other_units) {
  RangeImage metres = sample_image();
  for (Eigen::Vector3f& point : metres.points) point /= 1024.0F;
  const std::string content = pcd_content(metres, PcdEncoding::ascii);
  expect_same(sample_image(), read_content(content, {"", 1024.0}).image);
  EXPECT_NE(cause_of([&] { static_cast<void>(read_content(content)); }).find("nearer than 10 mm"), std::string::npos);
  EXPECT_NE(cause_of([&] {
              static_cast<void>(read_content(content, {"", 1e6}));
            }).find("farther than 100 m"),
            std::string::npos);
  for (const double unit : {0.0, -1.0, static_cast<double>(kHole), HUGE_VAL}) {
    EXPECT_THROW(static_cast<void>(read_content(content, {"", unit})), UsageError);
  }
}

TEST(Ply, reads_the_same_bits_in_every_encoding) {
  const RangeImage image = sample_image();
  for (const auto encoding : {PlyEncoding::ascii, PlyEncoding::little, PlyEncoding::big}) {
    for (const bool range_grid : {false, true}) {
      const Scan scan = read_content(ply_content(image, encoding, range_grid));
      expect_same(image, scan.image);
      EXPECT_FALSE(scan.camera.has_value());
    }
  }
}

TEST(DepthPng, reads_back_depth_and_camera) {
  const test::TemporaryFolder folder;
  const PinholeCamera camera{kRows, kColumns, 60.25, 62.5, 23.1, 19.7};
  const double scale = 0.125;
  RangeImage image(kRows, kColumns);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (cell % 5 == 0) continue;
    const double z = 700.0 + scale * cell;
    image[cell] = (camera.ray(cell / kColumns, cell % kColumns) * z).cast<float>();
  }
  write_depth_png(folder.file("scan_000003.png"), image, scale);
  write_camera_json(folder.file("camera.json"), camera, scale);
  const Scan scan = read_scan(folder.file("scan_000003.png"), {folder.file("camera.json"), 1.0});
  expect_same(image, scan.image);
  ASSERT_TRUE(scan.camera.has_value());
  EXPECT_EQ(*scan.camera, camera);
  EXPECT_EQ(read_depth_camera(folder.file("camera.json"), "x").depth_scale, scale);
}

TEST(DepthPng, refuses_what_does_not_fit_16_bits) {
  const test::TemporaryFolder folder;
  const RangeImage image = sample_image();
  const auto cause = [&](double scale) {
    return cause_of([&] { write_depth_png(folder.file("a.png"), image, scale); });
  };
  EXPECT_NE(cause(0.001).find("does not fit 16 bits"), std::string::npos);
  EXPECT_NE(cause(1e6).find("would become 0"), std::string::npos);
  EXPECT_NE(cause(0.0).find("depth_scale"), std::string::npos);
  EXPECT_NE(cause(-1.0).find("depth_scale"), std::string::npos);
  EXPECT_NE(cause_of([&] { write_camera_json(folder.file("c"), {1, 1, 0.0, 1.0, 0.0, 0.0}, 1.0); }), "no error");
}

TEST(DepthPng, needs_a_camera_for_its_own_grid_and_points_need_none) {
  const test::TemporaryFolder folder;
  write_depth_png(folder.file("a.png"), sample_image(), 1.0);
  write_pcd(folder.file("a.pcd"), sample_image());
  write_camera_json(folder.file("camera.json"), {kRows, kColumns, 60.0, 60.0, 0.0, 0.0}, 1.0);
  write_camera_json(folder.file("wide.json"), {kRows, kColumns + 1, 60.0, 60.0, 0.0, 0.0}, 1.0);
  write_camera_json(folder.file("small.json"), {kRows, kColumns, 60.0, 60.0, 0.0, 0.0}, 1e-3);
  const auto cause = [&](const std::string& scan, const std::string& camera) {
    return cause_of([&] {
      static_cast<void>(read_scan(folder.file(scan), {camera.empty() ? "" : folder.file(camera), 1.0}));
    });
  };
  EXPECT_EQ(cause("a.png", "camera.json"), "no error");
  EXPECT_NE(cause("a.png", "").find("does not say how its camera"), std::string::npos);
  EXPECT_NE(cause("a.png", "none.json").find("does not exist"), std::string::npos);
  EXPECT_NE(cause("a.png", "wide.json").find("it is for 49x40"), std::string::npos);
  EXPECT_NE(cause("a.png", "small.json").find("nearer than 10 mm"), std::string::npos);
  EXPECT_NE(cause("a.pcd", "camera.json").find("holds its own points"), std::string::npos);
  write_label_png(folder.file("label.png"), kRows, kColumns, std::vector<int>(kRows * kColumns, 9));
  EXPECT_NE(cause("label.png", "camera.json").find("8-bit"), std::string::npos);
  write_rgb_png(folder.file("rgb.png"), 64, 64, std::vector<unsigned char>(64 * 64 * 3, 9));
  EXPECT_NE(cause("rgb.png", "camera.json").find("not plain grey"), std::string::npos);
  RangeImage small(31, 64);
  small[0] = {0.0F, 0.0F, 100.0F};
  write_depth_png(folder.file("small.png"), small, 1.0);
  EXPECT_NE(cause("small.png", "camera.json").find("too small"), std::string::npos);
  write_depth_png(folder.file("empty.png"), RangeImage(64, 64), 1.0);
  write_camera_json(folder.file("any.json"), {0, 0, 60.0, 60.0, 0.0, 0.0}, 1.0);
  EXPECT_NE(cause("empty.png", "any.json").find("no cell holds a valid point"), std::string::npos);
}

TEST(GreyPng, keeps_labels_and_uses_16_bits_only_where_needed) {
  const test::TemporaryFolder folder;
  for (const int largest : {1, 255, 256, 65535}) {
    const std::vector<int> labels = {0, largest, 1, 0, largest / 2, largest};
    write_label_png(folder.file("a.png"), 2, 3, labels);
    int rows = 0;
    int columns = 0;
    EXPECT_EQ(read_grey_png(folder.file("a.png"), rows, columns), labels);
    EXPECT_EQ(rows, 2);
    EXPECT_EQ(columns, 3);
    EXPECT_EQ(read_whole_file(folder.file("a.png"))[24], largest <= 255 ? 8 : 16);
  }
  int rows = 0;
  int columns = 0;
  put_file(folder.file("b"), "no png");
  EXPECT_THROW(static_cast<void>(read_grey_png(folder.file("b"), rows, columns)), InputError);
}

DepthCamera camera_of(const std::string& json, const std::string& scan) {
  const test::TemporaryFolder folder;
  put_file(folder.file("camera.json"), json);
  return read_depth_camera(folder.file("camera.json"), scan);
}

TEST(DepthCamera, is_found_in_every_form_bop_writes) {
  const std::string k = R"({"cam_K":[600.5,0.0,320.25,0.0,601.5,240.75,0.0,0.0,1.0],"depth_scale":0.1})";
  const std::string other = R"({"cam_K":[1,0,2,0,3,4,0,0,1],"depth_scale":1})";
  for (const std::string& json : {k, "{\"12\":" + k + "}", "{\"2\":" + other + ",\"12\":" + k + "}",
                                  "{\"000012\":" + k + ",\"13\":" + other + "}"}) {
    const DepthCamera camera = camera_of(json, "scene_7/depth_000012.png");
    EXPECT_EQ(camera.camera, (PinholeCamera{0, 0, 600.5, 601.5, 320.25, 240.75}));
    EXPECT_EQ(camera.depth_scale, 0.1);
  }
  EXPECT_EQ(camera_of("{\"5\":" + k + "}", "scan.png").depth_scale, 0.1);  // the only entry
  const DepthCamera plain =
      camera_of(R"({"fx":1.5,"fy":2.5,"cx":-3,"cy":4,"depth_scale":2,"width":640,"height":480,"note":"x"})", "a.png");
  EXPECT_EQ(plain.camera, (PinholeCamera{480, 640, 1.5, 2.5, -3.0, 4.0}));
}

TEST(DepthCamera, refuses_what_is_no_usable_camera) {
  const std::string k = R"({"cam_K":[1,0,2,0,3,4,0,0,1],"depth_scale":1})";
  const std::pair<std::string, const char*> bad[] = {
      {"", "not JSON"},
      {"{\"fx\":1,", "not JSON"},
      {"[]", "no camera"},
      {"{}", "no camera"},
      {"7", "no camera"},
      {"{\"a\":7}", "no camera for"},
      {"{\"1\":" + k + ",\"2\":" + k + "}", "no camera for"},
      {R"({"fx":0,"fy":1,"cx":1,"cy":1,"depth_scale":1})", "fx is not above 0"},
      {R"({"fx":1,"fy":-1,"cx":1,"cy":1,"depth_scale":1})", "fy is not above 0"},
      {R"({"fx":"1","fy":1,"cx":1,"cy":1,"depth_scale":1})", "fx is no number"},
      {R"({"fx":1,"fy":1,"cx":null,"cy":1,"depth_scale":1})", "cx is no number"},
      {R"({"fx":1,"fy":1,"cx":1,"depth_scale":1})", "no cy"},
      {R"({"fx":1,"fy":1,"cx":1,"cy":1})", "no depth_scale"},
      {R"({"fx":1,"fy":1,"cx":1,"cy":1,"depth_scale":0})", "depth_scale is not above 0"},
      {R"({"fx":1,"fy":1,"cx":1,"cy":1,"depth_scale":-0.1})", "depth_scale is not above 0"},
      {R"({"fx":1,"fy":1,"cx":1,"cy":1,"depth_scale":1,"width":0})", "width is no whole number"},
      {R"({"fx":1,"fy":1,"cx":1,"cy":1,"depth_scale":1,"height":1.5})", "height is no whole number"},
      {R"({"fx":1,"fy":1,"cx":1,"cy":1,"depth_scale":1,"height":99999999999999999999})", "height is no whole number"},
      {R"({"cam_K":[1,0,2,0,3,4,0,0],"depth_scale":1})", "nine numbers"},
      {R"({"cam_K":[1,0,2,0,3,4,0,0,"1"],"depth_scale":1})", "nine numbers"},
      {R"({"cam_K":[1,0.5,2,0,3,4,0,0,1],"depth_scale":1})", "skew"},
      {R"({"cam_K":[0,0,2,0,3,4,0,0,1],"depth_scale":1})", "not above 0"},
      {R"({"cam_K":[1,0,2,0,3,4,0,0,1]})", "no depth_scale"}};
  for (const auto& [json, part] : bad) {
    const std::string cause = cause_of([&] { static_cast<void>(camera_of(json, "scan.png")); });
    EXPECT_NE(cause.find(part), std::string::npos) << json << " -> " << cause;
  }
}

TEST(Scan, refuses_what_is_no_scan) {
  const test::TemporaryFolder folder;
  EXPECT_NE(cause_of([&] { static_cast<void>(read_scan(folder.file("none"))); }).find("does not exist"),
            std::string::npos);
  EXPECT_NE(cause_of([&] { static_cast<void>(read_scan(folder.path())); }).find("is a folder"), std::string::npos);
  EXPECT_CAUSE("is empty", "");
  EXPECT_CAUSE("neither a PCD", "solid cube\n");
  EXPECT_CAUSE("neither a PCD", std::string(100'000, '#'));
  EXPECT_CAUSE("neither a PCD", std::string(100'000, '\0'));
  EXPECT_CAUSE("no cell holds a valid point", pcd_content(RangeImage(32, 32), PcdEncoding::binary));
  EXPECT_CAUSE("no cell holds a valid point", ply_content(RangeImage(32, 32), PlyEncoding::ascii, false));
  EXPECT_CAUSE("too small", pcd_content(RangeImage(31, 32), PcdEncoding::binary));
  EXPECT_CAUSE("unorganized", pcd_content(RangeImage(1, 2000), PcdEncoding::binary));
}

TEST(Pcd, refuses_headers_that_lie) {
  const std::string good = pcd_content(sample_image(), PcdEncoding::ascii);
  const std::pair<const char*, const char*> bad[][2] = {
      {{"WIDTH 48", "WIDTH 4097"}, {"too large", ""}},
      {{"WIDTH 48", "WIDTH 9223372036854775807"}, {"too large", ""}},
      {{"WIDTH 48", "WIDTH 99999999999999999999"}, {"no usable number", ""}},
      {{"WIDTH 48", "WIDTH -48"}, {"grid has -48", ""}},
      {{"WIDTH 48", "WIDTH 48.5"}, {"no usable number", ""}},
      {{"WIDTH 48", "WIDTH many"}, {"no usable number", ""}},
      {{"WIDTH 48", "WIDTH"}, {"one number after WIDTH", ""}},
      {{"WIDTH 48\n", ""}, {"no line WIDTH", ""}},
      {{"HEIGHT 40", "HEIGHT 1"}, {"unorganized", ""}},
      {{"HEIGHT 40", "HEIGHT 41"}, {"POINTS are not", ""}},
      {{"POINTS 1920", "POINTS 1921"}, {"POINTS are not", ""}},
      {{"POINTS 1920", "WIDTH 48"}, {"WIDTH twice", ""}},
      {{"VERSION 0.7", "VERSION 0.5"}, {"version", ""}},
      {{"FIELDS x y z", "FIELDS x y"}, {"different lengths", ""}},
      {{"FIELDS x y z", "FIELDS x y w"}, {"no field z", ""}},
      {{"FIELDS x y z", "FIELDS x y y"}, {"two fields y", ""}},
      {{"SIZE 4 4 4", "SIZE 4 4 3"}, {"SIZE '3'", ""}},
      {{"SIZE 4 4 4", "SIZE 4 4 2"}, {"no single float", ""}},
      {{"TYPE F F F", "TYPE F F I"}, {"no single float", ""}},
      {{"TYPE F F F", "TYPE F F Q"}, {"TYPE 'Q'", ""}},
      {{"COUNT 1 1 1", "COUNT 1 1 0"}, {"COUNT '0'", ""}},
      {{"COUNT 1 1 1", "COUNT 1 1 -1"}, {"COUNT '-1'", ""}},
      {{"COUNT 1 1 1", "COUNT 1 1 99999999999"}, {"COUNT '99999999999'", ""}},
      {{"DATA ascii", "DATA words"}, {"DATA is 'words'", ""}},
      {{"DATA ascii", "DOTS ascii"}, {"unknown line", ""}},
      {{"nan nan nan", "nan none nan"}, {"where a number is expected", ""}},
      {{"nan nan nan", "nan nan"}, {"2 values instead of 3", ""}},
      {{"nan nan nan\n", ""}, {"cut short", ""}},
      {{"nan nan nan", "nan nan nan\nnan nan nan"}, {"more points", ""}}};
  for (const auto& [change, expected] : bad) EXPECT_CAUSE(expected.first, replaced(good, change.first, change.second));
  const std::string grid = replaced(replaced(good, "WIDTH 48", "WIDTH 4096"), "HEIGHT 40", "HEIGHT 4096");
  EXPECT_CAUSE("cut short", replaced(grid, "POINTS 1920", "POINTS 16777216"));
}

TEST(Pcd, refuses_absurd_sizes_of_compressed_data) {
  const std::string good = pcd_content(sample_image(), PcdEncoding::binary_compressed);
  const std::size_t at = good.find("binary_compressed\n") + 18;
  const auto with = [&](std::size_t offset, std::uint32_t value) {
    std::string bytes;
    append(bytes, value);
    return std::string(good).replace(at + offset, 4, bytes);
  };
  EXPECT_CAUSE("cut short", with(0, 0xFFFFFFFFU));
  EXPECT_CAUSE("contradict", with(0, 0));
  EXPECT_CAUSE("contradict", with(0, 100));
  EXPECT_CAUSE("contradict", with(4, 0xFFFFFFFFU));
  EXPECT_CAUSE("contradict", with(4, 0));
  EXPECT_CAUSE("damaged", with(0, 5000));
  std::string large = replaced(replaced(good, "WIDTH 48", "WIDTH 4096"), "HEIGHT 40", "HEIGHT 4096");
  EXPECT_CAUSE("contradict", replaced(large, "POINTS 1920", "POINTS 16777216"));
}

TEST(Ply, refuses_headers_that_lie) {
  const std::string good = ply_content(sample_image(), PlyEncoding::ascii, true);
  const std::pair<const char*, const char*> bad[][2] = {
      {{"obj_info num_cols 48\n", ""}, {"unorganized", ""}},
      {{"num_cols 48", "num_cols 1"}, {"unorganized", ""}},
      {{"num_cols 48", "num_cols 31"}, {"too small", ""}},
      {{"num_cols 48", "num_cols 5000"}, {"too large", ""}},
      {{"num_cols 48", "num_cols -48"}, {"grid has -48", ""}},
      {{"num_cols 48", "num_cols some"}, {"no usable number", ""}},
      {{"num_cols 48", "num_cols 99999999999999999999"}, {"no usable number", ""}},
      {{"num_cols 48", "num_cols 49"}, {"do not fill the grid", ""}},
      {{"obj_info is_mesh 0", "obj_info num_cols 47"}, {"two different grids", ""}},
      {{"format ascii 1.0", "format ascii 2.0"}, {"version 1.0", ""}},
      {{"format ascii 1.0", "format octal 1.0"}, {"'octal' is unknown", ""}},
      {{"format ascii 1.0\n", ""}, {"no format line", ""}},
      {{"element vertex", "element corner"}, {"no vertices", ""}},
      {{"element face 9", "element vertex 9"}, {"twice", ""}},
      {{"element face 9", "element face nine"}, {"usable count", ""}},
      {{"element face 9", "element face -9"}, {"usable count", ""}},
      {{"element view 2", "element view 18446744073709551615"}, {"do not fit", ""}},
      {{"element view 2\n", ""}, {"before the first element", ""}},
      {{"property float x", "property float u"}, {"one x, one y and one z", ""}},
      {{"property float x", "property quad x"}, {"unknown type 'quad'", ""}},
      {{"property float x", "property x"}, {"neither a number nor a list", ""}},
      {{"end_header", "end"}, {"unknown line", ""}},
      {{"end_header\n", ""}, {"unknown line", ""}},
      {{"property list uchar int vertex_indices", "property int vertex_index"}, {"not one list", ""}},
      {{"2 -3 4 0.5", "-2 -3 4 0.5"}, {"impossible length", ""}},
      {{"2 -3 4 0.5", "1.5 -3 4 0.5"}, {"impossible length", ""}},
      {{"2 -3 4 0.5", "nan -3 4 0.5"}, {"impossible length", ""}},
      {{"2 -3 4 0.5", "9999999999 -3 4 0.5"}, {"impossible length", ""}},
      {{"\n200 ", "\nred "}, {"no error", ""}},  // another property is not looked at
      {{" 1 -7 ", " 1.0 -7 nonsense "}, {"where a number is expected", ""}}};
  for (const auto& [change, expected] : bad) EXPECT_CAUSE(expected.first, replaced(good, change.first, change.second));
  std::string grid = good;
  grid.replace(grid.rfind(" 1645 "), 6, " 9999 ");
  EXPECT_CAUSE("does not exist", grid);
  EXPECT_CAUSE("do not fill", replaced(ply_content(sample_image(), PlyEncoding::big, false), "element vertex 1920",
                                       "element vertex 18446744073709551615"));
}

std::vector<std::string> every_format(const test::TemporaryFolder& folder) {
  const RangeImage image = sample_image();
  write_depth_png(folder.file("a.png"), image, 0.1);
  return {pcd_content(image, PcdEncoding::ascii),
          pcd_content(image, PcdEncoding::binary),
          pcd_content(image, PcdEncoding::binary_compressed),
          ply_content(image, PlyEncoding::ascii, true),
          ply_content(image, PlyEncoding::little, true),
          ply_content(image, PlyEncoding::big, false),
          read_whole_file(folder.file("a.png"))};
}

// Reads the content as what it is; true when it could be read. Any exception but InputError fails the test.
bool readable(const test::TemporaryFolder& folder, const std::string& content) {
  put_file(folder.file("scan"), content);
  const bool png = content.starts_with("\x89PNG");
  try {
    const Scan scan = read_scan(folder.file("scan"), {png ? folder.file("camera.json") : "", 1.0});
    EXPECT_EQ(scan.image.points.size(), static_cast<std::size_t>(scan.image.size()));
    EXPECT_GT(count_valid(scan.image), 0);
    return true;
  } catch (const InputError& error) {
    EXPECT_FALSE(error.mend().empty());
    return false;
  }
}

TEST(Scan, refuses_every_truncated_file) {
  const test::TemporaryFolder folder;
  write_camera_json(folder.file("camera.json"), {0, 0, 60.0, 60.0, 20.0, 20.0}, 0.1);
  for (const std::string& content : every_format(folder)) {
    EXPECT_TRUE(readable(folder, content));
    for (const std::size_t keep :
         {content.size() / 4, content.size() / 2, content.size() * 3 / 4, content.size() - 20}) {
      EXPECT_FALSE(readable(folder, content.substr(0, keep))) << content.substr(0, 60) << " kept " << keep;
    }
  }
}

TEST(Scan, is_read_or_refused_whatever_was_changed) {
  const test::TemporaryFolder folder;
  write_camera_json(folder.file("camera.json"), {0, 0, 60.0, 60.0, 20.0, 20.0}, 0.1);
  std::uint64_t format = 0;
  for (const std::string& content : every_format(folder)) {
    int refused = 0;
    for (std::uint64_t i = 0; i < 300; ++i) {
      Random random(1995 + format, i);
      std::string changed = content;
      const int flips = random.integer(1, 4);
      for (int flip = 0; flip < flips; ++flip) {
        // Half of them in the header, where the sizes are.
        const auto last =
            static_cast<int>(random.uniform() < 0.5 ? std::min<std::size_t>(content.size(), 400) : content.size());
        changed[static_cast<std::size_t>(random.integer(0, last - 1))] = static_cast<char>(random.integer(0, 255));
      }
      if (i % 10 == 0) changed.resize(static_cast<std::size_t>(random.integer(1, static_cast<int>(changed.size()))));
      refused += readable(folder, changed) ? 0 : 1;
    }
    EXPECT_GT(refused, 30);
    ++format;
  }
}

TEST(RealScans, of_the_structured_light_scanner_are_read) {
  const std::string data = test::real_data_folder();
  if (data.empty()) GTEST_SKIP() << "no real scans here";
  const Scan scan = read_scan(data + "/abw/scans/abw_00.png", {data + "/abw/camera_cal1.json", 1.0});
  EXPECT_EQ(scan.image.rows, 512);
  EXPECT_EQ(scan.image.columns, 512);
  ASSERT_TRUE(scan.camera.has_value());
  EXPECT_EQ(scan.camera->fy, 2306.54);
  const double valid = static_cast<double>(count_valid(scan.image)) / scan.image.size();
  EXPECT_GT(valid, 0.55);  // 19 to 37 % of the cells are shadow
  EXPECT_LT(valid, 0.9);
  for (const Eigen::Vector3f& point : scan.image.points) {
    if (std::isnan(point.z())) continue;
    ASSERT_GT(point.z(), 600.0F);
    ASSERT_LT(point.z(), 1300.0F);
  }
}

TEST(RealScans, of_the_depth_camera_are_read_and_survive_as_pcd) {
  const std::string data = test::real_data_folder();
  if (data.empty()) GTEST_SKIP() << "no real scans here";
  const test::TemporaryFolder folder;
  write_camera_json(folder.file("camera.json"), {480, 640, 607.592, 606.738, 315.667, 249.538}, 1.0);
  const Scan scan = read_scan(data + "/boxes/scans/pallet_0.png", {folder.file("camera.json"), 1.0});
  EXPECT_GT(count_valid(scan.image), 640 * 480 / 2);
  for (const auto encoding : {PcdEncoding::ascii, PcdEncoding::binary, PcdEncoding::binary_compressed}) {
    write_pcd(folder.file("a.pcd"), scan.image, encoding);
    expect_same(scan.image, read_scan(folder.file("a.pcd")).image);
  }
}

}  // namespace
}  // namespace foresight
