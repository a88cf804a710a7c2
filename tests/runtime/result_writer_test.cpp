#include "runtime/result_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "common/random.h"

namespace foresight {
namespace {

using Json = nlohmann::ordered_json;

Alternative turned(const char* object, Random& random) {
  Alternative alternative{object, {}, random.uniform()};
  for (double& entry : alternative.T_sensor_model) entry = random.gaussian() * 1000.0;
  return alternative;
}

RecognitionResult sample() {
  Random random(7);
  RecognitionResult result;
  for (const char* name : {"castle", "tee"}) {
    Detection detection;
    detection.object = name;
    for (double& entry : detection.T_sensor_model) entry = random.gaussian() * 1000.0;
    detection.score = random.uniform();
    detection.matched = 1.0 / 3.0;
    detection.coherent = 0.1;
    detection.occluding = 5e-324;
    detection.rank = 2;
    detection.faces = {3, 7, 8};
    detection.regions = {2, 5, 6};
    for (double& number : detection.quaternion) number = random.gaussian();
    for (double& number : detection.covariance) number = random.gaussian() * 1e-7;
    for (double& number : detection.box_centre) number = random.gaussian();
    for (double& number : detection.box_size) number = random.uniform();
    if (result.detections.empty()) detection.ambiguous_with = {turned("castle", random), turned("holed_cube", random)};
    result.detections.push_back(detection);
  }
  result.statistics = {5, 902, 123, 48, 408, 2, 131, 57};
  result.milliseconds = {4.0, 0.4, 0.3, 2.2, 0.1, 7.25};
  return result;
}

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> result;
  for (const auto& [key, value] : json.items()) result.push_back(key);
  return result;
}

TEST(ResultJson, has_the_documented_keys_in_order) {
  const std::string line = result_json("x.pcd", sample(), 1.5);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const Json json = Json::parse(line);
  using Keys = std::vector<std::string>;
  EXPECT_EQ(keys(json), (Keys{"scan", "complete", "detections", "statistics", "milliseconds"}));
  for (const Json& detection : json["detections"]) {
    EXPECT_EQ(keys(detection), (Keys{"object", "pose", "score", "alpha", "beta", "gamma", "rank", "faces", "regions",
                                     "ambiguous_with", "quaternion", "covariance", "box"}));
    EXPECT_EQ(keys(detection["box"]), (Keys{"centre", "size"}));
  }
  EXPECT_EQ(keys(json["detections"][0]["ambiguous_with"][0]), (Keys{"object", "pose", "score"}));
  EXPECT_EQ(keys(json["statistics"]), (Keys{"regions", "possible_matches", "threshold_matches", "active_matches",
                                            "hypotheses", "verifications", "energy_evaluations", "pose_checks"}));
  EXPECT_EQ(keys(json["milliseconds"]),
            (Keys{"read", "extract", "field", "hypotheses", "localize", "verify", "total"}));
  EXPECT_EQ(json["milliseconds"]["total"], 8.75);  // reading included
  EXPECT_EQ(json["statistics"]["possible_matches"], 902);
  EXPECT_EQ(json["statistics"]["pose_checks"], 57);
  EXPECT_EQ(json["detections"][1]["object"], "tee");
  EXPECT_EQ(json["detections"][1]["faces"], (std::vector<int>{3, 7, 8}));
}

TEST(ResultJson, lists_what_else_a_view_fits_and_an_empty_list_for_nothing) {
  const RecognitionResult result = sample();
  const Json json = Json::parse(result_json("x", result, 0.0));
  const Json& others = json["detections"][0]["ambiguous_with"];
  ASSERT_EQ(others.size(), 2U);
  EXPECT_EQ(others[0]["object"], "castle");
  EXPECT_EQ(others[1]["object"], "holed_cube");
  for (std::size_t i = 0; i < 2; ++i) {
    const Alternative& wrote = result.detections[0].ambiguous_with[i];
    EXPECT_EQ(others[i]["score"].get<double>(), wrote.score);
    for (std::size_t j = 0; j < 16; ++j)
      EXPECT_EQ(others[i]["pose"][j / 4][j % 4].get<double>(), wrote.T_sensor_model[j]);
  }
  EXPECT_EQ(json["detections"][1]["ambiguous_with"], Json::array());
}

TEST(ResultJson, keeps_every_bit_of_every_number) {
  const RecognitionResult result = sample();
  const Json json = Json::parse(result_json("x", result, 0.0));
  for (std::size_t i = 0; i < 2; ++i) {
    const Detection& wrote = result.detections[i];
    const Json& read = json["detections"][i];
    for (std::size_t j = 0; j < 16; ++j) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(read["pose"][j / 4][j % 4].get<double>()),
                std::bit_cast<std::uint64_t>(wrote.T_sensor_model[j]));
    }
    EXPECT_EQ(read["score"].get<double>(), wrote.score);
    EXPECT_EQ(read["alpha"].get<double>(), wrote.matched);
    EXPECT_EQ(read["beta"].get<double>(), wrote.coherent);
    EXPECT_EQ(read["gamma"].get<double>(), wrote.occluding);
    EXPECT_EQ((read["quaternion"].get<std::array<double, 4>>()), wrote.quaternion);
    ASSERT_EQ(read["covariance"].size(), 6U);
    for (std::size_t j = 0; j < 36; ++j) {
      ASSERT_EQ(read["covariance"][j / 6].size(), 6U);
      EXPECT_EQ(read["covariance"][j / 6][j % 6].get<double>(), wrote.covariance[j]);
    }
    EXPECT_EQ((read["box"]["centre"].get<std::array<double, 3>>()), wrote.box_centre);
    EXPECT_EQ((read["box"]["size"].get<std::array<double, 3>>()), wrote.box_size);
  }
}

