#include "compiler/compile.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

#include "common/errors.h"
#include "compiler/database_writer.h"
#include "compiler/sensor_file.h"
#include "runtime/database.h"
#include "tests/solids.h"

namespace foresight {
namespace {

CompileOptions quick() {
  CompileOptions options;
  options.samples.views = 20;
  return options;
}

CompiledDatabase compiled(const std::vector<CadModel>& cads, const SensorModel& sensor = paper_sensor(),
                          const CompileOptions& options = quick()) {
  CompiledDatabase database = new_database(sensor, options);
  for (const CadModel& cad : cads) {
    database.models.push_back(compile_model(cad, sensor, options));
    database.models.back().cad_file = cad.name + ".off";
    database.models.back().cad_sha256 = std::string(64, '0');
  }
  return database;
}

const CompiledDatabase& step_database() {
  static const CompiledDatabase database = compiled({test::make_step()});
  return database;
}

// The same database with its object under another name.
CompiledDatabase step_named(const std::string& name) {
  CompiledDatabase database = step_database();
  database.models[0].name = name;
  return database;
}

TEST(CompileModel, gives_what_the_reader_accepts_and_returns_unchanged) {
  const std::string bytes = encode_database(step_database());
  const CompiledDatabase read = decode_database(bytes, "step.db");
  ASSERT_EQ(read.models.size(), 1U);
  EXPECT_EQ(read.models[0].name, "step");
  EXPECT_EQ(read.models[0].faces.size(), 8U);
  EXPECT_EQ(encode_database(read), bytes);
}

TEST(CompileModel, keeps_the_geometry_of_the_cad_model) {
  const CadModel cad = test::make_step();
  const CompiledModel& model = step_database().models[0];
  EXPECT_EQ(model.centre, Eigen::Vector3d(30.0, 20.0, 15.0));
  EXPECT_DOUBLE_EQ(model.diameter, cad.diameter());
  ASSERT_EQ(model.faces.size(), cad.faces.size());
  for (std::size_t i = 0; i < cad.faces.size(); ++i) {
    EXPECT_EQ(model.faces[i].normal, cad.faces[i].normal);
    EXPECT_EQ(model.faces[i].offset, cad.faces[i].offset);
    EXPECT_EQ(model.faces[i].centroid, cad.faces[i].centroid);
    EXPECT_EQ(model.faces[i].area, cad.faces[i].area);
  }
  EXPECT_EQ(model.vertices.size(), cad.vertices.size());
  EXPECT_EQ(model.triangles, cad.triangles);
}

TEST(CompileModel, lays_its_template_on_its_faces) {
  const CompiledModel& model = step_database().models[0];
  ASSERT_GT(model.surface.points.size(), 100U);
  for (const TemplatePoint& point : model.surface.points) {
    ASSERT_FALSE(point.faces.empty());
    for (const int face : point.faces) {
      const ModelFace& plane = model.faces[static_cast<std::size_t>(face)];
      EXPECT_NEAR(plane.normal.dot(point.position.cast<double>()), plane.offset, 0.11);
    }
  }
}

TEST(CompileModel, sees_every_side_of_a_convex_solid) {
  const CompiledModel model = compile_model(test::make_box(80, 60, 40), paper_sensor(), quick());
  EXPECT_EQ(model.views, 20);
  for (const ModelFace& face : model.faces) EXPECT_GT(face.views_found, 0);
  EXPECT_EQ(model.pairs.size(), 12U);  // the edges of a box: opposite sides are never seen together
}

TEST(CompileModel, keeps_statistics_of_so_many_faces) {
  CompileOptions options = quick();
  options.most_faces = 4;
  const CompiledModel model = compile_model(test::make_box(80, 60, 40), paper_sensor(), options);
  EXPECT_EQ(model.faces.size(), 6U);
  EXPECT_EQ(std::count_if(model.faces.begin(), model.faces.end(), [](const auto& face) { return face.views_found > 0; }),
            4);
}

TEST(CompileModel, tells_the_end_of_each_stage_and_stops_where_no_face_is_found) {
  std::vector<std::string> ended;
  const auto note = [&](const char* stage) { ended.emplace_back(stage); };
  (void)compile_model(test::make_step(), paper_sensor(), quick(), {}, note);
  EXPECT_EQ(ended, (std::vector<std::string>{"views", "statistics", "template", "symmetries", "acceptance", "golden scan"}));
  ended.clear();
  const CompiledModel small = compile_model(test::make_box(3, 3, 3), paper_sensor(), quick(), {}, note);
  EXPECT_EQ(ended, (std::vector<std::string>{"views", "statistics"}));
  EXPECT_TRUE(small.surface.points.empty());
}

TEST(CompileModel, depends_on_the_sensor_and_not_on_the_threads) {
  SensorModel noisy = paper_sensor();
  noisy.depth_noise = 0.3;
  std::vector<std::string> bytes;
  for (const std::size_t threads : {1U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    bytes.push_back(encode_database(compiled({test::make_step()}, noisy)));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_NE(bytes[0], encode_database(step_database()));
}

TEST(CompileModel, counts_its_views_for_progress) {
  std::atomic<int> most = 0;
  (void)compile_model(test::make_box(60, 60, 60), paper_sensor(), quick(), [&](int done) {
    int before = most;
    while (before < done && !most.compare_exchange_weak(before, done)) {
    }
  });
  EXPECT_EQ(most, 20);
}

TEST(NewDatabase, holds_what_the_runtime_must_extract_with) {
  SensorModel sensor = paper_sensor();
  sensor.depth_noise = 0.7;
  CompileOptions options;
  options.density.bins = 48;
  const CompiledDatabase database = new_database(sensor, options);
  EXPECT_TRUE(database.models.empty());
  EXPECT_EQ(database.sensor, sensor);
  EXPECT_EQ(database.segmentation, segmentation_options_for(sensor));
  EXPECT_EQ(database.density.bins, 48);
  EXPECT_FALSE(database.tool_version.empty());
  EXPECT_FALSE(database.ray_isa.empty());
}

TEST(LinkDatabases, equals_compiling_together) {
  const CadModel step = test::make_step();
  const CadModel box = test::make_box(80, 60, 40);
  const CompiledDatabase linked = link_databases({{"a.db", compiled({step})}, {"b.db", compiled({box})}});
  EXPECT_EQ(encode_database(linked), encode_database(compiled({step, box})));
}

TEST(LinkDatabases, keeps_the_order_given) {
  CompiledDatabase two = step_named("b");
  two.models.push_back(step_named("a").models[0]);
  const CompiledDatabase linked = link_databases({{"1", step_named("c")}, {"2", two}, {"3", step_named("0")}});
  ASSERT_EQ(linked.models.size(), 4U);
  for (const auto& [i, name] : {std::pair(0U, "c"), {1U, "b"}, {2U, "a"}, {3U, "0"}})
    EXPECT_EQ(linked.models[i].name, name);
}

TEST(LinkDatabases, of_one_database_is_that_database) {
  EXPECT_EQ(encode_database(link_databases({{"a.db", step_database()}})), encode_database(step_database()));
}

// The third part is changed and must be refused as incompatible, by its own name.
void expect_refused(const std::string& words, const std::function<void(CompiledDatabase&)>& change) {
  CompiledDatabase other = step_named("c");
  change(other);
  try {
    (void)link_databases({{"a.db", step_named("a")}, {"b.db", step_named("b")}, {"c.db", other}});
    FAIL() << "linked in spite of " << words;
  } catch (const DatabaseError& error) {
    EXPECT_EQ(error.fault(), DatabaseFault::incompatible);
    EXPECT_EQ(error.file(), "c.db");
    EXPECT_NE(error.cause().find(words), std::string::npos) << error.cause();
  }
}

TEST(LinkDatabases, refuses_other_sensors_and_settings_by_file) {
  expect_refused("sensor", [](auto& d) { d.sensor.camera.fx += 1.0; });
  expect_refused("sensor", [](auto& d) { d.sensor.projector = Eigen::Vector3d(100, 0, 0); });
  expect_refused("extraction", [](auto& d) { d.segmentation.smallest_region += 1; });
  expect_refused("density", [](auto& d) { d.density.bins = 48; });
  expect_refused("version", [](auto& d) { d.tool_version = "0.0.0"; });
  expect_refused("instruction set", [](auto& d) { d.ray_isa = "other"; });
}

TEST(LinkDatabases, refuses_two_objects_of_one_name) {
  expect_refused("named a", [](auto& d) { d.models[0].name = "a"; });
  expect_refused("named b", [](auto& d) { d.models[0].name = "b"; });
}

}  // namespace
}  // namespace foresight
