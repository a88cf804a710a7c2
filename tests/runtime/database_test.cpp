#include "runtime/database.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>

#include "common/errors.h"
#include "compiler/database_writer.h"
#include "foresight/v1/database.pb.h"
#include "runtime/recognize.h"
#include "schema/container.h"
#include "tests/runtime/synthetic_database.h"
#include "tests/support.h"

namespace foresight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

// The error of decoding; fails the test when there is none.
DatabaseError error_of(const std::string& bytes) {
  try {
    (void)decode_database(bytes, "x.db");
  } catch (const DatabaseError& error) {
    return error;
  }
  ADD_FAILURE() << "the bytes were accepted";
  return {DatabaseFault::incompatible, "", "", ""};
}

// A database changed in one place is refused, and the message has the words.
void expect_inconsistent(const std::string& words, const std::function<void(CompiledDatabase&)>& change) {
  CompiledDatabase database = test::synthetic_database();
  change(database);
  const DatabaseError error = error_of(encode_database(database));
  EXPECT_EQ(error.fault(), DatabaseFault::inconsistent) << words;
  EXPECT_EQ(error.file(), "x.db");
  EXPECT_NE(error.cause().find(words), std::string::npos) << "expected: " << words << "\ngot: " << error.cause();
}

void expect_model_inconsistent(const std::string& words, const std::function<void(CompiledModel&)>& change) {
  expect_inconsistent("model 'castle': " + words, [&](CompiledDatabase& database) { change(database.models[0]); });
}

// Sections of the synthetic database after a change of the messages themselves.
std::string with_messages(const std::function<void(v1::Header&, v1::Model&)>& change) {
  const std::string bytes = encode_database(test::synthetic_database());
  const std::vector<SectionView> sections = decode_container(bytes, "x.db");
  v1::Header header;
  v1::Model model;
  EXPECT_TRUE(header.ParseFromString(std::string(sections[0].content)));
  EXPECT_TRUE(model.ParseFromString(std::string(sections[1].content)));
  change(header, model);
  return encode_container({{"header", header.SerializeAsString()},
                           {"model", model.SerializeAsString()},
                           {"model", std::string(sections[2].content)}});
}

TEST(DecodeDatabase, accepts_what_it_should) {
  EXPECT_EQ(decode_database(encode_database(test::synthetic_database()), "x.db").models.size(), 2U);
  EXPECT_EQ(decode_database(with_messages([](auto&, auto&) {}), "x.db").models.size(), 2U);
}

TEST(DecodeDatabase, refuses_foreign_and_damaged_files_by_their_fault) {
  EXPECT_EQ(error_of("").fault(), DatabaseFault::wrong_kind);
  EXPECT_EQ(error_of("v 0 0 0\n").fault(), DatabaseFault::wrong_kind);
  const std::string bytes = encode_database(test::synthetic_database());
  EXPECT_EQ(error_of(bytes.substr(0, bytes.size() - 1)).fault(), DatabaseFault::truncated);
  EXPECT_EQ(error_of(bytes + "x").fault(), DatabaseFault::corrupt);
}

TEST(DecodeDatabase, detects_a_flipped_bit_in_every_byte) {
  std::string bytes = encode_database(test::synthetic_database());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char mask = static_cast<char>(1 << (i % 8));
    bytes[i] ^= mask;
    EXPECT_THROW((void)decode_database(bytes, "x.db"), DatabaseError) << "byte " << i;
    bytes[i] ^= mask;
  }
}

TEST(DecodeDatabase, refuses_a_newer_schema_before_its_content) {
  const std::string bytes = with_messages([](v1::Header& header, v1::Model& model) {
    header.set_schema_version(kSchemaVersion + 1);
    header.clear_sensor();
    model.clear_faces();
  });
  EXPECT_EQ(error_of(bytes).fault(), DatabaseFault::newer_version);
  EXPECT_NE(error_of(bytes).cause().find(std::to_string(kSchemaVersion + 1)), std::string::npos);
}

TEST(DecodeDatabase, skips_sections_it_does_not_know) {
  const std::string bytes = encode_database(test::synthetic_database());
  std::vector<Section> sections;
  for (const SectionView& section : decode_container(bytes, "x.db"))
    sections.push_back({std::string(section.name), std::string(section.content)});
  sections.insert(sections.begin() + 1, {"notes", "of a later writer"});
  EXPECT_EQ(decode_database(encode_container(sections), "x.db").models.size(), 2U);
}