TEST(ResultJson, stays_json_for_any_file_name) {
  const std::string line = result_json("a\xFF\xC3(\"\\\n\x01.pcd", RecognitionResult{}, 0.0);
  const Json json = Json::parse(line, nullptr, false);
  ASSERT_FALSE(json.is_discarded());
  EXPECT_EQ(json["scan"], "a\uFFFD\uFFFD(\"\\\n\x01.pcd");
  EXPECT_EQ(json["detections"], Json::array());
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST(ResultJson, says_when_the_search_is_incomplete) {
  RecognitionResult result;
  EXPECT_EQ(Json::parse(result_json("x", result, 0.0))["complete"], true);
  result.complete = false;
  EXPECT_EQ(Json::parse(result_json("x", result, 0.0))["complete"], false);
  EXPECT_NE(result_text("x", result, 0.0).find("incomplete"), std::string::npos);
}

TEST(ResultText, names_every_object_and_hides_control_characters) {
  RecognitionResult result = sample();
  result.detections[0].object = "cas\x1B[2Jtle\n";
  const std::string text = result_text("scan\n1.pcd", result, 1.5);
  EXPECT_NE(text.find("scan?1.pcd: 2 recognized\n"), std::string::npos);
  EXPECT_NE(text.find("cas?[2Jtle?"), std::string::npos);
  EXPECT_NE(text.find("tee"), std::string::npos);
  EXPECT_NE(text.find("408 hypotheses"), std::string::npos);
  EXPECT_NE(text.find("8.8 ms"), std::string::npos);
  EXPECT_NE(result_text("x", RecognitionResult{}, 0.0).find("nothing recognized"), std::string::npos);
}

TEST(ResultText, has_a_line_for_each_alternative) {
  RecognitionResult result = sample();
  const auto lines = [&] {
    const std::string text = result_text("x", result, 0.0);
    return std::count(text.begin(), text.end(), '\n');
  };
  result.detections[0].ambiguous_with[1].object = "holed\ncube";
  EXPECT_NE(result_text("x", result, 0.0).find("ambiguous with castle  score 0."), std::string::npos);
  EXPECT_NE(result_text("x", result, 0.0).find("ambiguous with holed?cube  score 0."), std::string::npos);
  const auto with_both = lines();
  result.detections[0].ambiguous_with.clear();
  EXPECT_EQ(lines(), with_both - 2);
  EXPECT_EQ(result_text("x", result, 0.0).find("ambiguous"), std::string::npos);
}

TEST(BopCsv, does_not_speak_of_alternatives) {
  RecognitionResult result = sample();
  const std::string rows = bop_csv_rows("x", result, {"castle", "tee"}, 0.0);
  result.detections[0].ambiguous_with.clear();
  EXPECT_EQ(bop_csv_rows("x", result, {"castle", "tee"}, 0.0), rows);
}

TEST(BopCsv, has_seven_columns_and_rows_that_read_back) {
  const RecognitionResult result = sample();
  EXPECT_EQ(bop_csv_header(), "scene_id,im_id,obj_id,score,R,t,time\n");
  const std::string rows = bop_csv_rows("test/000048/depth/000012.png", result, {"other", "tee", "castle"}, 2.75);
  EXPECT_TRUE(rows.starts_with("48,12,3,"));
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 2);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), ','), 12);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), ' '), 2 * (8 + 2));
  const std::string second = rows.substr(rows.find('\n') + 1);
  EXPECT_TRUE(second.starts_with("48,12,2,"));
  EXPECT_TRUE(second.ends_with(",0.01\n"));
  // Row-major rotation first, then the last column, to the bit.
  std::size_t at = second.find(',', 8) + 1;
  const std::array<double, 16>& T = result.detections[1].T_sensor_model;
  for (const std::size_t i : {0, 1, 2, 4, 5, 6, 8, 9, 10, 3, 7, 11}) {
    EXPECT_EQ(std::stod(second.substr(at)), T[i]);
    at = second.find_first_of(" ,", at) + 1;
  }
}

