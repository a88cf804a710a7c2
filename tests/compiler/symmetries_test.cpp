#include "compiler/symmetries.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/random.h"
#include "tests/benchmarks/solids.h"
#include "tests/support.h"

namespace foresight {
namespace {

std::size_t count_of(const std::string& name) {
  return find_symmetries(read_cad_model(test::project_file("models/" + name + ".off"))).size();
}

TEST(Symmetries, of_a_cube_are_its_24_rotations) { EXPECT_EQ(find_symmetries(test::cuboid(50, 50, 50)).size(), 24U); }

TEST(Symmetries, of_a_square_bar_are_eight) { EXPECT_EQ(find_symmetries(test::cuboid(50, 50, 80)).size(), 8U); }

TEST(Symmetries, of_a_box_are_four) { EXPECT_EQ(find_symmetries(test::cuboid(40, 50, 80)).size(), 4U); }

TEST(Symmetries, of_the_near_twins_differ) {
  EXPECT_EQ(count_of("holed_cube"), 8U);
  EXPECT_EQ(count_of("castle"), 4U);
}

TEST(Symmetries, of_the_other_objects_are_the_identity_alone) {
  for (const char* name : {"stapler", "stick", "note_dispenser", "pencil_box", "rolodex", "tape_dispenser"}) {
    EXPECT_EQ(count_of(name), 1U) << name;
  }
}

TEST(Symmetries, begin_with_the_identity_and_take_the_vertices_to_themselves) {
  const CadModel model = test::cuboid(30, 30, 70);
  const std::vector<Pose> symmetries = find_symmetries(model);
  EXPECT_LT(rotation_angle(symmetries.front().rotation), 1e-6);
  for (const Pose& symmetry : symmetries) {
    EXPECT_TRUE(is_rotation(symmetry.rotation));
    for (const Eigen::Vector3d& vertex : model.vertices) {
      EXPECT_TRUE(std::any_of(model.vertices.begin(), model.vertices.end(),
                              [&](const Eigen::Vector3d& other) { return (symmetry * vertex - other).norm() < 1e-6; }));
    }
  }
}

TEST(Symmetries, do_not_depend_on_where_the_origin_is) {
  CadModel model = test::cuboid(50, 50, 50);
  for (Eigen::Vector3d& vertex : model.vertices) vertex += Eigen::Vector3d(120, -40, 7);
  find_planar_faces(model, {});
  const std::vector<Pose> symmetries = find_symmetries(model);
  ASSERT_EQ(symmetries.size(), 24U);
  for (const Pose& symmetry : symmetries) {
    EXPECT_LT((symmetry * Eigen::Vector3d(120, -40, 7) - Eigen::Vector3d(120, -40, 7)).norm(), 1e-9);
  }
}

TEST(Symmetries, ignore_vertices_that_only_the_triangulation_has) {
  CadModel model = test::cuboid(50, 50, 50);
  const auto extra = static_cast<int>(model.vertices.size());  // the top gets a vertex off its middle
  model.vertices.emplace_back(11, 5, 25);
  std::erase_if(model.triangles, [](const std::array<int, 3>& t) {
    return std::all_of(t.begin(), t.end(), [](int v) { return v >= 4; });
  });
  for (const std::array<int, 2>& side : {std::array{4, 5}, std::array{5, 7}, std::array{7, 6}, std::array{6, 4}}) {
    model.triangles.push_back({side[0], side[1], extra});
  }
  find_planar_faces(model, {});
  EXPECT_EQ(find_symmetries(model).size(), 24U);
}

TEST(Symmetries, end_where_a_side_is_longer_by_more_than_the_tolerance) {
  EXPECT_EQ(find_symmetries(test::cuboid(50, 50, 50.05)).size(), 24U);
  EXPECT_EQ(find_symmetries(test::cuboid(50, 50, 51)).size(), 8U);
}

// Products of any two are among them, the identity is the first.
void expect_group(const std::vector<Pose>& group, double tolerance) {
  EXPECT_EQ(group.front().rotation, Eigen::Matrix3d::Identity());
  EXPECT_EQ(group.front().translation, Eigen::Vector3d::Zero());
  for (const Pose& a : group) {
    for (const Pose& b : group) {
      const Pose product = a * b;
      EXPECT_TRUE(std::any_of(group.begin(), group.end(), [&](const Pose& pose) {
        return (pose.rotation - product.rotation).cwiseAbs().maxCoeff() < tolerance &&
               (pose.translation - product.translation).cwiseAbs().maxCoeff() < 100.0 * tolerance;
      }));
    }
  }
}

TEST(SymmetryGroup, is_closed) {
  expect_group(symmetry_group(test::cuboid(50, 50, 50), 512), 1e-12);
  expect_group(symmetry_group(read_cad_model(test::project_file("models/castle.off")), 512), 1e-12);
  EXPECT_EQ(symmetry_group(test::cuboid(50, 50, 50), 512).size(), 24U);
}

TEST(SymmetryGroup, is_closed_to_rounding_where_the_mesh_is_not_exact) {
  CadModel model = test::cuboid(50, 50, 50);
  Random random(8);
  for (Eigen::Vector3d& vertex : model.vertices) vertex += 1e-4 * random.direction() + Eigen::Vector3d(7, 3, 1);
  find_planar_faces(model, {});
  const std::vector<Pose> group = symmetry_group(model, 512);
  EXPECT_EQ(group.size(), 24U);
  expect_group(group, 1e-11);
}

TEST(SymmetryGroup, drops_what_tolerances_leave_without_its_products) {
  // Each side is within the tolerance of the next, the first not of the last.
  const CadModel model = test::cuboid(50, 50.16, 50.32);
  const std::vector<Pose> group = symmetry_group(model, 512);
  EXPECT_LT(group.size(), 24U);
  EXPECT_GE(group.size(), 4U);
  expect_group(group, 1e-9);
}

TEST(SymmetryGroup, is_the_identity_where_there_are_more_than_asked_for) {
  EXPECT_EQ(symmetry_group(test::cuboid(50, 50, 50), 24).size(), 24U);
  EXPECT_EQ(symmetry_group(test::cuboid(50, 50, 50), 23).size(), 1U);
}

}  // namespace
}  // namespace foresight
