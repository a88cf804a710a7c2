#include "compiler/cad_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>

#include "common/errors.h"
#include "common/random.h"
#include "compiler/mesh_bodies.h"
#include "tests/solids.h"
#include "tests/support.h"

namespace foresight {
namespace {

using Eigen::Vector3d;
using ::testing::Test;

class CadFile : public Test {
 protected:
  std::string write(const std::string& name, const std::string& content) {
    std::ofstream(folder_.file(name), std::ios::binary) << content;
    return folder_.file(name);
  }
  std::string write(const std::string& name, const CadModel& model) {
    (name.ends_with("stl") || name.ends_with("STL")) ? test::write_stl(folder_.file(name), model)
                                                     : test::write_obj(folder_.file(name), model);
    return folder_.file(name);
  }
  test::TemporaryFolder folder_;
};

double volume(const CadModel& model) {
  TriangleMesh mesh{model.vertices, model.triangles};
  Bodies one{1, std::vector<int>(model.triangles.size(), 0), 0};
  return body_volumes(mesh, one).front();
}

// What the error says, or nothing when none was thrown.
std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    EXPECT_FALSE(error.mend().empty());
    return error.what();
  }
  return {};
}

std::string read_error(const std::string& file) {
  return error_of([&file] { (void)read_cad_model(file); });
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Two solids in one mesh.
CadModel together(CadModel a, const CadModel& b) {
  const int first = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

CadModel inside_out(CadModel model) {
  for (Triangle& t : model.triangles) std::swap(t[1], t[2]);
  return model;
}

CadModel at(CadModel model, const Vector3d& place) {
  return test::moved(std::move(model), {Eigen::Matrix3d::Identity(), place});
}

constexpr const char* kQuadBox =
    "8 6 12\n0 0 0\n40 0 0\n40 30 0\n0 30 0\n0 0 20\n40 0 20\n40 30 20\n0 30 20\n"
    "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

// ---- faces

TEST(PlanarFaces, of_a_box_are_its_six_sides) {
  const CadModel box = test::make_box(40, 30, 20);
  ASSERT_EQ(box.faces.size(), 6u);
  double area = 0.0;
  for (const CadFace& face : box.faces) {
    area += face.area;
    EXPECT_EQ(face.triangles.size(), 2u);
    EXPECT_NEAR(face.normal.norm(), 1.0, 1e-12);
    EXPECT_NEAR(face.normal.dot(face.centroid), face.offset, 1e-9);
    EXPECT_GT(face.normal.dot(face.centroid - Vector3d(20, 15, 10)), 0.0) << "outward";
  }
  EXPECT_NEAR(area, 2.0 * (40 * 30 + 40 * 20 + 30 * 20), 1e-9);
  EXPECT_LT((box.faces[1].centroid - Vector3d(20, 15, 20)).norm(), 1e-9);
}

TEST(PlanarFaces, partition_the_triangles_in_ascending_order) {
  const CadModel model = test::make_slotted_block();
  std::vector<int> seen(model.triangles.size(), 0);
  int last_first = -1;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    EXPECT_GT(model.faces[f].triangles.front(), last_first);
    last_first = model.faces[f].triangles.front();
    for (const int t : model.faces[f].triangles) {
      ++seen[static_cast<std::size_t>(t)];
      EXPECT_EQ(model.triangle_face[static_cast<std::size_t>(t)], static_cast<int>(f));
    }
  }
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
  EXPECT_EQ(model.faces.size(), 10u);
}

TEST(PlanarFaces, weighted_normals_close_up_over_a_solid) {
  for (const CadModel& model : {test::make_step(), test::make_prism(9, 20, 10), test::make_slotted_block()}) {
    Vector3d sum = Vector3d::Zero();
    for (const CadFace& face : model.faces) sum += face.area * face.normal;
    EXPECT_LT(sum.norm(), 1e-8);
  }
}

TEST(PlanarFaces, do_not_creep_around_a_fine_prism) {
  CadReadOptions options;  // 360 sides turn by 1 degree each; a chain of half degrees would swallow them all
  options.coplanar_angle = 0.02;
  CadModel prism = test::make_prism(360, 25, 10);
  find_planar_faces(prism, options);
  EXPECT_GT(prism.faces.size(), 100u);
}

TEST(PlanarFaces, do_not_depend_on_where_the_solid_is) {
  Random random(2);
  const CadModel model = test::make_step();
  const CadModel moved = test::moved(model, {random.rotation(), Vector3d(100, 200, -50)});
  EXPECT_EQ(moved.triangle_face, model.triangle_face);
}

TEST(PlanarFaces, do_not_depend_on_the_order_of_the_vertices) {
  CadModel model = test::make_slotted_block();
  CadModel shuffled = model;
  const int n = static_cast<int>(model.vertices.size());
  std::reverse(shuffled.vertices.begin(), shuffled.vertices.end());
  for (Triangle& t : shuffled.triangles) t = {n - 1 - t[0], n - 1 - t[1], n - 1 - t[2]};
  find_planar_faces(shuffled, {});
  EXPECT_EQ(shuffled.triangle_face, model.triangle_face);
}

TEST(PlanarFaces, that_are_coplanar_but_apart_stay_two) {
  EXPECT_EQ(test::make_extrusion({{0, 0}, {60, 0}, {60, 20}, {40, 20}, {40, 10}, {20, 10}, {20, 20}, {0, 20}}, 10)
                .faces.size(),
            10u);
}

TEST(PlanarFaces, take_in_needles) {
  CadModel box = test::make_box(40, 30, 20);
  // Split the top's diagonal by a vertex just off it: one half gets a needle along the diagonal.
  const Triangle top = box.triangles[2];
  const Vector3d middle =
      0.5 * (box.vertices[static_cast<std::size_t>(top[0])] + box.vertices[static_cast<std::size_t>(top[1])]);
  box.vertices.push_back(middle + Vector3d(0, 0, 1e-7));
  const int v = static_cast<int>(box.vertices.size()) - 1;
  box.triangles[2] = {top[0], v, top[2]};
  box.triangles.push_back({v, top[1], top[2]});
  box.triangles.push_back({top[0], top[1], v});
  find_planar_faces(box, {});
  EXPECT_EQ(box.faces.size(), 6u);
}

TEST(Triangulation, keeps_the_area_of_any_simple_polygon) {
  const std::vector<std::vector<Vector3d>> polygons = {
      {{0, 0, 1}, {4, 0, 1}, {4, 3, 1}},
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}},
      {{0, 0, 0}, {6, 0, 0}, {6, 5, 0}, {4, 5, 0}, {4, 1, 0}, {2, 1, 0}, {2, 5, 0}, {0, 5, 0}},
      {{0, 0, 0}, {5, 4, 0}, {0, 8, 0}, {1, 4, 0}}};
  const double areas[] = {6.0, 4.0, 22.0, 16.0};
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const std::vector<Triangle> triangles = triangulate(polygons[i]);
    EXPECT_EQ(triangles.size(), polygons[i].size() - 2);
    double area = 0.0;
    for (const Triangle& t : triangles) {
      const auto corner = [&](std::size_t k) { return polygons[i][static_cast<std::size_t>(t[k])]; };
      const double z = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).z();
      EXPECT_GE(z, 0.0);
      area += z;
    }
    EXPECT_NEAR(area, areas[i], 1e-12);
  }
}

