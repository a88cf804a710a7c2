// CAD files to poses through both programs: compile, simulate, recognize.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "common/scan_file.h"
#include "tests/programs/workshop.h"

namespace foresight::test {
namespace {

using OrderedJson = nlohmann::ordered_json;
using Point = std::array<double, 3>;

std::vector<Point> vertices_of(const std::string& off) {
  std::ifstream in(off);
  std::string magic;
  std::size_t vertices = 0, faces = 0, edges = 0;
  in >> magic >> vertices >> faces >> edges;
  std::vector<Point> points(vertices);
  for (Point& p : points) in >> p[0] >> p[1] >> p[2];
  return points;
}

Point moved(const Json& pose, const Point& p) {
  Point q{};
  for (std::size_t row = 0; row < 3; ++row) {
    q[row] = pose[row][3].get<double>();
    for (std::size_t k = 0; k < 3; ++k) q[row] += pose[row][k].get<double>() * p[k];
  }
  return q;
}

// How far a vertex of the object in one pose is at most from the nearest vertex in the other: 0 for poses that the
// object's symmetry makes the same. Unit: mm.
double pose_distance(const std::string& off, const Json& a, const Json& b) {
  const std::vector<Point> vertices = vertices_of(off);
  double farthest = 0.0;
  for (const Point& v : vertices) {
    const Point p = moved(a, v);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Point& w : vertices) {
      const Point q = moved(b, w);
      nearest = std::min(nearest, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

Json recognized(const std::string& database, const std::string& scan, const std::vector<std::string>& options = {}) {
  std::vector<std::string> arguments = {"recognize", database, scan, "--format", "json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = foresight(arguments);
  EXPECT_EQ(outcome.err, "");
  const Json json = Json::parse(outcome.out);
  const int code = !json["complete"].get<bool>() ? 5 : json["detections"].empty() ? 1 : 0;
  EXPECT_EQ(outcome.code, code) << outcome.out;
  return json;
}

// How many of the scenes' objects were found in the right pose, among how many.
std::pair<int, int> count_found(const std::vector<SimulatedScene>& scenes) {
  int found = 0, there = 0;
  for (const SimulatedScene& scene : scenes) {
    const Json result = recognized(two_objects(), scene.scan);
    for (const TrueObject& object : scene.objects) {
      const auto& detections = result["detections"];
      const std::string off = project_file("models/" + object.name + ".off");
      const bool right = std::any_of(detections.begin(), detections.end(), [&](const Json& detection) {
        return detection["object"] == object.name && pose_distance(off, detection["pose"], object.T_sensor_model) < 5.0;
      });
      found += right ? 1 : 0;
      ++there;
    }
  }
  return {found, there};
}

std::vector<std::string> keys(const OrderedJson& object) {
  std::vector<std::string> names;
  for (const auto& item : object.items()) names.push_back(item.key());
  return names;
}

std::string without_times(const std::string& json_lines) {
  std::string kept;
  for (const std::string& line : lines_of(json_lines)) kept += line.substr(0, line.find("\"milliseconds\"")) + "\n";
  return kept;
}

TEST(RecognizeProgram, finds_single_objects_in_most_scenes) {
  const auto [found, there] = count_found(single_scenes());
  EXPECT_EQ(there, 10);
  EXPECT_GE(found, 7);
}

TEST(RecognizeProgram, finds_two_objects_in_one_scan) {
  const auto [found, there] = count_found(pair_scenes());
  EXPECT_EQ(there, 12);
  EXPECT_GE(found, 8);
}

TEST(RecognizeProgram, json_has_the_documented_keys_in_their_order) {
  const Outcome outcome = foresight({"recognize", two_objects(), stick_scene().scan, "--format", "json"});
  expect_code(outcome, 0);
  ASSERT_EQ(lines_of(outcome.out).size(), 1U);
  const std::string line = lines_of(outcome.out)[0];
  const OrderedJson json = OrderedJson::parse(line);
  using Names = std::vector<std::string>;
  EXPECT_EQ(keys(json), (Names{"scan", "complete", "detections", "statistics", "milliseconds"}));
  ASSERT_FALSE(json["detections"].empty());
  EXPECT_EQ(keys(json["detections"][0]), (Names{"object", "pose", "score", "alpha", "beta", "gamma", "rank", "faces",
                                                "regions", "ambiguous_with", "quaternion", "covariance", "box"}));
  EXPECT_EQ(keys(json["statistics"]), (Names{"regions", "possible_matches", "threshold_matches", "active_matches",
                                             "hypotheses", "verifications", "energy_evaluations", "pose_checks"}));
  EXPECT_EQ(keys(json["milliseconds"]),
            (Names{"read", "extract", "field", "hypotheses", "localize", "verify", "total"}));
  // Also for readers that go by the text: one object without blanks, the numbers in full precision.
  EXPECT_TRUE(
      line.starts_with("{\"scan\":\"" + stick_scene().scan + "\",\"complete\":true,\"detections\":[{\"object\":"))
      << line;
  EXPECT_EQ(json.dump(), line);
}

TEST(RecognizeProgram, json_values_are_what_their_names_say) {
  const Json json = recognized(two_objects(), stick_scene().scan);
  const Json& detection = json["detections"][0];
  const Json& pose = detection["pose"];
  ASSERT_EQ(pose.size(), 4U);
  for (std::size_t a = 0; a < 3; ++a) {
    ASSERT_EQ(pose[a].size(), 4U);
    for (std::size_t b = 0; b < 3; ++b) {
      double dot = 0.0;
      for (std::size_t k = 0; k < 3; ++k) dot += pose[a][k].get<double>() * pose[b][k].get<double>();
      EXPECT_NEAR(dot, a == b ? 1.0 : 0.0, 1e-9);
    }
  }
  EXPECT_EQ(pose[3], Json({0.0, 0.0, 0.0, 1.0}));
  for (const char* fraction : {"score", "alpha", "beta", "gamma"}) {
    EXPECT_GE(detection[fraction].get<double>(), 0.0) << fraction;
    EXPECT_LE(detection[fraction].get<double>(), 1.0) << fraction;
  }
  EXPECT_GE(detection["rank"].get<int>(), 1);
  EXPECT_TRUE(detection["ambiguous_with"].is_array());
  EXPECT_EQ(detection["faces"].size(), detection["regions"].size());
  const Json& counts = json["statistics"];
  EXPECT_GE(counts["possible_matches"], counts["threshold_matches"]);
  EXPECT_GE(counts["threshold_matches"], counts["active_matches"]);
  EXPECT_GE(counts["verifications"], json["detections"].size());
  double parts = 0.0;
  for (const auto& [stage, time] : json["milliseconds"].items()) parts += stage == "total" ? 0.0 : time.get<double>();
  EXPECT_LE(parts, json["milliseconds"]["total"].get<double>() + 1e-6);
}

TEST(RecognizeProgram, judges_poses_by_the_method_asked_for) {
  const std::string scan = stick_scene().scan;
  const Json two_way = recognized(two_objects(), scan, {"--method", "two-way"});
  EXPECT_EQ(two_way["detections"], recognized(two_objects(), scan)["detections"]);
  ASSERT_FALSE(two_way["detections"].empty());
  for (const Json& detection : two_way["detections"]) EXPECT_GE(detection["score"].get<double>(), 0.5);
  EXPECT_GE(two_way["statistics"]["pose_checks"], two_way["statistics"]["verifications"]);
  const Json paper = recognized(two_objects(), scan, {"--method", "paper"});
  ASSERT_FALSE(paper["detections"].empty());
  for (const Json& detection : paper["detections"]) EXPECT_EQ(detection["score"], detection["alpha"]);
  EXPECT_EQ(paper["statistics"]["pose_checks"], 0);
}

TEST(RecognizeProgram, says_the_same_twice) {
  std::vector<std::string> arguments = {"recognize", two_objects(), "--format", "json"};
  for (const SimulatedScene& scene : pair_scenes()) arguments.push_back(scene.scan);
  const Outcome first = foresight(arguments);
  const Outcome second = foresight(arguments);
  expect_code(first, 0);
  EXPECT_TRUE(contains(first.out, "\"milliseconds\""));
  EXPECT_EQ(without_times(first.out), without_times(second.out));
}

TEST(RecognizeProgram, prints_a_line_a_scan_in_the_order_given) {
  const std::string a = single_scenes()[2].scan, b = single_scenes()[0].scan, c = single_scenes()[1].scan;
  const Outcome together = foresight({"recognize", two_objects(), a, b, c, "--format", "json"});
  expect_code(together, 0);
  const std::vector<std::string> lines = lines_of(together.out);
  ASSERT_EQ(lines.size(), 3U);
  std::string apart;
  for (const std::string& scan : {a, b, c}) {
    apart += foresight({"recognize", two_objects(), scan, "--format", "json"}).out;
  }
  EXPECT_EQ(without_times(together.out), without_times(apart));
}

TEST(RecognizeProgram, text_says_the_same_as_json) {
  const Json json = recognized(two_objects(), stick_scene().scan);
  const Outcome outcome = foresight({"recognize", two_objects(), stick_scene().scan});
  expect_code(outcome, 0);
  const std::vector<std::string> lines = lines_of(outcome.out);
  ASSERT_GE(lines.size(), 6U);
  EXPECT_EQ(lines[0], stick_scene().scan + ": " + std::to_string(json["detections"].size()) + " recognized");
  EXPECT_TRUE(lines[1].starts_with("  stick  score ")) << lines[1];
  EXPECT_TRUE(contains(outcome.out, std::to_string(json["statistics"]["regions"].get<int>()) + " regions; matches: "));
  std::istringstream row(lines[2]);
  for (std::size_t k = 0; k < 4; ++k) {
    double value = 0.0;
    row >> value;
    EXPECT_NEAR(value, json["detections"][0]["pose"][0][k].get<double>(), 1e-3);
  }
}

TEST(RecognizeProgram, bop_csv_has_one_header_and_a_row_a_detection) {
  std::vector<std::string> arguments = {"recognize", two_objects(), "--format", "bop-csv"};
  std::size_t detections = 0;
  std::map<std::string, std::size_t> rows_of;  // by image number
  for (std::size_t i = 0; i < 4; ++i) {
    arguments.push_back(pair_scenes()[i].scan);
    const std::size_t found = recognized(two_objects(), pair_scenes()[i].scan)["detections"].size();
    rows_of[std::to_string(i)] = found;
    detections += found;
  }
  const Outcome outcome = foresight(arguments);
  expect_code(outcome, 0);
  std::vector<std::string> lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), detections + 1);
  EXPECT_EQ(lines[0], "scene_id,im_id,obj_id,score,R,t,time");
  lines.erase(lines.begin());
  for (const std::string& line : lines) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    ASSERT_EQ(fields.size(), 7U) << line;
    ASSERT_GT(rows_of[fields[1]]--, 0U) << line;
    EXPECT_TRUE(fields[2] == "1" || fields[2] == "2") << line;
    EXPECT_EQ(std::count(fields[4].begin(), fields[4].end(), ' '), 8) << line;
    EXPECT_EQ(std::count(fields[5].begin(), fields[5].end(), ' '), 2) << line;
    EXPECT_GT(std::stod(fields[6]), 0.0) << line;
    EXPECT_LT(std::stod(fields[6]), 60.0) << "not seconds: " << line;
  }
}

TEST(RecognizeProgram, top_stops_after_so_many_detections) {
  for (const SimulatedScene& scene : pair_scenes()) {
    const Json all = recognized(two_objects(), scene.scan);
    const Json one = recognized(two_objects(), scene.scan, {"--top", "1"});
    ASSERT_EQ(one["detections"].size(), std::min<std::size_t>(1, all["detections"].size()));
    EXPECT_EQ(recognized(two_objects(), scene.scan, {"--top", "0"})["detections"], all["detections"]);
  }
}

TEST(RecognizeProgram, ends_with_one_when_nothing_is_there) {
  RangeImage wall(64, 64);
  for (int cell = 0; cell < wall.size(); ++cell) {
    wall[cell] = {3.0F * static_cast<float>(cell % 64 - 32), 3.0F * static_cast<float>(cell / 64 - 32), 900.0F};
  }
  const std::string scan = workshop().file("wall.pcd");
  write_pcd(scan, wall);
  const Outcome outcome = foresight({"recognize", two_objects(), scan});
  expect_code(outcome, 1);
  EXPECT_TRUE(outcome.out.starts_with(scan + ": nothing recognized\n")) << outcome.out;
  // Nothing in one scan does not matter when another holds something.
  expect_code(foresight({"recognize", two_objects(), scan, stick_scene().scan}), 0);
}

TEST(RecognizeProgram, says_with_its_code_whether_the_deadline_came_first) {
  const std::string folder = workshop().file("clutter");
  std::vector<std::string> arguments = {"simulate", "-o", folder, "--scenes", "1", "--objects", "6", "--seed", "3"};
  for (const char* name : {"castle", "stick", "holed_cube", "pencil_box", "rolodex", "stapler"}) {
    arguments.push_back(project_file(std::string("models/") + name + ".off"));
  }
  must_succeed(foresightc(arguments));
  // recognized() expects code 5 exactly where the result is not complete.
  const Json hurried = recognized(two_objects(), folder + "/scan_0000.pcd", {"--deadline-ms", "1"});
  const double spent = hurried["milliseconds"]["total"].get<double>() - hurried["milliseconds"]["read"].get<double>();
  EXPECT_TRUE(!hurried["complete"].get<bool>() || spent < 5.0) << hurried;
}

TEST(RecognizeProgram, a_deadline_far_away_changes_nothing) {
  const std::string scan = pair_scenes()[0].scan;
  const Json unhurried = recognized(two_objects(), scan, {"--deadline-ms", "600000"});
  EXPECT_EQ(unhurried["complete"], true);
  EXPECT_EQ(unhurried["detections"], recognized(two_objects(), scan)["detections"]);
}

TEST(RecognizeProgram, progress_goes_to_stderr_and_leaves_stdout_alone) {
  const std::vector<std::string> arguments = {
      "recognize", two_objects(), single_scenes()[0].scan, single_scenes()[1].scan, "--format", "json"};
  std::vector<std::string> plain = arguments;
  plain.insert(plain.end(), {"--progress", "plain"});
  const Outcome told = foresight(plain);
  EXPECT_TRUE(contains(told.err, "recognize 0 %\n")) << told.err;
  EXPECT_TRUE(told.err.ends_with("recognize 100 %\n")) << told.err;
  EXPECT_EQ(without_times(told.out), without_times(foresight(arguments).out));
}

// The grid of a PNG is coarser than the numbers of a PCD; the object is the same.
TEST(RecognizeProgram, reads_depth_png_with_its_camera) {
  const auto scenes = [] {
    const std::string folder = workshop().file("png");
    must_succeed(foresightc({"simulate", stick(), "-o", folder, "--scenes", "4", "--seed", "7", "--format", "png"}));
    return read_scenes(folder);
  }();
  int found = 0;
  for (const SimulatedScene& scene : scenes) {
    const Json result = recognized(two_objects(), scene.scan, {"--camera", workshop().file("png/camera.json")});
    for (const Json& detection : result["detections"]) {
      found += pose_distance(stick(), detection["pose"], scene.objects[0].T_sensor_model) < 5.0 ? 1 : 0;
    }
  }
  EXPECT_GE(found, 3);
}

TEST(RecognizeProgram, takes_scans_in_metres) {
  RangeImage image = read_scan(stick_scene().scan).image;
  for (Eigen::Vector3f& point : image.points) point /= 1000.0F;
  const std::string scan = workshop().file("metres.pcd");
  write_pcd(scan, image);
  const Json result = recognized(two_objects(), scan, {"--scan-unit", "m"});
  ASSERT_FALSE(result["detections"].empty());
  EXPECT_LT(pose_distance(stick(), result["detections"][0]["pose"], stick_scene().objects[0].T_sensor_model), 5.0);
}

TEST(RecognizeProgram, says_when_its_output_cannot_be_written) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const std::string command = shell_word(FORESIGHT_PROGRAM) + " recognize " + shell_word(two_objects()) + " " +
                              shell_word(stick_scene().scan) + " >/dev/full 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 3);
}

// A BOP scene folder of the stick's scan under two numbers, each with its own depth_scale.
std::string bop_scene() {
  const std::string scene = workshop().file("test/000048");
  std::filesystem::create_directories(scene + "/depth");
  const RangeImage image = read_scan(stick_scene().scan).image;
  const PinholeCamera camera = fit_camera(image).value();
  Json cameras;
  for (const auto& [number, scale] : {std::pair(2, 0.05), std::pair(15, 0.1)}) {
    const std::string digits = std::to_string(number);
    write_depth_png(scene + "/depth/" + std::string(6 - digits.size(), '0') + digits + ".png", image, scale);
    cameras[digits] = {{"cam_K", {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1}}, {"depth_scale", scale}};
  }
  write_content(scene + "/scene_camera.json", cameras.dump());
  return scene;
}

TEST(RecognizeProgram, takes_a_bop_scene_folder_for_all_its_images) {
  const std::string scene = bop_scene();
  const Outcome outcome = foresight({"recognize", two_objects(), scene, stick_scene().scan, "--format", "json"});
  expect_code(outcome, 0);
  const std::vector<std::string> lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(Json::parse(lines[0])["scan"], scene + "/depth/000002.png");
  EXPECT_EQ(Json::parse(lines[1])["scan"], scene + "/depth/000015.png");
  for (const std::string& line : lines) {
    const Json json = Json::parse(line);
    ASSERT_EQ(json["detections"].size(), 1U);
    EXPECT_LT(pose_distance(stick(), json["detections"][0]["pose"], stick_scene().objects[0].T_sensor_model), 5.0);
  }
}

// BOP toolkit, bop_toolkit_lib/inout.py, load_bop_results: seven columns, R and t split at blanks, one time an image.
TEST(RecognizeProgram, writes_bop_results_of_a_scene_folder) {
  const std::string scene = bop_scene();
  const Outcome outcome = foresight({"recognize", two_objects(), scene + "/", "--format", "bop-csv"});
  expect_code(outcome, 0);
  const std::vector<std::string> lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "scene_id,im_id,obj_id,score,R,t,time");
  EXPECT_TRUE(lines[1].starts_with("48,2,2,")) << lines[1];  // the stick is the database's second
  EXPECT_TRUE(lines[2].starts_with("48,15,2,")) << lines[2];
}

TEST(RecognizeProgram, refuses_a_camera_for_a_scene_folder) {
  const Outcome outcome = foresight({"recognize", two_objects(), bop_scene(), "--camera", "camera.json"});
  expect_refused(outcome, 2, "foresight", "--camera", "scene_camera.json in the folder");
}

// api_example.cpp and api_example_c.c: users of the library, who know its public headers alone.
class ApiExample : public ::testing::TestWithParam<const char*> {};

TEST_P(ApiExample, recognizes_what_the_program_does) {
  const std::string scan = workshop().file("ascii.pcd");
  write_pcd(scan, read_scan(stick_scene().scan).image, PcdEncoding::ascii);
  const Outcome example = run(GetParam(), {two_objects(), scan});
  expect_code(example, 0);
  const Json result = recognized(two_objects(), scan);
  const std::vector<std::string> lines = lines_of(example.out);
  ASSERT_EQ(lines.size(), result["detections"].size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Json& detection = result["detections"][i];
    std::istringstream line(lines[i]);
    std::string object;
    line >> object;
    EXPECT_EQ(object, detection["object"]);
    const auto expect_next = [&](double expected, double tolerance) {
      double value = 0.0;
      line >> value;
      EXPECT_NEAR(value, expected, tolerance);
    };
    for (std::size_t row = 0; row < 3; ++row) expect_next(detection["pose"][row][3], 1e-2);
    for (std::size_t k = 0; k < 4; ++k) expect_next(detection["quaternion"][k], 1e-4);
  }
}

TEST_P(ApiExample, hears_of_a_bad_database) {
  const Outcome example = run(GetParam(), {castle(), stick_scene().scan});
  EXPECT_TRUE(example.code == 3 || example.code == 4) << example.code;
  EXPECT_TRUE(contains(example.err, "castle.off: this is a text file, not a Foresight database")) << example.err;
}

INSTANTIATE_TEST_SUITE_P(Languages, ApiExample, ::testing::Values(API_EXAMPLE_PROGRAM, API_EXAMPLE_C_PROGRAM),
                         [](const auto& language) { return language.index == 0 ? "cpp" : "c"; });

}  // namespace
}  // namespace foresight::test