TEST(DecodeDatabase, refuses_sections_that_do_not_fit_together) {
  const auto expect_fault = [](const std::string& bytes, const std::string& words) {
    const DatabaseError error = error_of(bytes);
    EXPECT_EQ(error.fault(), DatabaseFault::inconsistent) << words;
    EXPECT_NE(error.cause().find(words), std::string::npos) << error.cause();
  };
  expect_fault(encode_container({}), "header");
  expect_fault(encode_container({{"header", "\xff\xff"}}), "header");
  expect_fault(encode_container({{"header", ""}}), "schema version");
  const std::string bytes = encode_database(test::synthetic_database());
  const std::vector<SectionView> sections = decode_container(bytes, "x.db");
  const std::string header(sections[0].content), model(sections[1].content);
  expect_fault(encode_container({{"model", model}, {"header", header}}), "header");
  expect_fault(encode_container({{"header", header}, {"model", model}}), "counts 2 models, the file has 1");
  expect_fault(encode_container({{"header", header}, {"model", model}, {"model", "\xff\xff"}}), "model 1");
  expect_fault(encode_container({{"header", header}, {"model", model}, {"model", model}}), "two models have this name");
}

TEST(DecodeDatabase, refuses_lists_that_do_not_fit_together) {
  using Change = std::function<void(v1::Model&)>;
  const std::vector<Change> changes = {
      [](v1::Model& m) { m.mutable_surface()->add_positions(1); },
      [](v1::Model& m) { m.mutable_surface()->add_normals(1); },
      [](v1::Model& m) { m.mutable_surface()->mutable_normals()->Truncate(9); },
      [](v1::Model& m) { m.mutable_surface()->add_face_counts(0); },
      [](v1::Model& m) { m.mutable_surface()->set_face_counts(0, 2); },
      [](v1::Model& m) { m.mutable_surface()->set_face_counts(0, 0xFFFFFFFF); },
      [](v1::Model& m) { m.mutable_surface()->add_faces(1); },
      [](v1::Model& m) { m.mutable_surface()->set_neighbour_counts(1, 0xFFFFFFFF); },
      [](v1::Model& m) { m.mutable_surface()->add_neighbours(1); },
      [](v1::Model& m) { m.mutable_surface()->add_aspect_counts(0); },
      [](v1::Model& m) { m.mutable_surface()->mutable_aspect_counts()->RemoveLast(); },
      [](v1::Model& m) { m.mutable_surface()->add_aspect_faces(1); },
      [](v1::Model& m) { m.clear_surface(); },
      [](v1::Model& m) { m.add_vertices(1); },
      [](v1::Model& m) { m.add_triangles(1); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const std::string bytes = with_messages([&](v1::Header&, v1::Model& model) { changes[i](model); });
    EXPECT_EQ(error_of(bytes).fault(), DatabaseFault::inconsistent) << "change " << i;
  }
}

TEST(DecodeDatabase, refuses_missing_parts) {
  using Change = std::function<void(v1::Header&, v1::Model&)>;
  const std::vector<Change> changes = {
      [](v1::Header& h, v1::Model&) { h.clear_sensor(); },
      [](v1::Header& h, v1::Model&) { h.clear_segmentation(); },
      [](v1::Header& h, v1::Model&) { h.clear_density(); },
      [](v1::Header& h, v1::Model&) { h.set_model_count(0); },
      [](v1::Header&, v1::Model& m) { m.clear_faces(); },
      [](v1::Header&, v1::Model& m) { m.mutable_faces(0)->clear_normal(); },
      [](v1::Header&, v1::Model& m) { m.mutable_faces(0)->clear_densities(); },
      [](v1::Header&, v1::Model& m) { m.mutable_faces(0)->mutable_densities()->clear_max_diameter(); },
      [](v1::Header&, v1::Model& m) { m.mutable_pairs(0)->clear_densities(); },
      [](v1::Header&, v1::Model& m) { m.mutable_faces(0)->set_views_found(0xFFFFFFFF); },
      [](v1::Header&, v1::Model& m) { m.mutable_faces(0)->set_views_found(0); },
      [](v1::Header&, v1::Model& m) { m.set_views(0x80000000); },
      [](v1::Header&, v1::Model& m) { m.set_triangles(0, 0xFFFFFFFF); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const std::string bytes = with_messages([&](v1::Header& header, v1::Model& model) { changes[i](header, model); });
    EXPECT_EQ(error_of(bytes).fault(), DatabaseFault::inconsistent) << "change " << i;
  }
}

TEST(DecodeDatabase, refuses_settings_outside_their_limits) {
  expect_inconsistent("settings", [](CompiledDatabase& d) { d.sensor.camera.rows = 5; });
  expect_inconsistent("settings", [](CompiledDatabase& d) { d.sensor.depth_noise = kNan; });
  expect_inconsistent("settings", [](CompiledDatabase& d) { d.segmentation.plane_sigma = -1; });
  expect_inconsistent("settings", [](CompiledDatabase& d) { d.density.bins = 0; });
  expect_inconsistent("no model", [](CompiledDatabase& d) { d.models.clear(); });
}

TEST(DecodeDatabase, refuses_bad_descriptions) {
  expect_inconsistent("model 0: the name is empty", [](CompiledDatabase& d) { d.models[0].name = ""; });
  expect_inconsistent("model 1: the name", [](CompiledDatabase& d) { d.models[1].name = "a\nb"; });
  expect_inconsistent("model 1: the name", [](CompiledDatabase& d) { d.models[1].name = std::string(2000, 'x'); });
  expect_inconsistent("model 'castle': two models", [](CompiledDatabase& d) { d.models[1].name = "castle"; });
  expect_model_inconsistent("cad_sha256", [](CompiledModel& m) { m.cad_sha256 = "abc"; });
  expect_model_inconsistent("cad_sha256", [](CompiledModel& m) { m.cad_sha256[3] = 'g'; });
  expect_model_inconsistent("cad_unit", [](CompiledModel& m) { m.cad_unit = "ft"; });
  expect_model_inconsistent("the diameter", [](CompiledModel& m) { m.diameter = 0; });
  expect_model_inconsistent("the diameter", [](CompiledModel& m) { m.diameter = kNan; });
  expect_model_inconsistent("the centre", [](CompiledModel& m) { m.centre.y() = kInfinity; });
  expect_model_inconsistent("it has no sample views", [](CompiledModel& m) { m.views = 0; });
}

TEST(DecodeDatabase, refuses_bad_faces) {
  expect_model_inconsistent("it has no faces", [](CompiledModel& m) { m.faces.clear(); });
  expect_model_inconsistent("face 1: the normal", [](CompiledModel& m) { m.faces[1].normal *= 1.01; });
  expect_model_inconsistent("face 1: the normal", [](CompiledModel& m) { m.faces[1].normal.x() = kNan; });
  expect_model_inconsistent("face 3: the offset", [](CompiledModel& m) { m.faces[3].offset = kInfinity; });
  expect_model_inconsistent("face 3: the centroid", [](CompiledModel& m) { m.faces[3].centroid.z() = kNan; });
  expect_model_inconsistent("face 0: the area", [](CompiledModel& m) { m.faces[0].area = -1; });
  expect_model_inconsistent("face 0: the area", [](CompiledModel& m) { m.faces[0].area = kNan; });
  expect_model_inconsistent("face 0: views_found", [](CompiledModel& m) { m.faces[0].views_found = 321; });
  expect_model_inconsistent("face 0: views_found", [](CompiledModel& m) { m.faces[0].views_found = -1; });
  expect_model_inconsistent("face 1: its bins differ", [](CompiledModel& m) { m.faces[1].densities[2].lower += 1; });
  expect_model_inconsistent("face 3: its bins differ",
                            [](CompiledModel& m) { m.faces[3].densities[0].bin_width *= 2; });
}

TEST(DecodeDatabase, refuses_bad_densities) {
  const auto expect_bad = [](const std::string& words, const std::function<void(Density&)>& change) {
    expect_model_inconsistent("face 1: the density of max_diameter " + words,
                              [&](CompiledModel& m) { change(m.faces[1].densities[kMaxDiameter]); });
    expect_model_inconsistent("pair 2: the density of relative_orientation " + words,
                              [&](CompiledModel& m) { change(m.pairs[2].densities[kOrientation]); });
  };
  expect_bad("is empty", [](Density& d) { d.mass.clear(); });
  expect_bad("does not sum to 1", [](Density& d) { d.mass[1] += 0.002F; });
  expect_bad("does not sum to 1", [](Density& d) { d.mass[1] -= 0.002F; });
  expect_bad("has a probability", [](Density& d) { d.mass = {1.1F, -0.1F}; });
  expect_bad("has a probability", [](Density& d) { d.mass[0] = kNanF; });
  expect_bad("has a lower edge", [](Density& d) { d.lower = kNan; });
  expect_bad("has a bin width", [](Density& d) { d.bin_width = 0; });
  expect_bad("has a bin width", [](Density& d) { d.bin_width = kInfinity; });
  expect_bad("has bins outside", [](Density& d) { d.first_bin = std::numeric_limits<int>::max(); });
  expect_bad("has bins outside", [](Density& d) { d.first_bin = std::numeric_limits<int>::min(); });
  expect_bad("has bins outside", [](Density& d) { d.mass.resize(500, 0.0F); });
}

TEST(DecodeDatabase, refuses_bad_pairs) {
  expect_model_inconsistent("pair 2: it names a face", [](CompiledModel& m) { m.pairs[2].second = 4; });
  expect_model_inconsistent("pair 0: it names a face", [](CompiledModel& m) { m.pairs[0].first = -1; });
  expect_model_inconsistent("pair 0: first is not less", [](CompiledModel& m) { m.pairs[0].first = 1; });
  expect_model_inconsistent("pair 1: pairs are not in", [](CompiledModel& m) { m.pairs[1] = m.pairs[0]; });
  expect_model_inconsistent("pair 1: pairs are not in", [](CompiledModel& m) { std::swap(m.pairs[0], m.pairs[1]); });
  expect_model_inconsistent("pair 1: views_found", [](CompiledModel& m) { m.pairs[1].views_found = 0; });
  expect_model_inconsistent("pair 1: views_found", [](CompiledModel& m) { m.pairs[1].views_found = 61; });
  expect_model_inconsistent("pair 1: views_found", [](CompiledModel& m) { m.pairs[1].second = 2; });
}

TEST(DecodeDatabase, refuses_bad_templates) {
  expect_model_inconsistent("the spacing", [](CompiledModel& m) { m.surface.spacing = 0; });
  expect_model_inconsistent("the spacing", [](CompiledModel& m) { m.surface.spacing = kNan; });
  expect_model_inconsistent("the template has no points", [](CompiledModel& m) { m.surface.points.clear(); });
  const auto expect_bad = [](const std::string& words, const std::function<void(TemplatePoint&)>& change) {
    expect_model_inconsistent("template point 1: " + words, [&](CompiledModel& m) { change(m.surface.points[1]); });
  };
  expect_bad("the position", [](TemplatePoint& p) { p.position.x() = kNanF; });
  expect_bad("the position", [](TemplatePoint& p) { p.position.x() = 1e30F; });
  expect_bad("the normal", [](TemplatePoint& p) { p.normal *= 1.001F; });
  expect_bad("the normal", [](TemplatePoint& p) { p.normal.setZero(); });
  expect_bad("faces", [](TemplatePoint& p) { p.faces.clear(); });
  expect_bad("faces", [](TemplatePoint& p) { p.faces = {1, 4}; });
  expect_bad("faces", [](TemplatePoint& p) { p.faces = {-1}; });
  expect_bad("faces", [](TemplatePoint& p) { p.faces = {2, 1}; });
  expect_bad("faces", [](TemplatePoint& p) { p.faces = {2, 2}; });
  expect_bad("neighbours", [](TemplatePoint& p) { p.neighbours = {0, 4}; });
  expect_bad("neighbours", [](TemplatePoint& p) { p.neighbours = {2, 0}; });
  expect_bad("it is its own", [](TemplatePoint& p) { p.neighbours = {0, 1}; });
  expect_model_inconsistent("aspect 7: ", [](CompiledModel& m) { m.surface.aspects[7] = {0, 4}; });
  expect_model_inconsistent("aspect 79: ", [](CompiledModel& m) { m.surface.aspects[79] = {1, 0}; });
}

TEST(DecodeDatabase, refuses_bad_meshes) {
  expect_model_inconsistent("it has no triangles", [](CompiledModel& m) { m.triangles.clear(); });
  expect_model_inconsistent("it has no triangles", [](CompiledModel& m) { m.vertices.clear(); });
  expect_model_inconsistent("vertex 2: ", [](CompiledModel& m) { m.vertices[2].y() = kNanF; });
  expect_model_inconsistent("triangle 3: ", [](CompiledModel& m) { m.triangles[3][1] = 4; });
  expect_model_inconsistent("triangle 3: ", [](CompiledModel& m) { m.triangles[3][1] = -1; });
}

TEST(DecodeDatabase, refuses_bad_faces_of_triangles) {
  expect_model_inconsistent("not every triangle has a face", [](CompiledModel& m) { m.triangle_faces.pop_back(); });
  expect_model_inconsistent("not every triangle has a face", [](CompiledModel& m) { m.triangle_faces.push_back(0); });
  expect_model_inconsistent("triangle 2: ", [](CompiledModel& m) { m.triangle_faces[2] = 4; });
  expect_model_inconsistent("triangle 0: ", [](CompiledModel& m) { m.triangle_faces[0] = -1; });
  const std::string bytes = with_messages([](v1::Header&, v1::Model& m) { m.set_triangle_faces(1, 0xFFFFFFFF); });
  EXPECT_EQ(error_of(bytes).fault(), DatabaseFault::inconsistent);
}

TEST(DecodeDatabase, takes_databases_of_compilers_that_knew_no_faces_of_triangles) {
  const std::string bytes = with_messages([](v1::Header&, v1::Model& m) { m.clear_triangle_faces(); });
  const CompiledDatabase read = decode_database(bytes, "x.db");
  EXPECT_TRUE(read.models[0].triangle_faces.empty());
  EXPECT_FALSE(read.models[1].triangle_faces.empty());
}

TEST(DecodeDatabase, refuses_bad_acceptance_models) {
  const auto expect_bad = [](const std::string& words, const std::function<void(AcceptanceModel&)>& change) {
    expect_model_inconsistent(words, [&](CompiledModel& m) { change(m.acceptance); });
  };
  for (const double value : {kNan, kInfinity, -kInfinity}) {
    for (std::size_t k = 0; k < kEvidenceFeatureCount; ++k) {
      expect_bad("a weight of the acceptance model", [&](AcceptanceModel& a) { a.weights[k] = value; });
    }
    expect_bad("a weight of the acceptance model", [&](AcceptanceModel& a) { a.bias = value; });
    expect_bad("what the acceptance model asks of a start", [&](AcceptanceModel& a) { a.least_quality = value; });
    expect_bad("what the acceptance model asks of a start", [&](AcceptanceModel& a) { a.least_probability = value; });
  }
  expect_bad("what the acceptance model asks of a start", [](AcceptanceModel& a) { a.least_quality = -0.01; });
  expect_bad("what the acceptance model asks of a start", [](AcceptanceModel& a) { a.least_quality = 1.01; });
  expect_bad("what the acceptance model asks of a start", [](AcceptanceModel& a) { a.least_probability = -0.01; });
  expect_bad("what the acceptance model asks of a start", [](AcceptanceModel& a) { a.least_probability = 1.01; });
  const std::string bytes =
      with_messages([](v1::Header&, v1::Model& m) { m.mutable_acceptance()->set_samples(0xFFFFFFFF); });
  EXPECT_EQ(error_of(bytes).fault(), DatabaseFault::inconsistent);
}

TEST(DecodeDatabase, refuses_bad_symmetries) {
  const auto expect_bad = [](const std::string& words, const std::function<void(Symmetry&)>& change) {
    expect_model_inconsistent("symmetry 1: " + words, [&](CompiledModel& m) { change(m.symmetries[1]); });
  };
  for (const double value : {kNan, kInfinity, -kInfinity}) {
    expect_bad("it has no proper rotation", [&](Symmetry& s) { s.T_model_model.rotation(1, 2) = value; });
    expect_bad("the translation", [&](Symmetry& s) { s.T_model_model.translation.y() = value; });
    expect_bad("the overlap", [&](Symmetry& s) { s.overlap = value; });
  }
  expect_bad("it has no proper rotation", [](Symmetry& s) { s.T_model_model.rotation *= 1.001; });
  expect_bad("it has no proper rotation", [](Symmetry& s) { s.T_model_model.rotation.col(0) *= -1.0; });  // a mirror
  expect_bad("it has no proper rotation", [](Symmetry& s) { s.T_model_model.rotation.setZero(); });
  expect_bad("the translation", [](Symmetry& s) { s.T_model_model.translation.x() = 1e7; });
  expect_bad("the overlap", [](Symmetry& s) { s.overlap = -0.01; });
  expect_bad("the overlap", [](Symmetry& s) { s.overlap = 1.01; });
}

TEST(DecodeDatabase, refuses_too_many_symmetries_and_any_out_of_order) {
  expect_model_inconsistent("it has more than 512 exact symmetries",
                            [](CompiledModel& m) { m.symmetries.insert(m.symmetries.begin(), 512, m.symmetries[0]); });
  expect_model_inconsistent("it has more than 32 near symmetries",
                            [](CompiledModel& m) { m.symmetries.insert(m.symmetries.end(), 32, m.symmetries[1]); });
  expect_model_inconsistent("the exact symmetries do not come first",
                            [](CompiledModel& m) { std::swap(m.symmetries[0], m.symmetries[1]); });
}

TEST(DecodeDatabase, refuses_rotations_of_symmetries_that_are_not_3_by_3) {
  for (const int numbers : {0, 8, 10}) {
    const std::string bytes = with_messages(
        [&](v1::Header&, v1::Model& m) { m.mutable_symmetries(0)->mutable_rotation()->Resize(numbers, 0.0); });
    EXPECT_EQ(error_of(bytes).fault(), DatabaseFault::inconsistent) << numbers;
    EXPECT_NE(error_of(bytes).cause().find("nine"), std::string::npos);
  }
}

TEST(DecodeDatabase, takes_databases_of_compilers_that_knew_no_symmetries) {
  const std::string bytes = with_messages([](v1::Header&, v1::Model& m) { m.clear_symmetries(); });
  EXPECT_TRUE(decode_database(bytes, "x.db").models[0].symmetries.empty());
}

TEST(DecodeDatabase, refuses_bad_golden_scans) {
  const auto expect_bad = [](const std::string& words, const std::function<void(GoldenScan&)>& change) {
    expect_model_inconsistent(words, [&](CompiledModel& m) { change(*m.golden_scan); });
  };
  for (const double value : {kNan, kInfinity, -kInfinity}) {
    expect_bad("the golden scan has no proper rotation",
               [&](GoldenScan& g) { g.T_sensor_model.rotation(0, 1) = value; });
    expect_bad("the translation of the golden scan", [&](GoldenScan& g) { g.T_sensor_model.translation.z() = value; });
    expect_bad("the golden scan cannot be used: its depth step", [&](GoldenScan& g) { g.depth_step = value; });
  }
  expect_bad("the golden scan has no proper rotation", [](GoldenScan& g) { g.T_sensor_model.rotation *= -1.0; });
  expect_bad("the golden scan cannot be used: its depth step", [](GoldenScan& g) { g.depth_step = 0.0; });
  const std::string window = "the golden scan cannot be used: its window";
  expect_bad(window, [](GoldenScan& g) { g.first_row = 127; });  // of 128 rows
  expect_bad(window, [](GoldenScan& g) { g.first_column = 254; });
  expect_bad(window, [](GoldenScan& g) { g.rows = 0; });
  expect_bad(window, [](GoldenScan& g) { g.columns = -1; });
  expect_bad("the golden scan cannot be used: its runs", [](GoldenScan& g) { g.columns = 2; });
  expect_bad("the golden scan cannot be used: its depths end early", [](GoldenScan& g) { g.rows = 3; });
  expect_bad("the golden scan cannot be used: its depths end early", [](GoldenScan& g) { g.depths.clear(); });
  expect_bad("the golden scan cannot be used: bytes follow", [](GoldenScan& g) { g.depths += 'x'; });
  expect_bad("the golden scan cannot be used: it has a depth", [](GoldenScan& g) { g.depths[3] = '\x67'; });  // -11
  expect_bad("the golden scan cannot be used: its depths are in an unknown code",
             [](GoldenScan& g) { g.depths[0] = 16; });
}

TEST(DecodeDatabase, refuses_rotations_of_golden_scans_that_are_not_3_by_3) {
  for (const int numbers : {0, 8, 10}) {
    const std::string bytes = with_messages(
        [&](v1::Header&, v1::Model& m) { m.mutable_golden_scan()->mutable_rotation()->Resize(numbers, 0.0); });
    EXPECT_EQ(error_of(bytes).fault(), DatabaseFault::inconsistent) << numbers;
    EXPECT_NE(error_of(bytes).cause().find("nine"), std::string::npos);
  }
}

TEST(DecodeDatabase, takes_databases_of_compilers_that_knew_no_golden_scans) {
  const std::string bytes = with_messages([](v1::Header&, v1::Model& m) { m.clear_golden_scan(); });
  EXPECT_FALSE(decode_database(bytes, "x.db").models[0].golden_scan);
}

// Of the second model, something the two-way method needs is taken away.
void expect_refused_by_two_way_only(const std::function<void(CompiledModel&)>& take_away) {
  RecognizeOptions paper;
  paper.method = Method::paper;
  CompiledDatabase content = test::synthetic_database();
  take_away(content.models[1]);
  const Database old(std::move(content));
  EXPECT_NO_THROW(check_method(paper, old, "x.db"));
  try {
    check_method({}, old, "x.db");
    ADD_FAILURE() << "the database was accepted";
  } catch (const DatabaseError& error) {
    EXPECT_EQ(error.fault(), DatabaseFault::incompatible);
    EXPECT_EQ(error.file(), "x.db");
    EXPECT_NE(error.cause().find(old.models()[1].name), std::string::npos) << error.cause();
    EXPECT_NE(error.mend().find("--method paper"), std::string::npos) << error.mend();
  }
}

TEST(CheckMethod, accepts_a_database_that_holds_all) {
  EXPECT_NO_THROW(check_method({}, Database(test::synthetic_database()), "x.db"));
}

TEST(CheckMethod, two_way_needs_an_acceptance_model_of_every_object) {
  expect_refused_by_two_way_only([](CompiledModel& m) { m.acceptance = {}; });
}

TEST(CheckMethod, two_way_needs_the_faces_of_every_objects_triangles) {
  expect_refused_by_two_way_only([](CompiledModel& m) { m.triangle_faces.clear(); });
}

TEST(DecodeSensor, knows_a_sensor_from_other_bytes) {
  v1::SensorModel message;
  message.set_name("s");
  EXPECT_EQ(decode_sensor(message.SerializeAsString())->name, "s");
  EXPECT_FALSE(decode_sensor("\xff\xff"));
}

TEST(Database, leaves_out_faces_that_were_never_found) {
  const Database database(test::synthetic_database());
  ASSERT_EQ(database.faces().size(), 6U);
  for (int i = 0; i < 6; ++i) EXPECT_GT(database.face(i).views_found, 0);
  EXPECT_EQ(database.faces()[2].face, 3);
  EXPECT_EQ(database.faces()[3].model, 1);
  EXPECT_EQ(&database.face(5), &database.models()[1].faces[3]);
}

TEST(Database, priors_sum_to_what_the_background_leaves) {
  const Database database(test::synthetic_database());
  for (const double background : {0.0, 0.3, 0.9}) {
    double sum = 0;
    for (int i = 0; i < static_cast<int>(database.faces().size()); ++i) sum += database.prior(i, background);
    EXPECT_NEAR(sum, 1.0 - background, 1e-12);
  }
  EXPECT_NEAR(database.prior(1, 0.3) / database.prior(0, 0.3), 70.0 / 60.0, 1e-12);
}

// Attributes that fall into stored bins of the face.
AttributeVector typical(const ModelFace& face) {
  AttributeVector attributes{};
  for (std::size_t k = 0; k < attributes.size(); ++k) {
    const Density& density = face.densities[k];
    attributes[k] = density.lower + density.bin_width * (density.first_bin + 1.5);
  }
  return attributes;
}

TEST(Database, does_not_depend_on_the_order_of_linking) {
  const Database database(test::synthetic_database());
  CompiledDatabase reversed = test::synthetic_database();
  std::reverse(reversed.models.begin(), reversed.models.end());
  const Database other(std::move(reversed));
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 3) % 6;  // the same face there
    ASSERT_EQ(database.face(i).centroid, other.face(j).centroid);
    EXPECT_EQ(database.prior(i, 0.3), other.prior(j, 0.3));
    const AttributeVector attributes = typical(database.face(i));
    EXPECT_GT(database.likelihood(i, attributes), 0.0);
    EXPECT_EQ(database.likelihood(i, attributes), other.likelihood(j, attributes));
  }
}

