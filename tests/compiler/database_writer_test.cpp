#include "compiler/database_writer.h"

#include <gtest/gtest.h>

#include "common/errors.h"
#include "runtime/database.h"
#include "schema/container.h"
#include "tests/runtime/synthetic_database.h"

namespace foresight {
namespace {

template <std::size_t count>
void expect_same(const std::array<Density, count>& a, const std::array<Density, count>& b) {
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_EQ(a[k].lower, b[k].lower);
    EXPECT_EQ(a[k].bin_width, b[k].bin_width);
    EXPECT_EQ(a[k].first_bin, b[k].first_bin);
    EXPECT_EQ(a[k].mass, b[k].mass);
  }
}

void expect_same(const SurfaceTemplate& a, const SurfaceTemplate& b) {
  EXPECT_EQ(a.spacing, b.spacing);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].position, b.points[i].position);
    EXPECT_EQ(a.points[i].normal, b.points[i].normal);
    EXPECT_EQ(a.points[i].faces, b.points[i].faces);
    EXPECT_EQ(a.points[i].neighbours, b.points[i].neighbours);
  }
  EXPECT_EQ(a.aspects, b.aspects);
}

void expect_same(const GoldenScan& a, const GoldenScan& b) {
  EXPECT_EQ(a.first_row, b.first_row);
  EXPECT_EQ(a.first_column, b.first_column);
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.columns, b.columns);
  EXPECT_EQ(a.depth_step, b.depth_step);
  EXPECT_EQ(a.depths, b.depths);
  EXPECT_EQ(a.T_sensor_model.rotation, b.T_sensor_model.rotation);
  EXPECT_EQ(a.T_sensor_model.translation, b.T_sensor_model.translation);
}

void expect_same(const CompiledModel& a, const CompiledModel& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.cad_file, b.cad_file);
  EXPECT_EQ(a.cad_sha256, b.cad_sha256);
  EXPECT_EQ(a.cad_unit, b.cad_unit);
  EXPECT_EQ(a.diameter, b.diameter);
  EXPECT_EQ(a.centre, b.centre);
  EXPECT_EQ(a.views, b.views);
  ASSERT_EQ(a.faces.size(), b.faces.size());
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    EXPECT_EQ(a.faces[i].normal, b.faces[i].normal);
    EXPECT_EQ(a.faces[i].offset, b.faces[i].offset);
    EXPECT_EQ(a.faces[i].centroid, b.faces[i].centroid);
    EXPECT_EQ(a.faces[i].area, b.faces[i].area);
    EXPECT_EQ(a.faces[i].views_found, b.faces[i].views_found);
    expect_same(a.faces[i].densities, b.faces[i].densities);
  }
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (std::size_t i = 0; i < a.pairs.size(); ++i) {
    EXPECT_EQ(a.pairs[i].first, b.pairs[i].first);
    EXPECT_EQ(a.pairs[i].second, b.pairs[i].second);
    EXPECT_EQ(a.pairs[i].views_found, b.pairs[i].views_found);
    expect_same(a.pairs[i].densities, b.pairs[i].densities);
  }
  expect_same(a.surface, b.surface);
  EXPECT_EQ(a.acceptance.weights, b.acceptance.weights);
  EXPECT_EQ(a.acceptance.bias, b.acceptance.bias);
  EXPECT_EQ(a.acceptance.least_quality, b.acceptance.least_quality);
  EXPECT_EQ(a.acceptance.least_probability, b.acceptance.least_probability);
  EXPECT_EQ(a.acceptance.samples, b.acceptance.samples);
  ASSERT_EQ(a.symmetries.size(), b.symmetries.size());
  for (std::size_t i = 0; i < a.symmetries.size(); ++i) {
    EXPECT_EQ(a.symmetries[i].T_model_model.rotation, b.symmetries[i].T_model_model.rotation);
    EXPECT_EQ(a.symmetries[i].T_model_model.translation, b.symmetries[i].T_model_model.translation);
    EXPECT_EQ(a.symmetries[i].exact, b.symmetries[i].exact);
    EXPECT_EQ(a.symmetries[i].overlap, b.symmetries[i].overlap);
  }
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.triangle_faces, b.triangle_faces);
  ASSERT_EQ(a.golden_scan.has_value(), b.golden_scan.has_value());
  if (a.golden_scan) expect_same(*a.golden_scan, *b.golden_scan);
}