// ---- sizes

TEST(CadModel, measures_its_box_and_diameter) {
  const CadModel box = test::make_box(40, 30, 20);
  EXPECT_EQ(box.lowest(), Vector3d(0, 0, 0));
  EXPECT_EQ(box.highest(), Vector3d(40, 30, 20));
  EXPECT_NEAR(box.diameter(), std::sqrt(40.0 * 40 + 30 * 30 + 20 * 20), 1e-12);
}

TEST(CadModel, diameter_is_that_of_the_longest_pair) {
  Random random(4);
  CadModel cloud;
  for (int i = 0; i < 200; ++i) cloud.vertices.push_back(random.uniform(0.0, 10.0) * random.direction());
  double longest = 0.0;
  for (const Vector3d& a : cloud.vertices) {
    for (const Vector3d& b : cloud.vertices) longest = std::max(longest, (a - b).norm());
  }
  EXPECT_EQ(cloud.diameter(), longest);
}

TEST(CheckSize, accepts_what_fits_the_field_of_view) {
  EXPECT_EQ(error_of([] { check_size(test::make_box(40, 30, 20), "part.stl", 1.0, 281.0); }), "");
}

TEST(CheckSize, proposes_the_unit_that_fits) {
  const CadModel tiny = test::make_box(0.1, 0.1, 0.08);
  const std::string text = error_of([&] { check_size(tiny, "part.stl", 1.0, 281.0); });
  EXPECT_TRUE(says(text,
                   "part.stl: the object is 0.16 mm in diameter, 0.058 % of the field of view (281 mm); "
                   "if the file is in metres, pass --unit m"))
      << text;
  EXPECT_TRUE(says(error_of([] { check_size(test::make_box(2, 1, 1), "a.obj", 1.0, 281.0); }), "--unit in"));
  EXPECT_TRUE(says(error_of([] { check_size(test::make_box(40e3, 30e3, 1e3), "a.obj", 1000.0, 281.0); }), "--unit mm"));
}

