// foresightc compile: the same bytes for the same input, whoever compiles where, and a file a build tool can rely on.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "compiler/digest.h"
#include "tests/programs/workshop.h"

namespace foresight::test {
namespace {

namespace fs = std::filesystem;

// Compiles from few views and gives the bytes.
std::string compiled(const std::string& name, std::vector<std::string> arguments) {
  const std::string file = workshop().file(name);
  arguments.insert(arguments.begin(), "compile");
  arguments.insert(arguments.end(), {"-o", file, "--views", "20"});
  const Outcome outcome = foresightc(arguments);
  expect_code(outcome, 0);
  EXPECT_EQ(outcome.out, "");
  return file_content(file);
}

Json inspected(const std::string& name) {
  const Outcome outcome = foresightc({"inspect", workshop().file(name), "--json"});
  expect_code(outcome, 0);
  return Json::parse(outcome.out);
}

// A moment well before now: a file written since then is newer.
void make_old(const std::string& file) {
  fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1));
}

TEST(CompileProgram, gives_the_same_bytes_for_any_number_of_threads) {
  const std::string one = compiled("jobs1.db", {castle(), stick(), "--jobs", "1"});
  ASSERT_FALSE(one.empty());
  EXPECT_EQ(compiled("jobs2.db", {castle(), stick(), "--jobs", "2"}), one);
  EXPECT_EQ(compiled("jobs8.db", {castle(), stick(), "--jobs", "8"}), one);
}

// The same with a sensor that draws noise and distances.
TEST(CompileProgram, draws_the_same_noise_on_any_number_of_threads) {
  const std::string sensor = project_file("models/sensors/scanner.textproto");
  const std::string one = compiled("noise1.db", {stick(), "--sensor", sensor, "--jobs", "1"});
  EXPECT_EQ(compiled("noise8.db", {stick(), "--sensor", sensor, "--jobs", "8"}), one);
  EXPECT_NE(compiled("noise_seed.db", {stick(), "--sensor", sensor, "--seed", "2"}), one);
}

TEST(CompileProgram, does_not_store_where_or_when) {
  const std::string here = compiled("here.db", {stick()});
  fs::create_directories(workshop().file("else where"));
  const std::string copy = workshop().file("else where/stick.off");
  fs::copy_file(stick(), copy);
  EXPECT_EQ(compiled("else where/there.db", {copy}), here);
}

TEST(CompileProgram, sensor_file_of_the_paper_is_the_default) {
  EXPECT_EQ(compiled("paper.db", {stick(), "--sensor", project_file("models/sensors/paper.textproto")}),
            compiled("default.db", {stick()}));
}

TEST(CompileProgram, does_not_rewrite_equal_content) {
  const std::string before = compiled("again.db", {stick(), "--depfile", workshop().file("again.d")});
  for (const char* name : {"again.db", "again.d"}) make_old(workshop().file(name));
  const auto database_time = fs::last_write_time(workshop().file("again.db"));
  const auto depfile_time = fs::last_write_time(workshop().file("again.d"));
  EXPECT_EQ(compiled("again.db", {stick(), "--depfile", workshop().file("again.d")}), before);
  EXPECT_EQ(fs::last_write_time(workshop().file("again.db")), database_time);
  EXPECT_EQ(fs::last_write_time(workshop().file("again.d")), depfile_time);
  EXPECT_NE(compiled("again.db", {stick(), "--bins", "12"}), before);
  EXPECT_GT(fs::last_write_time(workshop().file("again.db")), database_time);
}