TEST(Database, likelihood_of_one_model_is_the_product_of_masses) {
  CompiledDatabase content = test::synthetic_database();
  content.models.resize(1);
  const Database database(std::move(content));
  AttributeVector attributes = typical(database.face(0));
  EXPECT_NEAR(database.likelihood(0, attributes), 0.5 * 0.5 * 0.5 * 0.5, 1e-9);
  for (double& attribute : attributes) {
    const double kept = attribute;
    for (const double value : {-1e9, 1e9, kNan}) {
      attribute = value;
      EXPECT_EQ(database.likelihood(0, attributes), 0.0);
    }
    attribute = kept;
  }
}

// The same density over the same millimetres, stored in bins half as wide by one model as by another.
TEST(Database, likelihood_compares_bins_of_different_width) {
  CompiledDatabase content = test::synthetic_database();
  for (std::size_t m = 0; m < 2; ++m)
    for (ModelFace& face : content.models[m].faces)
      for (Density& density : face.densities)
        if (face.views_found > 0) {
          density = Density{0.0, m == 0 ? 2.0 : 1.0, 0, {}};
          density.mass.assign(m == 0 ? 10 : 20, m == 0 ? 0.1F : 0.05F);
        }
  const Database database(std::move(content));
  const AttributeVector attributes = {3.3, 7.7, 0.1, 19.9};
  EXPECT_NEAR(database.likelihood(0, attributes), 1e-4, 1e-10);
  EXPECT_NEAR(database.likelihood(3, attributes), 1e-4, 1e-10);
}