TEST(CheckSize, proposes_no_unit_when_none_fits) {
  const std::string text = error_of([] { check_size(test::make_box(3e5, 1, 1), "a.obj", 1e3, 2.0); });
  EXPECT_TRUE(says(text, "scale the object")) << text;
  EXPECT_FALSE(says(text, "--unit")) << text;
}

// ---- good files

TEST_F(CadFile, reads_the_same_solid_from_every_format) {
  const CadModel box = test::make_box(40, 30, 20);
  const std::string quads = kQuadBox;
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 6\nproperty list uchar int vertex_indices\nend_header\n" +
      quads.substr(7);
  for (const std::string& file :
       {write("box.obj", box), write("box.stl", box), write("box.STL", box), write("box.ply", ply),
        write("box.off", "OFF\n" + quads), write("box.OFF", "OFF\n# a comment\n" + quads)}) {
    const CadModel model = read_cad_model(file);
    EXPECT_EQ(model.name, "box");
    EXPECT_EQ(model.vertices.size(), 8u) << file;
    EXPECT_EQ(model.triangles.size(), 12u) << file;
    EXPECT_EQ(model.faces.size(), 6u) << file;
    EXPECT_NEAR(volume(model), 40.0 * 30 * 20, 1e-6) << file;
  }
}

TEST_F(CadFile, scales_by_its_unit) {
  CadReadOptions options;
  options.unit_mm = 25.4;
  const CadModel model = read_cad_model(write("inch.obj", test::make_box(2, 1, 1)), options);
  EXPECT_NEAR(model.highest().x(), 50.8, 1e-5);
  EXPECT_EQ(model.faces.size(), 6u);
}

TEST_F(CadFile, cuts_concave_polygons_into_triangles) {
  std::string text;
  const CadModel model = test::make_slotted_block();
  for (const Vector3d& v : model.vertices)
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
  text += "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 14 15 16\n";
  for (int i = 1; i <= 8; ++i) {
    const int j = i % 8 + 1;
    text += "f " + std::to_string(i) + " " + std::to_string(j) + " " + std::to_string(j + 8) + " " +
            std::to_string(i + 8) + "\n";
  }
  const CadModel read = read_cad_model(write("polygons.obj", text));
  EXPECT_EQ(read.faces.size(), 10u);
  EXPECT_NEAR(volume(read), volume(model), 1e-6);
}

// ---- repairs

