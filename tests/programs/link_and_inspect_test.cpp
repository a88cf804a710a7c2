// foresightc link and inspect: linking equals compiling together, and what is inside can be read.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/programs/workshop.h"

namespace foresight::test {
namespace {

std::string compile(const std::string& name, std::vector<std::string> arguments) {
  const std::string file = workshop().file(name);
  arguments.insert(arguments.begin(), "compile");
  arguments.insert(arguments.end(), {"-o", file, "--views", "20"});
  must_succeed(foresightc(arguments));
  return file;
}

const std::string& castle_alone() {
  static const std::string file = compile("castle.db", {castle()});
  return file;
}

std::string linked(const std::vector<std::string>& parts, const std::string& name) {
  std::vector<std::string> arguments = {"link", "-o", workshop().file(name)};
  arguments.insert(arguments.end(), parts.begin(), parts.end());
  const Outcome outcome = foresightc(arguments);
  expect_code(outcome, 0);
  EXPECT_EQ(outcome.out, "");
  return file_content(workshop().file(name));
}

TEST(LinkProgram, equals_compiling_together) {
  EXPECT_EQ(linked({castle_alone(), one_object()}, "linked.db"),
            file_content(compile("together.db", {castle(), stick()})));
  EXPECT_EQ(linked({one_object(), castle_alone()}, "turned.db"),
            file_content(compile("turned_together.db", {stick(), castle()})));
}

TEST(LinkProgram, of_one_database_is_that_database) {
  EXPECT_EQ(linked({one_object()}, "alone.db"), file_content(one_object()));
}

TEST(LinkProgram, of_linked_databases_is_linking_all) {
  const std::string block = compile("holed_cube.db", {project_file("models/holed_cube.off")});
  (void)linked({castle_alone(), one_object()}, "first_two.db");
  EXPECT_EQ(linked({workshop().file("first_two.db"), block}, "nested.db"),
            linked({castle_alone(), one_object(), block}, "flat.db"));
}

TEST(LinkProgram, may_write_over_one_of_its_parts) {
  const std::string part = workshop().file("part.db");
  std::filesystem::copy_file(one_object(), part);
  const std::string expected = linked({part, castle_alone()}, "elsewhere.db");
  EXPECT_EQ(linked({part, castle_alone()}, "part.db"), expected);
}

TEST(LinkProgram, refuses_what_does_not_fit_together) {
  const std::string scanner =
      compile("scanner.db", {castle(), "--sensor", project_file("models/sensors/scanner.textproto")});
  const std::string bins = compile("bins.db", {castle(), "--bins", "12"});
  const std::string output = workshop().file("refused.db");
  for (const auto& [part, words] :
       {std::pair(scanner, std::string("the sensor differs")), std::pair(bins, std::string("the density settings")),
        std::pair(one_object(), std::string("stick"))}) {
    expect_refused(foresightc({"link", one_object(), part, "-o", output}), 4, "foresightc", part, words);
    EXPECT_FALSE(std::filesystem::exists(output));
  }
}

TEST(InspectProgram, tells_in_words_what_is_inside) {
  const Outcome outcome = foresightc({"inspect", two_objects()});
  expect_code(outcome, 0);
  for (const std::string words : {"sensor paper: 240 x 256 cells", "object castle: 18 faces", "object stick: 13 faces",
                                  "24 bins", "80 views", "from stick.off", "3 exact and", "0 exact and"}) {
    EXPECT_TRUE(contains(outcome.out, words)) << words << "\n" << outcome.out;
  }
  EXPECT_TRUE(contains(outcome.out, std::to_string(std::filesystem::file_size(two_objects())) + " bytes"))
      << outcome.out;
}

TEST(InspectProgram, tells_as_json_what_is_inside) {
  const Outcome outcome = foresightc({"inspect", two_objects(), "--json"});
  expect_code(outcome, 0);
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["bytes"], std::filesystem::file_size(two_objects()));
  EXPECT_EQ(json["sensor"]["name"], "paper");
  EXPECT_EQ(json["sensor"]["camera"]["columns"], 256);
  EXPECT_EQ(json["density"]["bins"], 24);
  ASSERT_EQ(json["objects"].size(), 2U);
  EXPECT_EQ(json["objects"][0]["faces"].size(), 18U);
  EXPECT_EQ(json["objects"][1]["faces"].size(), 13U);
  EXPECT_EQ(json["objects"][0]["exact_symmetries"], 3);
  EXPECT_EQ(json["objects"][1]["exact_symmetries"], 0);
  for (const Json& object : json["objects"]) {
    EXPECT_GE(object["near_symmetries"], 0);
    EXPECT_EQ(object["views"], 80);
    EXPECT_GT(object["template_points"], 100);
    for (const Json& face : object["faces"]) {
      EXPECT_GT(face["area_mm2"], 0.0);
      EXPECT_LE(face["views_found"], object["views"]);
    }
  }
}

}  // namespace
}  // namespace foresight::test
