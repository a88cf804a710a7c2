#include "compiler/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/runtime/synthetic_database.h"

namespace foresight {
namespace {

nlohmann::json parsed(const CompiledDatabase& database, std::size_t bytes = 12345) {
  return nlohmann::json::parse(report_json(database, bytes));
}

TEST(ReportJson, lists_every_object_with_its_faces_in_order) {
  const CompiledDatabase database = test::synthetic_database();
  const nlohmann::json json = parsed(database);
  ASSERT_EQ(json["objects"].size(), database.models.size());
  for (std::size_t i = 0; i < database.models.size(); ++i) {
    const CompiledModel& model = database.models[i];
    const nlohmann::json& object = json["objects"][i];
    EXPECT_EQ(object["object"], model.name);
    EXPECT_EQ(object["cad_file"], model.cad_file);
    EXPECT_EQ(object["cad_sha256"], model.cad_sha256);
    EXPECT_EQ(object["cad_unit"], model.cad_unit);
    EXPECT_EQ(object["diameter_mm"], model.diameter);
    EXPECT_EQ(object["views"], model.views);
    EXPECT_EQ(object["face_pairs"], model.pairs.size());
    EXPECT_EQ(object["template_points"], model.surface.points.size());
    EXPECT_EQ(object["exact_symmetries"], 1);
    EXPECT_EQ(object["near_symmetries"], 1);
    EXPECT_EQ(object["golden_scan_bytes"], model.golden_scan->depths.size());
    ASSERT_EQ(object["faces"].size(), model.faces.size());
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      EXPECT_EQ(object["faces"][f]["area_mm2"], model.faces[f].area);
      EXPECT_EQ(object["faces"][f]["views_found"], model.faces[f].views_found);
      EXPECT_EQ(object["faces"][f]["normal"][1], model.faces[f].normal.y());
    }
  }
}

TEST(ReportJson, has_provenance_sensor_and_settings) {
  const CompiledDatabase database = test::synthetic_database();
  const nlohmann::json json = parsed(database, 777);
  EXPECT_EQ(json["bytes"], 777);
  EXPECT_EQ(json["tool_version"], database.tool_version);
  EXPECT_EQ(json["ray_isa"], database.ray_isa);
  EXPECT_EQ(json["sensor"]["name"], database.sensor.name);
  EXPECT_EQ(json["sensor"]["camera"]["fx"], database.sensor.camera.fx);
  EXPECT_EQ(json["sensor"]["projector_mm"][0], database.sensor.projector->x());
  EXPECT_EQ(json["sensor"]["background"], database.sensor.background);
  EXPECT_EQ(json["segmentation"]["seed_block"], database.segmentation.seed_block);
  EXPECT_EQ(json["density"]["bins"], database.density.bins);
}

TEST(ReportJson, names_no_projector_where_there_is_none) {
  CompiledDatabase database = test::synthetic_database();
  database.sensor.projector.reset();
  EXPECT_FALSE(parsed(database)["sensor"].contains("projector_mm"));
}

TEST(Report, tells_which_objects_have_no_golden_scan) {
  CompiledDatabase database = test::synthetic_database();
  database.models[1].golden_scan.reset();
  EXPECT_EQ(parsed(database)["objects"][1]["golden_scan_bytes"], 0);
  EXPECT_NE(report_text(database, 1).find("no golden scan, diameter"), std::string::npos);
}

TEST(ReportJson, escapes_names) {
  CompiledDatabase database = test::synthetic_database();
  database.models[0].name = "a \"quoted\"\nname\\";
  EXPECT_EQ(parsed(database)["objects"][0]["object"], database.models[0].name);
}

TEST(ReportText, names_every_object_and_the_sensor_a_line_each) {
  const CompiledDatabase database = test::synthetic_database();
  const std::string text = report_text(database, 12345);
  for (const CompiledModel& model : database.models) {
    EXPECT_NE(text.find("object " + model.name + ": 4 faces (3 found by extraction), 3 pairs"), std::string::npos)
        << text;
    EXPECT_NE(text.find("template points, 1 exact and 1 near symmetries, golden scan of 7 bytes, diameter"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find(model.cad_file), std::string::npos);
  }
  EXPECT_NE(text.find("sensor " + database.sensor.name), std::string::npos);
  EXPECT_NE(text.find("12345 bytes"), std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4 + 2);
  EXPECT_EQ(text.back(), '\n');
}

TEST(Report, of_an_empty_database_lists_nothing) {
  const CompiledDatabase empty;
  EXPECT_TRUE(parsed(empty)["objects"].empty());
  EXPECT_EQ(report_text(empty, 0).find("object "), std::string::npos);
}

}  // namespace
}  // namespace foresight
