// foresight selftest: whether the objects of a database are recognized as when it was compiled.
#include <gtest/gtest.h>

#include <functional>

#include "compiler/database_writer.h"
#include "runtime/database.h"
#include "tests/programs/workshop.h"
#include "tests/solids.h"

namespace foresight::test {
namespace {

// A copy of the two objects' database with something changed, its checksums right.
std::string changed(const std::string& name, const std::function<void(std::vector<CompiledModel>&)>& change) {
  CompiledDatabase database = decode_database(file_content(two_objects()), two_objects());
  change(database.models);
  const std::string file = workshop().file(name);
  write_content(file, encode_database(database));
  return file;
}

Json selftest_json(const std::string& database, int code) {
  const Outcome outcome = foresight({"selftest", database, "--format", "json"});
  expect_code(outcome, code);
  EXPECT_EQ(lines_of(outcome.out).size(), 1U) << outcome.out;
  return Json::parse(outcome.out);
}

TEST(SelftestProgram, passes_with_a_database_as_compiled) {
  const Outcome outcome = foresight({"selftest", two_objects()});
  expect_code(outcome, 0);
  const std::vector<std::string> lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 3U) << outcome.out;
  EXPECT_TRUE(lines[0].starts_with("castle: right, ")) << lines[0];
  EXPECT_TRUE(lines[1].starts_with("stick: right, ")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("passed: 2 right, 0 failed, 0 not tested; ")) << lines[2];
}

TEST(SelftestProgram, tells_as_json_what_came_of_each_object) {
  const Json json = selftest_json(two_objects(), 0);
  EXPECT_EQ(json["database"], two_objects());
  EXPECT_EQ(json["passed"], true);
  EXPECT_EQ(json["right"], 2);
  ASSERT_EQ(json["objects"].size(), 2U);
  for (const Json& object : json["objects"]) {
    EXPECT_EQ(object["verdict"], "right");
    EXPECT_LT(object["position_error_mm"], 1.0);
    EXPECT_LT(object["angle_error_deg"], 1.0);
    EXPECT_GE(object["score"], 0.5);
    EXPECT_GT(object["milliseconds"], 0.0);
  }
}

TEST(SelftestProgram, does_not_depend_on_what_else_is_in_the_database) {
  const Json both = selftest_json(two_objects(), 0);
  const Json alone = selftest_json(changed("alone.db", [](auto& models) { models.erase(models.begin()); }), 0);
  for (const char* key : {"object", "verdict", "position_error_mm", "angle_error_deg", "score"})
    EXPECT_EQ(both["objects"][1][key], alone["objects"][0][key]) << key;
}

TEST(SelftestProgram, fails_when_golden_scans_are_of_other_objects) {
  const std::string file =
      changed("swapped.db", [](auto& models) { std::swap(models[0].golden_scan, models[1].golden_scan); });
  const Outcome outcome = foresight({"selftest", file});
  expect_code(outcome, 1);
  EXPECT_TRUE(contains(outcome.out, "castle: FAILED")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "stick: FAILED")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "\nFAILED: 0 right, 2 failed")) << outcome.out;
  EXPECT_EQ(selftest_json(file, 1)["failed"], 2);
}

TEST(SelftestProgram, fails_when_one_pose_is_another) {
  const std::string file =
      changed("moved.db", [](auto& models) { models[1].golden_scan->T_sensor_model.translation.y() += 40.0; });
  const Json json = selftest_json(file, 1);
  EXPECT_EQ(json["passed"], false);
  EXPECT_EQ(json["objects"][0]["verdict"], "right");
  EXPECT_EQ(json["objects"][1]["verdict"], "wrong");
  EXPECT_NEAR(json["objects"][1]["position_error_mm"].get<double>(), 40.0, 1.0);
}

TEST(SelftestProgram, says_which_objects_have_no_golden_scan) {
  const std::string one = changed("one_golden.db", [](auto& models) { models[0].golden_scan.reset(); });
  const Outcome outcome = foresight({"selftest", one});
  expect_code(outcome, 0);
  EXPECT_TRUE(contains(outcome.out, "castle: not tested, no golden scan")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "1 right, 0 failed, 1 not tested")) << outcome.out;
  const std::string none = changed("none_golden.db", [](auto& models) {
    for (CompiledModel& model : models) model.golden_scan.reset();
  });
  const Json json = selftest_json(none, 1);
  EXPECT_EQ(json["not_tested"], 2);
  EXPECT_EQ(json["failed"], 0);
  EXPECT_TRUE(json["objects"][0]["score"].is_null());
}

TEST(SelftestProgram, refuses_databases_it_cannot_use) {
  const std::string missing = workshop().file("missing.db");
  expect_refused(foresight({"selftest", missing}), 3, "foresight", missing, "");
  std::string bytes = file_content(two_objects());
  bytes[bytes.size() / 2] ^= 1;
  const std::string damaged = workshop().file("damaged.db");
  write_content(damaged, bytes);
  expect_refused(foresight({"selftest", damaged}), 4, "foresight", damaged, "checksum");
  const std::string wrong = changed("wrong_golden.db", [](auto& models) { models[0].golden_scan->depths.resize(10); });
  expect_refused(foresight({"selftest", wrong}), 4, "foresight", wrong, "golden scan cannot be used");
}

// Each view of a sheet shows one face at most, which leaves its pose open.
TEST(SelftestProgram, compiler_warns_of_objects_without_golden_scan) {
  const std::string cad = workshop().file("sheet.obj");
  write_obj(cad, make_box(80.0, 60.0, 0.2));
  const std::string database = workshop().file("sheet.db");
  const Outcome compiled = foresightc({"compile", cad, "-o", database, "--views", "20"});
  EXPECT_EQ(compiled.code, 0) << compiled.err;
  EXPECT_TRUE(compiled.err.starts_with("foresightc: " + cad + ": warning: ")) << compiled.err;
  EXPECT_EQ(lines_of(compiled.err).size(), 1U) << compiled.err;
  EXPECT_TRUE(contains(foresightc({"inspect", database}).out, "no golden scan"));
  EXPECT_EQ(selftest_json(database, 1)["objects"][0]["verdict"], "no_golden_scan");
}

// What users see of its size.
TEST(SelftestProgram, golden_scans_are_small) {
  const Json json = Json::parse(foresightc({"inspect", two_objects(), "--json"}).out);
  for (const Json& object : json["objects"]) {
    EXPECT_GT(object["golden_scan_bytes"], 100);
    EXPECT_LT(object["golden_scan_bytes"], 20 * 1024);
  }
}

}  // namespace
}  // namespace foresight::test
