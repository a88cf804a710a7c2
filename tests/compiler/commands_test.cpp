#include "compiler/commands.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/scan_file.h"
#include "compiler/digest.h"
#include "runtime/database.h"
#include "tests/solids.h"
#include "tests/support.h"

namespace foresight {
namespace {

// A folder with two CAD files.
struct Workshop {
  test::TemporaryFolder folder;
  std::string step = folder.file("step.obj");
  std::string box = folder.file("box.stl");
  std::string output = folder.file("out.db");

  Workshop() {
    test::write_obj(step, test::make_step());
    test::write_stl(box, test::make_box(80, 60, 40));
  }
  [[nodiscard]] CompileCommand compile(std::vector<std::string> cad_files) const {
    CompileCommand command;
    command.cad_files = std::move(cad_files);
    command.output = output;
    command.progress = "none";
    command.options.samples.views = 20;
    return command;
  }
  [[nodiscard]] SimulateCommand simulate(const std::string& name) const {
    SimulateCommand command;
    command.cad_files = {step, box};
    command.output = folder.file(name);
    command.progress = "none";
    command.scenes = 3;
    return command;
  }
};

// The error of a command; fails the test when there is none.
template <typename ErrorType, typename Command>
std::string error_of(const Command& command) {
  try {
    command();
  } catch (const ErrorType& error) {
    return error.what();
  }
  ADD_FAILURE() << "the command went through";
  return {};
}

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

std::string printed(const InspectCommand& command) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_inspect(command), kExitDone);
  return testing::internal::GetCapturedStdout();
}

TEST(RunCompile, writes_one_object_a_file_with_its_provenance) {
  const Workshop shop;
  EXPECT_EQ(run_compile(shop.compile({shop.step, shop.box})), kExitDone);
  const CompiledDatabase database = load_database(shop.output).content();
  ASSERT_EQ(database.models.size(), 2U);
  EXPECT_EQ(database.models[0].name, "step");
  EXPECT_EQ(database.models[0].cad_file, "step.obj");
  EXPECT_EQ(database.models[0].cad_sha256, sha256_hex(read_whole_file(shop.step)));
  EXPECT_EQ(database.models[1].name, "box");
  EXPECT_EQ(database.models[1].views, 20);
}