TEST(Database, likelihood_never_exceeds_one) {
  CompiledDatabase content = test::synthetic_database();
  for (ModelFace& face : content.models[0].faces)
    for (Density& density : face.densities)
      if (face.views_found > 0) density.mass = {1.0F};  // one bin, and the other model's is 2.5 times as wide
  const Database database(std::move(content));
  AttributeVector attributes = typical(database.face(0));
  for (std::size_t k = 0; k < attributes.size(); ++k) attributes[k] -= database.face(0).densities[k].bin_width;
  EXPECT_EQ(database.likelihood(0, attributes), 1.0);
}

TEST(Database, pairs_are_found_in_either_order) {
  const Database database(test::synthetic_database());
  for (int m = 0; m < 2; ++m) {
    const CompiledModel& model = database.models()[static_cast<std::size_t>(m)];
    int found = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const FacePair* pair = database.pair(m, a, b);
        EXPECT_EQ(pair, database.pair(m, b, a));
        if (pair == nullptr) continue;
        ++found;
        EXPECT_EQ(pair->first, std::min(a, b));
        EXPECT_EQ(pair->second, std::max(a, b));
        EXPECT_GE(pair, model.pairs.data());
        EXPECT_LT(pair, model.pairs.data() + model.pairs.size());
      }
    EXPECT_EQ(found, 6);
  }
}