TEST(DatabaseWriter, what_is_written_is_read_field_by_field) {
  const CompiledDatabase written = test::synthetic_database();
  const CompiledDatabase read = decode_database(encode_database(written), "x.db");
  EXPECT_EQ(read.tool_version, written.tool_version);
  EXPECT_EQ(read.ray_isa, written.ray_isa);
  EXPECT_EQ(read.sensor, written.sensor);
  EXPECT_EQ(read.segmentation, written.segmentation);
  EXPECT_EQ(read.density, written.density);
  ASSERT_EQ(read.models.size(), written.models.size());
  for (std::size_t i = 0; i < read.models.size(); ++i) expect_same(read.models[i], written.models[i]);
}

TEST(DatabaseWriter, a_sensor_without_projector_stays_without) {
  CompiledDatabase database = test::synthetic_database();
  database.sensor.projector.reset();
  EXPECT_FALSE(decode_database(encode_database(database), "x.db").sensor.projector);
}

TEST(DatabaseWriter, a_model_without_acceptance_model_stays_without) {
  CompiledDatabase database = test::synthetic_database();
  database.models[0].acceptance = {};
  const CompiledDatabase read = decode_database(encode_database(database), "x.db");
  EXPECT_EQ(read.models[0].acceptance.samples, 0);
  EXPECT_EQ(read.models[0].acceptance.weights, AcceptanceModel{}.weights);
  EXPECT_GT(read.models[1].acceptance.samples, 0);
}

TEST(DatabaseWriter, a_model_without_symmetries_stays_without) {
  CompiledDatabase database = test::synthetic_database();
  database.models[0].symmetries.clear();
  const CompiledDatabase read = decode_database(encode_database(database), "x.db");
  EXPECT_TRUE(read.models[0].symmetries.empty());
  EXPECT_FALSE(read.models[1].symmetries.empty());
}

TEST(DatabaseWriter, a_model_without_faces_of_triangles_stays_without) {
  CompiledDatabase database = test::synthetic_database();
  database.models[0].triangle_faces.clear();
  const CompiledDatabase read = decode_database(encode_database(database), "x.db");
  EXPECT_TRUE(read.models[0].triangle_faces.empty());
  EXPECT_EQ(read.models[1].triangle_faces, database.models[1].triangle_faces);
}

TEST(DatabaseWriter, a_model_without_golden_scan_stays_without) {
  CompiledDatabase database = test::synthetic_database();
  database.models[0].golden_scan.reset();
  const CompiledDatabase read = decode_database(encode_database(database), "x.db");
  EXPECT_FALSE(read.models[0].golden_scan);
  EXPECT_TRUE(read.models[1].golden_scan);
}

TEST(DatabaseWriter, same_content_gives_the_same_bytes) {
  const std::string bytes = encode_database(test::synthetic_database());
  EXPECT_EQ(encode_database(test::synthetic_database()), bytes);
  EXPECT_EQ(encode_database(decode_database(bytes, "x.db")), bytes);
}

TEST(DatabaseWriter, other_content_gives_other_bytes) {
  CompiledDatabase database = test::synthetic_database();
  database.models[1].surface.points[2].position.x() += 1e-4F;
  EXPECT_NE(encode_database(database), encode_database(test::synthetic_database()));
}

TEST(DatabaseWriter, writes_a_header_and_one_section_for_each_model) {
  const std::string bytes = encode_database(test::synthetic_database());
  const std::vector<SectionView> sections = decode_container(bytes, "x.db");
  ASSERT_EQ(sections.size(), 3U);
  EXPECT_EQ(sections[0].name, "header");
  EXPECT_EQ(sections[1].name, "model");
  EXPECT_EQ(sections[2].name, "model");
}

TEST(DatabaseWriter, refuses_names_that_are_not_utf8) {
  for (const std::string name :
       {"t\xFCrme", "\x80", "\xC3", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "a\xE2\x82"}) {
    CompiledDatabase database = test::synthetic_database();
    database.models[0].name = name;
    EXPECT_THROW((void)encode_database(database), InputError) << name;
    database.models[0].name = "castle";
    database.models[0].cad_file = name + ".obj";
    EXPECT_THROW((void)encode_database(database), InputError) << name;
  }
  for (const std::string name : {"\xE2\x82\xAC", "\xF0\x9F\x8F\xB0", "\xED\x9F\xBF", "caf\xC3\xA9"}) {
    CompiledDatabase database = test::synthetic_database();
    database.models[0].name = name;
    EXPECT_EQ(decode_database(encode_database(database), "x.db").models[0].name, name);
  }
}

}  // namespace
}  // namespace foresight