TEST(BopCsv, takes_numbers_from_the_names_of_bops_objects) {
  RecognitionResult result;
  result.detections.resize(1);
  const auto id = [&](const std::string& object, const std::vector<std::string>& names) {
    result.detections[0].object = object;
    const std::string row = bop_csv_rows("x", result, names, 0.0);
    return row.substr(4, row.find(',', 4) - 4);
  };
  EXPECT_EQ(id("obj_000005", {"obj_000030", "obj_000005"}), "5");
  EXPECT_EQ(id("obj_000030", {"obj_000030", "obj_000005"}), "30");
  // One rule for all objects of a database: else two could get the same number.
  EXPECT_EQ(id("obj_000002", {"castle", "tee", "obj_000002"}), "3");
  EXPECT_EQ(id("obj_2", {"obj_2", "obj_000002"}), "1");
  EXPECT_EQ(id("obj_-7", {"obj_-7"}), "1");
  EXPECT_EQ(id("obj_", {"obj_"}), "1");
  EXPECT_EQ(id("obj_7b", {"obj_7b"}), "1");
  EXPECT_EQ(id("obj_99999999999999999999", {"obj_99999999999999999999"}), "1");
  EXPECT_EQ(id("other", {"obj_000030"}), "0");
}

TEST(BopCsv, takes_numbers_from_file_and_folder_names) {
  RecognitionResult result;
  result.detections.resize(1);
  const auto numbers = [&](const std::string& scan) {
    const std::string row = bop_csv_rows(scan, result, {}, 0.0);
    return row.substr(0, row.find(',', row.find(',') + 1));
  };
  EXPECT_EQ(numbers("scene_3/view12_007.pcd"), "3,7");
  EXPECT_EQ(numbers("a/b/scan.mp4"), "0,0");
  EXPECT_EQ(numbers("pallet_1.png"), "0,1");
  EXPECT_EQ(numbers("000002//5"), "2,5");
  EXPECT_EQ(numbers("/x/99999999999999999999999.png"), "0,0");
  EXPECT_EQ(bop_csv_rows("x", RecognitionResult{}, {}, 0.0), "");
}

}  // namespace
}  // namespace foresight