TEST(Database, survives_a_move_with_its_pairs) {
  Database first(test::synthetic_database());
  const Database second = std::move(first);
  ASSERT_NE(second.pair(1, 3, 0), nullptr);
  EXPECT_EQ(second.pair(1, 3, 0), &second.models()[1].pairs[1]);
}

TEST(Database, of_faces_never_found_has_none) {
  CompiledDatabase content = test::synthetic_database();
  content.models.resize(1);
  content.models[0].pairs.clear();
  for (ModelFace& face : content.models[0].faces) {
    face.views_found = 0;
    face.densities = {};
  }
  const Database database(decode_database(encode_database(content), "x.db"));
  EXPECT_TRUE(database.faces().empty());
  EXPECT_EQ(database.pair(0, 0, 1), nullptr);
}

TEST(LoadDatabase, reads_a_file_and_names_it_in_errors) {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("x.db");
  EXPECT_THROW((void)load_database(file), InputError);
  std::ofstream(file, std::ios::binary) << encode_database(test::synthetic_database());
  EXPECT_EQ(load_database(file).models().size(), 2U);
  std::ofstream(file, std::ios::binary) << "text";
  try {
    (void)load_database(file);
    FAIL();
  } catch (const DatabaseError& error) {
    EXPECT_EQ(error.file(), file);
    EXPECT_EQ(error.fault(), DatabaseFault::wrong_kind);
  }
}

}  // namespace
}  // namespace foresight
