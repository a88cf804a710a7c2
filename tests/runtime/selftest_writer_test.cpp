#include "runtime/selftest_writer.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

namespace foresight {
namespace {

using Json = nlohmann::ordered_json;

std::vector<ObjectSelftest> one_of_each() {
  return {{"a", SelftestVerdict::right, 0.1, std::numbers::pi, 0.95, 12.5},
          {"b", SelftestVerdict::ambiguous, 0.2, 0.0, 0.7, 1.0},
          {"c", SelftestVerdict::wrong, 30.0, 0.0, 0.6, 1.0},
          {"d", SelftestVerdict::not_found, 0.0, 0.0, 0.0, 3.0},
          {"e", SelftestVerdict::no_golden_scan, 0.0, 0.0, 0.0, 0.0}};
}

std::vector<std::string> keys_of(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

TEST(SelftestJson, has_its_keys_in_the_documented_order) {
  const std::string text = selftest_json("x.fdb", "0.1.0", one_of_each());
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const Json json = Json::parse(text);
  EXPECT_EQ(keys_of(json), (std::vector<std::string>{"database", "passed", "objects", "right", "failed", "not_tested",
                                                     "version", "compiler_version"}));
  ASSERT_EQ(json["objects"].size(), 5U);
  for (const Json& object : json["objects"])
    EXPECT_EQ(keys_of(object), (std::vector<std::string>{"object", "verdict", "position_error_mm", "angle_error_deg",
                                                         "score", "milliseconds"}));
}

TEST(SelftestJson, tells_what_each_object_came_to) {
  const Json json = Json::parse(selftest_json("x.fdb", "0.0.9", one_of_each()));
  EXPECT_EQ(json["database"], "x.fdb");
  EXPECT_EQ(json["compiler_version"], "0.0.9");
  EXPECT_EQ(json["passed"], false);
  EXPECT_EQ(json["right"], 2);
  EXPECT_EQ(json["failed"], 2);
  EXPECT_EQ(json["not_tested"], 1);
  const Json& objects = json["objects"];
  const std::vector<std::string> verdicts = {"right", "ambiguous", "wrong", "not_found", "no_golden_scan"};
  for (std::size_t i = 0; i < verdicts.size(); ++i) EXPECT_EQ(objects[i]["verdict"], verdicts[i]);
  EXPECT_DOUBLE_EQ(objects[0]["angle_error_deg"].get<double>(), 180.0);
  EXPECT_EQ(objects[0]["position_error_mm"], 0.1);
  EXPECT_EQ(objects[2]["score"], 0.6);
  for (const char* key : {"position_error_mm", "angle_error_deg", "score"})
    for (const std::size_t i : {3U, 4U}) EXPECT_TRUE(objects[i][key].is_null()) << key;
  EXPECT_EQ(objects[3]["milliseconds"], 3.0);
  EXPECT_TRUE(objects[4]["milliseconds"].is_null());
}

TEST(SelftestJson, passes_when_none_fails_and_one_was_tested) {
  const auto passed = [](std::vector<ObjectSelftest> results) {
    return Json::parse(selftest_json("\xff", "", results))["passed"].get<bool>();
  };
  const std::vector<ObjectSelftest> all = one_of_each();
  EXPECT_TRUE(passed({all[0], all[1]}));
  EXPECT_TRUE(passed({all[1], all[4]}));
  EXPECT_FALSE(passed({all[4]}));
  EXPECT_FALSE(passed({all[0], all[2]}));
  EXPECT_FALSE(passed({all[0], all[3]}));
}

TEST(SelftestText, tells_failures_from_what_was_not_tested) {
  const std::vector<ObjectSelftest> all = one_of_each();
  EXPECT_EQ(selftest_line(all[0]), "a: right, 0.100 mm and 180.000 degrees off, score 0.950, 12.5 ms\n");
  for (const std::size_t i : {2U, 3U}) EXPECT_NE(selftest_line(all[i]).find("FAILED"), std::string::npos);
  for (const std::size_t i : {0U, 1U, 4U}) EXPECT_EQ(selftest_line(all[i]).find("FAILED"), std::string::npos);
  EXPECT_EQ(selftest_line(all[4]), "e: not tested, no golden scan in the database\n");
  EXPECT_TRUE(selftest_summary(count_verdicts(all), "0.1.0").starts_with("FAILED: 2 right, 2 failed, 1 not tested;"));
  EXPECT_TRUE(selftest_summary(count_verdicts({all[0]}), "0.1.0").starts_with("passed: 1 right"));
  EXPECT_TRUE(selftest_summary(count_verdicts({all[4]}), "0.1.0").starts_with("nothing to test: 0 right"));
}

}  // namespace
}  // namespace foresight