TEST(CompileProgram, leaves_nothing_beside_its_output) {
  fs::create_directories(workshop().file("clean"));
  (void)compiled("clean/stick.db", {stick()});
  const auto entries = fs::directory_iterator(workshop().file("clean"));
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(CompileProgram, records_what_it_was_made_from) {
  (void)compiled("recorded.db", {castle(), stick()});
  const Json report = inspected("recorded.db");
  ASSERT_EQ(report["objects"].size(), 2U);
  EXPECT_EQ(report["objects"][0]["object"], "castle");
  EXPECT_EQ(report["objects"][1]["object"], "stick");
  EXPECT_EQ(report["objects"][1]["cad_file"], "stick.off");
  EXPECT_EQ(report["objects"][1]["cad_sha256"], sha256_hex(file_content(stick())));
  EXPECT_EQ(report["objects"][1]["views"], 20);
}

TEST(CompileProgram, names_objects_as_told) {
  (void)compiled("named.db", {castle(), stick(), "--name", "tower", "--name", "T\xC3\xBCr; a 'b' \"c\""});
  const Json report = inspected("named.db");
  EXPECT_EQ(report["objects"][0]["object"], "tower");
  EXPECT_EQ(report["objects"][1]["object"], "T\xC3\xBCr; a 'b' \"c\"");
}

TEST(CompileProgram, knows_the_object_in_metres) {
  std::string metres = "OFF\n";
  const std::vector<std::string> lines = lines_of(file_content(stick()));
  const std::size_t vertices = std::stoul(lines[1]);
  metres += lines[1] + "\n";
  for (std::size_t i = 2; i < lines.size(); ++i) {
    double x = 0.0, y = 0.0, z = 0.0;
    if (i < 2 + vertices && std::sscanf(lines[i].c_str(), "%lf %lf %lf", &x, &y, &z) == 3) {
      metres += std::to_string(x / 1000.0) + " " + std::to_string(y / 1000.0) + " " + std::to_string(z / 1000.0) + "\n";
    } else {
      metres += lines[i] + "\n";
    }
  }
  fs::create_directories(workshop().file("metres"));
  write_content(workshop().file("metres/stick.off"), metres);
  (void)compiled("metres.db", {workshop().file("metres/stick.off"), "--unit", "m"});
  (void)compiled("millimetres.db", {stick()});
  const Json m = inspected("metres.db")["objects"][0], mm = inspected("millimetres.db")["objects"][0];
  EXPECT_EQ(m["cad_unit"], "m");
  EXPECT_NEAR(m["diameter_mm"].get<double>(), mm["diameter_mm"].get<double>(), 0.01);
  EXPECT_EQ(m["faces"].size(), mm["faces"].size());
}

TEST(CompileProgram, tells_its_progress_when_asked) {
  const Outcome outcome =
      foresightc({"compile", stick(), "-o", workshop().file("progress.db"), "--views", "20", "--progress", "plain"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.err.starts_with("compile 0 %\n") && outcome.err.ends_with("compile 100 %\n")) << outcome.err;
}

TEST(CompileProgram, depfile_names_every_input) {
  const std::string sensor = project_file("models/sensors/paper.textproto");
  const std::string depfile = workshop().file("dep.d");
  (void)compiled("dep.db", {castle(), stick(), "--sensor", sensor, "--depfile", depfile});
  EXPECT_EQ(file_content(depfile), workshop().file("dep.db") + ": " + castle() + " " + stick() + " " + sensor + "\n");
}

// A solid of few faces and a sensor of few cells: compiled in half a second.
const std::string kWedge = project_file("tests/consumer/wedge.off");
const std::string kCoarseSensor = project_file("tests/consumer/coarse.textproto");

TEST(CompileProgram, depfile_names_another_target_when_told) {
  const std::string depfile = workshop().file("stamp.d");
  (void)compiled("stamped.db",
                 {kWedge, "--sensor", kCoarseSensor, "--depfile", depfile, "--depfile-target", "a stamp"});
  EXPECT_EQ(file_content(depfile), "a\\ stamp: " + kWedge + " " + kCoarseSensor + "\n");
}

// The build tools themselves read the file, with every character in the names that means something to them.
void expect_made_when_the_cad_changes(const std::string& tool, const std::string& rules_name,
                                      const std::string& rules) {
  if (std::system((tool + " --version >/dev/null 2>&1").c_str()) != 0) GTEST_SKIP() << tool << " is not installed";
  const std::string folder = workshop().file(tool);
  const std::string name = "a b\\ c\\d#e$f:g.off";
  fs::create_directories(folder);
  fs::copy_file(kWedge, folder + "/" + name);
  const std::string cd = "cd " + shell_word(folder) + " && ";
  const std::string compile = cd + shell_word(FORESIGHTC_PROGRAM) + " compile " + shell_word(name) + " --sensor " +
                              shell_word(kCoarseSensor) + " -o out.db --views 20 --depfile out.d";
  ASSERT_EQ(std::system(compile.c_str()), 0);
  write_content(folder + "/" + rules_name, rules);
  const std::string make = cd + tool + " out.db >out 2>&1";
  make_old(folder + "/" + name);
  EXPECT_EQ(std::system(make.c_str()), 0) << file_content(folder + "/out");
  const bool made_at_first = fs::exists(folder + "/log");  // Ninja makes what it has not made before
  EXPECT_EQ(made_at_first, tool == "ninja") << "made although nothing changed";
  fs::remove(folder + "/log");
  EXPECT_EQ(std::system(make.c_str()), 0) << file_content(folder + "/out");
  EXPECT_FALSE(fs::exists(folder + "/log")) << "made again although nothing changed";
  make_old(folder + "/out.db");
  fs::last_write_time(folder + "/" + name, fs::file_time_type::clock::now());
  EXPECT_EQ(std::system(make.c_str()), 0) << file_content(folder + "/out");
  EXPECT_EQ(file_content(folder + "/log"), "made\n") << "not made although the CAD file changed";
}

TEST(CompileProgram, depfile_is_what_make_reads) {
  expect_made_when_the_cad_changes("make", "Makefile", "out.db: ; @echo made >> log\ninclude out.d\n");
}

TEST(CompileProgram, depfile_is_what_ninja_reads) {
  expect_made_when_the_cad_changes(
      "ninja", "build.ninja",
      "rule made\n  command = echo made >> log && touch out.db\n  depfile = out.d\nbuild out.db: made\n");
}

}  // namespace
}  // namespace foresight::test