TEST_F(CadFile, welds_what_stl_writes_a_hair_apart) {
  CadModel box = test::make_box(40, 30, 20);
  CadModel apart;
  Random random(9);
  for (const Triangle& t : box.triangles) {
    for (const int corner : t) {
      apart.vertices.push_back(box.vertices[static_cast<std::size_t>(corner)] + 1e-5 * random.direction());
    }
    const int n = static_cast<int>(apart.vertices.size());
    apart.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const CadModel model = read_cad_model(write("apart.stl", apart));
  EXPECT_EQ(model.vertices.size(), 8u);
  EXPECT_EQ(model.faces.size(), 6u);
  ASSERT_EQ(model.repairs.size(), 1u);
  EXPECT_TRUE(says(model.repairs[0], "welded 28")) << model.repairs[0];
}

TEST_F(CadFile, says_nothing_of_repairs_when_there_are_none) {
  EXPECT_TRUE(read_cad_model(write("good.obj", test::make_step())).repairs.empty());
}

TEST_F(CadFile, turns_a_solid_that_is_inside_out) {
  const CadModel model = read_cad_model(write("in.obj", inside_out(test::make_step())));
  EXPECT_NEAR(volume(model), volume(test::make_step()), 1e-6);
  ASSERT_EQ(model.repairs.size(), 1u);
  EXPECT_TRUE(says(model.repairs[0], "inside out"));
}

TEST_F(CadFile, turns_single_triangles_that_disagree) {
  CadModel box = test::make_step();
  std::swap(box.triangles[3][0], box.triangles[3][1]);
  std::swap(box.triangles[7][0], box.triangles[7][1]);
  const CadModel model = read_cad_model(write("two.obj", box));
  EXPECT_NEAR(volume(model), volume(test::make_step()), 1e-6);
  ASSERT_EQ(model.repairs.size(), 1u);
  EXPECT_TRUE(says(model.repairs[0], "turned 2 triangles")) << model.repairs[0];
}

TEST_F(CadFile, drops_degenerate_and_duplicate_triangles) {
  CadModel box = test::make_box(40, 30, 20);
  box.triangles.push_back({3, 3, 4});
  box.triangles.push_back(box.triangles[5]);
  const CadModel model = read_cad_model(write("more.obj", box));
  EXPECT_EQ(model.triangles.size(), 12u);
  EXPECT_GE(model.repairs.size(), 1u);
  EXPECT_TRUE(says(model.repairs.back(), "dropped 1 duplicate triangle"));
}

TEST_F(CadFile, keeps_one_side_of_a_mesh_listed_from_both_sides) {
  const CadModel box = test::make_box(40, 30, 20);
  CadModel both = box;
  for (const Triangle& t : box.triangles) both.triangles.push_back({t[0], t[2], t[1]});
  const CadModel model = read_cad_model(write("both.obj", both));
  EXPECT_EQ(model.triangles.size(), 12u);
  EXPECT_NEAR(volume(model), 40.0 * 30 * 20, 1e-6);
}

TEST_F(CadFile, takes_a_body_inside_another_for_a_void) {
  const CadModel hollow = together(test::make_box(40, 40, 40), at(test::make_box(10, 10, 10), {15, 15, 15}));
  const CadModel model = read_cad_model(write("hollow.obj", hollow));
  EXPECT_NEAR(volume(model), 64000.0 - 1000.0, 1e-6);
  ASSERT_EQ(model.repairs.size(), 1u);
  EXPECT_TRUE(says(model.repairs[0], "void"));
  const CadModel good = together(test::make_box(40, 40, 40), inside_out(at(test::make_box(10, 10, 10), {15, 15, 15})));
  EXPECT_TRUE(read_cad_model(write("good.obj", good)).repairs.empty());
}

TEST_F(CadFile, keeps_bodies_side_by_side_or_crossing_outward) {
  for (const Vector3d& place : {Vector3d(60, 0, 0), Vector3d(20, 5, 5)}) {
    const CadModel model =
        read_cad_model(write("two.obj", together(test::make_box(40, 30, 20), at(test::make_box(40, 10, 10), place))));
    EXPECT_NEAR(volume(model), 24000.0 + 4000.0, 1e-6);
    EXPECT_EQ(model.faces.size(), 12u);
  }
}

TEST_F(CadFile, keeps_bodies_apart_that_touch_along_an_edge) {
  const CadModel touching = together(test::make_box(40, 30, 20), at(test::make_box(10, 10, 20), {40, 30, 0}));
  EXPECT_EQ(read_cad_model(write("touching.obj", touching)).faces.size(), 12u);
}

// ---- bad files

TEST_F(CadFile, names_files_that_cannot_be_read) {
  EXPECT_TRUE(says(read_error(folder_.file("none.stl")), "no such file"));
  EXPECT_TRUE(says(read_error(folder_.path()), "folder"));
  EXPECT_TRUE(says(read_error(write("empty.obj", "")), "is empty"));
  EXPECT_TRUE(says(read_error(write("part.step", "ISO-10303-21;")), ".obj, .stl, .ply or .off"));
  EXPECT_TRUE(says(read_error(write("nothing.stl", "solid Empty\nendsolid Empty")), "no triangles"));
  EXPECT_TRUE(says(read_error(write("text.ply", "this is not a mesh")), "damaged"));
  EXPECT_TRUE(says(read_error(write("text.off", "this is not a mesh")), "damaged"));
  EXPECT_TRUE(says(read_error(write("text.obj", "this is not a mesh")), "no triangles"));
}

TEST_F(CadFile, ends_at_headers_that_promise_too_much) {
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list int int vertex_indices\nend_header\n";
  EXPECT_TRUE(says(read_error(write("list.ply", ply + std::string(12, '\0') + "\x7f\x7f\x7f\x7f")), "damaged"));
  EXPECT_TRUE(says(read_error(write("huge.off", "OFF\n2000000000 2000000000 0\n0 0 0\n")), "damaged"));
  EXPECT_TRUE(
      says(read_error(write("cut.off", std::string("OFF\n") + std::string(kQuadBox).substr(0, 100))), "damaged"));
}

TEST_F(CadFile, names_faces_without_vertices_and_numbers_that_are_none) {
  EXPECT_TRUE(says(read_error(write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")), "1 of its faces"));
  EXPECT_FALSE(read_error(write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")).empty());
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  std::string vertices(36, '\0');
  vertices[2] = vertices[3] = '\x7f';  // 0x7f7f0000 is large, 0x7fff0000 not a number
  vertices[2] = '\xff';
  EXPECT_TRUE(says(read_error(write("nan.ply", ply + vertices + std::string("\x03\x00\x01\x02", 4))),
                   "vertex 1 has a coordinate"));
}

TEST_F(CadFile, counts_and_places_open_edges) {
  CadModel box = test::make_box(40, 30, 20);
  box.triangles.pop_back();
  const std::string text = read_error(write("open.obj", box));
  EXPECT_TRUE(says(text, "3 open edges, the first at (0, 15, 10)")) << text;
  EXPECT_FALSE(says(text, "T-junction"));
}

TEST_F(CadFile, names_t_junctions) {
  CadModel box = test::make_box(40, 30, 20);
  // A vertex in the middle of an edge of the top that the side's triangle does not have.
  const Triangle top = box.triangles[2];
  box.vertices.push_back(
      0.5 * (box.vertices[static_cast<std::size_t>(top[1])] + box.vertices[static_cast<std::size_t>(top[2])]));
  const int v = static_cast<int>(box.vertices.size()) - 1;
  box.triangles[2] = {top[0], top[1], v};
  box.triangles.push_back({top[0], v, top[2]});
  EXPECT_TRUE(says(read_error(write("t.obj", box)), "T-junction"));
}

TEST_F(CadFile, names_edges_that_are_not_manifold) {
  const CadModel touching = together(test::make_box(40, 30, 20), at(test::make_box(10, 10, 20), {40, 30, 0}));
  EXPECT_TRUE(
      says(read_error(write("touching.stl", touching)), "1 edge is shared by more than two triangles (non-manifold)"));
}

TEST_F(CadFile, names_surfaces_without_volume_and_one_sided_ones) {
  EXPECT_TRUE(says(read_error(write("flat.obj", "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3 4\n")), "no volume"));
  EXPECT_TRUE(
      says(read_error(write("thin.obj", "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3 4\nf 4 3 2 1\n")), "no volume"));
  // The projective plane on six vertices: closed, but with one side only.
  const std::string plane =
      "v 0 0 0\nv 9 0 1\nv 3 9 2\nv 1 2 9\nv 7 7 5\nv 2 8 8\n"
      "f 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 6\nf 1 6 2\nf 2 3 5\nf 3 4 6\nf 4 5 2\nf 5 6 3\nf 6 2 4\n";
  EXPECT_TRUE(says(read_error(write("plane.obj", plane)), "one-sided"));
}

// ---- files as they come

TEST(RealCad, reads_good_files_and_names_the_faults_of_bad_ones) {
  const std::string folder = test::real_data_folder();
  if (folder.empty()) GTEST_SKIP() << "no real data";
  const std::string cad = folder + "/cad/";
  for (const char* name : {"7_8ths_cube.stl", "afd310.ply", "angle_block.STL", "backplate.ply", "box.STL",
                           "bracket2.ply", "featuretype.STL", "front.ply", "multibody.stl", "octagonal_pocket.stl",
                           "origin_inside.STL", "plate_holes.STL", "two_objects.obj"}) {
    EXPECT_EQ(read_error(cad + name), "");
  }
  EXPECT_TRUE(says(read_error(cad + "bracket1.ply"), "non-manifold"));
  EXPECT_TRUE(says(read_error(cad + "not_convex.obj"), "non-manifold"));
  EXPECT_TRUE(says(read_error(cad + "soup.stl"), "300 open edges"));
  EXPECT_TRUE(says(read_error(cad + "empty.stl"), "no triangles"));
}

TEST(RealCad, finds_the_faces_that_the_files_name) {
  const std::string folder = test::real_data_folder();
  if (folder.empty()) GTEST_SKIP() << "no real data";
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/abw/models")) {
    std::ifstream text(entry.path());
    std::size_t groups = 0;
    for (std::string line; std::getline(text, line);) groups += line.starts_with("g face_") ? 1 : 0;
    EXPECT_EQ(read_cad_model(entry.path().string()).faces.size(), groups) << entry.path();
  }
  for (const char* box : {"small_box", "medium_box"}) {
    EXPECT_EQ(read_cad_model(folder + "/boxes/models/" + box + ".obj").faces.size(), 6u);
  }
}

}  // namespace
}  // namespace foresight
