// foresightc simulate: scans with their truth, the same for the same seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "common/scan_file.h"
#include "tests/programs/workshop.h"

namespace foresight::test {
namespace {

using Files = std::map<std::string, std::string>;  // content by name

Files simulated(const std::string& name, const std::vector<std::string>& options, const std::string& scenes = "3") {
  const std::string folder = workshop().file(name);
  std::vector<std::string> arguments = {"simulate", castle(), stick(), "-o", folder, "--scenes", scenes};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = foresightc(arguments);
  expect_code(outcome, 0);
  EXPECT_EQ(outcome.out, "");
  Files files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files[entry.path().filename().string()] = file_content(entry.path().string());
  }
  return files;
}

std::vector<std::string> names(const Files& files) {
  std::vector<std::string> list;
  for (const auto& [name, content] : files) list.push_back(name);
  return list;
}

TEST(SimulateProgram, writes_the_same_files_twice_on_any_number_of_threads) {
  const std::vector<std::string> options = {"--objects", "1-2", "--background", "--noise", "0.3"};
  std::vector<std::string> one_job = options, many_jobs = options;
  one_job.insert(one_job.end(), {"--jobs", "1"});
  many_jobs.insert(many_jobs.end(), {"--jobs", "8"});
  const Files files = simulated("once", options);
  EXPECT_EQ(names(files), (std::vector<std::string>{"scan_0000.pcd", "scan_0001.pcd", "scan_0002.pcd", "truth.json"}));
  EXPECT_TRUE(simulated("twice", options) == files);
  EXPECT_TRUE(simulated("one_job", one_job) == files);
  EXPECT_TRUE(simulated("many_jobs", many_jobs) == files);
}

TEST(SimulateProgram, a_seed_is_a_series) {
  EXPECT_FALSE(simulated("seed1", {"--seed", "1"}) == simulated("seed2", {"--seed", "2"}));
  // A longer series begins with the shorter one.
  EXPECT_EQ(simulated("longer", {}, "4")["scan_0001.pcd"], simulated("shorter", {})["scan_0001.pcd"]);
}

TEST(SimulateProgram, truth_says_what_each_scan_shows) {
  const Json truth = Json::parse(simulated("truth", {"--objects", "1-2"}, "8")["truth.json"]);
  EXPECT_EQ(truth["unit"], "mm");
  ASSERT_EQ(truth["scans"].size(), 8U);
  std::set<std::size_t> counts;
  for (const Json& scan : truth["scans"]) {
    counts.insert(scan["objects"].size());
    EXPECT_TRUE(std::filesystem::exists(workshop().file("truth/" + scan["scan"].get<std::string>())));
    std::set<std::string> shown;
    for (const Json& object : scan["objects"]) {
      EXPECT_TRUE(shown.insert(object["object"]).second) << "one object twice in a scene";
      EXPECT_GT(object["visible_fraction"], 0.0);
      EXPECT_LE(object["visible_fraction"], 1.0);
      EXPECT_EQ(object["T_sensor_model"].size(), 4U);
      EXPECT_GT(object["T_sensor_model"][2][3], 0.0) << "behind the sensor";
    }
  }
  EXPECT_EQ(counts, (std::set<std::size_t>{1, 2}));
}

TEST(SimulateProgram, background_fills_the_scan) {
  (void)simulated("floating", {});
  (void)simulated("resting", {"--background"});
  const auto points = [](const std::string& name) {
    return count_valid(read_scan(workshop().file(name + "/scan_0000.pcd")).image);
  };
  EXPECT_GT(points("resting"), points("floating"));
  EXPECT_GT(points("resting"), 240 * 256 / 2);
}

TEST(SimulateProgram, noise_spreads_the_depth) {
  (void)simulated("clean", {"--noise", "0"});
  (void)simulated("noisy", {"--noise", "1"});
  const RangeImage clean = read_scan(workshop().file("clean/scan_0000.pcd")).image;
  const RangeImage noisy = read_scan(workshop().file("noisy/scan_0000.pcd")).image;
  double sum = 0.0;
  int cells = 0;
  for (int cell = 0; cell < clean.size(); ++cell) {
    if (!clean.valid(cell) || !noisy.valid(cell)) continue;
    const double difference = static_cast<double>(noisy[cell].z()) - static_cast<double>(clean[cell].z());
    sum += difference * difference;
    ++cells;
  }
  ASSERT_GT(cells, 1000);
  EXPECT_NEAR(std::sqrt(sum / cells), 1.0, 0.1);
}

TEST(SimulateProgram, depth_png_and_camera_hold_what_pcd_holds) {
  (void)simulated("as_pcd", {});
  const Files files = simulated("as_png", {"--format", "png"});
  EXPECT_EQ(names(files),
            (std::vector<std::string>{"camera.json", "scan_0000.png", "scan_0001.png", "scan_0002.png", "truth.json"}));
  const RangeImage pcd = read_scan(workshop().file("as_pcd/scan_0001.pcd")).image;
  ScanReadOptions options;
  options.camera_file = workshop().file("as_png/camera.json");
  const RangeImage png = read_scan(workshop().file("as_png/scan_0001.png"), options).image;
  ASSERT_EQ(pcd.size(), png.size());
  for (int cell = 0; cell < pcd.size(); ++cell) {
    ASSERT_EQ(pcd.valid(cell), png.valid(cell)) << cell;
    ASSERT_FALSE(pcd.valid(cell) && (pcd[cell] - png[cell]).norm() > 0.11F) << cell;
  }
}

// File names are bytes, JSON is UTF-8.
TEST(SimulateProgram, takes_a_cad_file_whose_name_is_no_utf8) {
  const std::string cad = workshop().file(
      "st\xFC"
      "ck.off");
  std::filesystem::copy_file(stick(), cad);
  const Outcome outcome = foresightc({"simulate", cad, "-o", workshop().file("latin"), "--scenes", "1"});
  expect_code(outcome, 0);
  EXPECT_TRUE(Json::accept(file_content(workshop().file("latin/truth.json"))));
}

}  // namespace
}  // namespace foresight::test