TEST(RunCompile, writes_the_same_bytes_at_any_number_of_jobs) {
  const Workshop shop;
  std::vector<std::string> bytes;
  for (const int jobs : {1, 3, 0}) {
    CompileCommand command = shop.compile({shop.step, shop.box});
    command.jobs = jobs;
    run_compile(command);
    bytes.push_back(read_whole_file(shop.output));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_EQ(bytes[0], bytes[2]);
}

TEST(RunCompile, gives_the_names_asked_for) {
  const Workshop shop;
  CompileCommand command = shop.compile({shop.step, shop.box});
  command.names = {"small", "large"};
  run_compile(command);
  const Database database = load_database(shop.output);
  EXPECT_EQ(database.models()[0].name, "small");
  EXPECT_EQ(database.models()[1].name, "large");
}

TEST(RunCompile, reads_lengths_in_the_unit_given) {
  const Workshop shop;
  const std::string in_cm = shop.folder.file("cm.obj");
  test::write_obj(in_cm, test::make_box(8, 6, 4));
  CompileCommand command = shop.compile({in_cm});
  command.unit = "cm";
  run_compile(command);
  const CompiledModel model = load_database(shop.output).models()[0];
  EXPECT_NEAR(model.diameter, std::sqrt(80.0 * 80 + 60 * 60 + 40 * 40), 1e-6);
  EXPECT_EQ(model.cad_unit, "cm");
}

TEST(RunCompile, writes_a_dependency_file_that_make_understands) {
  const Workshop shop;
  const std::string spaced = shop.folder.file("a #1 $.obj");
  test::write_obj(spaced, test::make_step());
  CompileCommand command = shop.compile({shop.box, spaced});
  command.depfile = shop.folder.file("out.d");
  run_compile(command);
  EXPECT_EQ(read_whole_file(command.depfile),
            shop.output + ": " + shop.box + " " + shop.folder.path() + "/a\\ \\#1\\ $$.obj\n");
}

// Refused, and no database is left behind.
template <typename ErrorType>
void expect_refused(const Workshop& shop, const CompileCommand& command, const std::string& words) {
  const std::string text = error_of<ErrorType>([&] { run_compile(command); });
  EXPECT_TRUE(has(text, words)) << text;
  EXPECT_FALSE(std::filesystem::exists(shop.output));
}

TEST(RunCompile, refuses_names_that_do_not_fit_the_files) {
  const Workshop shop;
  CompileCommand command = shop.compile({shop.step, shop.box});
  command.names = {"one"};
  expect_refused<UsageError>(shop, command, "1 names for 2 CAD files");
  command.names = {"one", "one"};
  expect_refused<UsageError>(shop, command, "two objects are named one");
  expect_refused<UsageError>(shop, shop.compile({shop.step, shop.step}), "two objects are named step");
}

TEST(RunCompile, refuses_options_outside_their_limits) {
  const Workshop shop;
  CompileCommand command = shop.compile({shop.box});
  command.options.density.bins = 1;
  expect_refused<UsageError>(shop, command, "density.bins");
  command = shop.compile({shop.box});
  command.options.samples.views = 100;
  expect_refused<UsageError>(shop, command, "views");
}

TEST(RunCompile, refuses_files_it_cannot_use) {
  const Workshop shop;
  const std::string missing = shop.folder.file("missing.obj");
  expect_refused<InputError>(shop, shop.compile({shop.step, missing}), missing);
  CompileCommand command = shop.compile({shop.step});
  command.sensor_file = shop.folder.file("missing.textproto");
  expect_refused<InputError>(shop, command, command.sensor_file);
  write_file_atomically(shop.folder.file("bad.textproto"), "no sensor");
  command.sensor_file = shop.folder.file("bad.textproto");
  expect_refused<InputError>(shop, command, command.sensor_file);
}

TEST(RunCompile, refuses_a_size_the_sensor_cannot_see_and_proposes_a_unit) {
  const Workshop shop;
  CompileCommand command = shop.compile({shop.step});
  command.unit = std::string("m");
  expect_refused<InputError>(shop, command, "mm");
}

TEST(RunLink, equals_compiling_together) {
  const Workshop shop;
  run_compile(shop.compile({shop.step, shop.box}));
  const std::string together = read_whole_file(shop.output);
  LinkCommand link{{shop.folder.file("step.db"), shop.folder.file("box.db")}, shop.folder.file("linked.db")};
  for (const auto& [cad, database] : {std::pair(shop.step, link.databases[0]), {shop.box, link.databases[1]}}) {
    CompileCommand command = shop.compile({cad});
    command.output = database;
    run_compile(command);
  }
  EXPECT_EQ(run_link(link), kExitDone);
  EXPECT_EQ(read_whole_file(link.output), together);
}

TEST(RunLink, refuses_what_does_not_go_together_and_writes_nothing) {
  const Workshop shop;
  run_compile(shop.compile({shop.step}));
  CompileCommand other = shop.compile({shop.box});
  other.output = shop.folder.file("other.db");
  other.options.density.bins = 30;
  run_compile(other);
  const std::string linked = shop.folder.file("linked.db");
  const auto text = error_of<DatabaseError>([&] { run_link({{shop.output, other.output}, linked}); });
  EXPECT_TRUE(has(text, other.output)) << text;
  EXPECT_TRUE(has(error_of<DatabaseError>([&] { run_link({{shop.output, shop.output}, linked}); }), "named step"));
  EXPECT_TRUE(has(error_of<DatabaseError>([&] { run_link({{shop.output, shop.step}, linked}); }), shop.step));
  EXPECT_TRUE(has(error_of<InputError>([&] { run_link({{shop.folder.file("no.db")}, linked}); }), "no.db"));
  EXPECT_FALSE(std::filesystem::exists(linked));
}

TEST(RunInspect, prints_text_or_json) {
  const Workshop shop;
  run_compile(shop.compile({shop.step}));
  EXPECT_TRUE(has(printed({shop.output, false}), "object step: 8 faces"));
  const auto json = nlohmann::json::parse(printed({shop.output, true}));
  EXPECT_EQ(json["objects"][0]["object"], "step");
  EXPECT_EQ(json["bytes"], std::filesystem::file_size(shop.output));
  (void)error_of<DatabaseError>([&] { run_inspect({shop.step, false}); });
}

std::vector<std::string> files_of(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(RunSimulate, writes_scans_and_their_truth_the_same_at_any_number_of_jobs) {
  const Workshop shop;
  SimulateCommand one = shop.simulate("one");
  one.jobs = 1;
  SimulateCommand many = shop.simulate("many");
  many.jobs = 4;
  EXPECT_EQ(run_simulate(one), kExitDone);
  EXPECT_EQ(run_simulate(many), kExitDone);
  const std::vector<std::string> expected = {"scan_0000.pcd", "scan_0001.pcd", "scan_0002.pcd", "truth.json"};
  EXPECT_EQ(files_of(one.output), expected);
  for (const std::string& name : expected)
    EXPECT_EQ(read_whole_file(one.output + "/" + name), read_whole_file(many.output + "/" + name));
  many.seed = 2;
  run_simulate(many);
  EXPECT_NE(read_whole_file(one.output + "/truth.json"), read_whole_file(many.output + "/truth.json"));
}

TEST(RunSimulate, writes_depth_images_with_their_camera) {
  const Workshop shop;
  SimulateCommand command = shop.simulate("png");
  command.format = "png";
  command.scenes = 1;
  command.objects = "2";
  command.background = true;
  run_simulate(command);
  EXPECT_EQ(files_of(command.output), (std::vector<std::string>{"camera.json", "scan_0000.png", "truth.json"}));
  const auto truth = nlohmann::json::parse(read_whole_file(command.output + "/truth.json"));
  EXPECT_TRUE(has(truth.dump(), "scan_0000.png"));
}

TEST(RunSimulate, refuses_numbers_of_objects_it_cannot_place) {
  const Workshop shop;
  SimulateCommand command = shop.simulate("out");
  for (const char* objects : {"", "0", "-1", "two", "1-", "1-x", "2-1", "1-2-3", "3", "1-3", "99999999999"}) {
    command.objects = objects;
    EXPECT_TRUE(has(error_of<UsageError>([&] { run_simulate(command); }), "--objects")) << objects;
  }
  EXPECT_FALSE(std::filesystem::exists(command.output));
}

TEST(RunSimulate, refuses_an_output_that_is_no_folder) {
  const Workshop shop;
  SimulateCommand command = shop.simulate("out");
  command.output = shop.step;
  EXPECT_TRUE(has(error_of<InputError>([&] { run_simulate(command); }), shop.step));
}

}  // namespace
}  // namespace foresight
