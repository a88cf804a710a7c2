#include "benchmarks/random_solids.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "compiler/mesh_bodies.h"
#include "compiler/solid_check.h"
#include "compiler/triangle_mesh.h"

namespace foresight {
namespace {

constexpr std::uint64_t kSeed = 5;
constexpr int kCount = 200;

std::vector<CadModel> some_solids() {
  std::vector<CadModel> solids;
  for (int i = 0; i < kCount; ++i) solids.push_back(random_solid(kSeed, i));
  return solids;
}

TEST(RandomSolids, are_closed_manifold_outward_and_of_one_body) {
  for (const CadModel& solid : some_solids()) {
    TriangleMesh mesh{solid.vertices, solid.triangles};
    EXPECT_TRUE(check_solid(solid.name, mesh).empty()) << solid.name << ": something had to be repaired";
    const auto bodies = orient_bodies(mesh);
    ASSERT_TRUE(bodies.has_value());
    EXPECT_EQ(bodies->count, 1) << solid.name;
    EXPECT_GT(body_volumes(mesh, *bodies).front(), 0.0) << solid.name;
  }
}

TEST(RandomSolids, have_the_size_of_the_objects_and_edges_that_show) {
  for (const CadModel& solid : some_solids()) {
    EXPECT_GE(solid.diameter(), kSmallestSolid) << solid.name;
    EXPECT_LE(solid.diameter(), kLargestSolid) << solid.name;
    for (const EdgeUse& use : edge_uses(solid.triangles)) {
      const auto length =
          (solid.vertices[static_cast<std::size_t>(use.high)] - solid.vertices[static_cast<std::size_t>(use.low)])
              .norm();
      EXPECT_GE(length, kSmallestSolidEdge) << solid.name;
    }
  }
}

TEST(RandomSolids, have_planar_faces_that_meet_at_visible_angles) {
  for (const CadModel& solid : some_solids()) {
    for (const CadFace& face : solid.faces) {
      for (const int triangle : face.triangles) {
        for (const int corner : solid.triangles[static_cast<std::size_t>(triangle)]) {
          EXPECT_NEAR(face.normal.dot(solid.vertices[static_cast<std::size_t>(corner)]), face.offset, 1e-6);
        }
      }
    }
    const std::vector<EdgeUse> uses = edge_uses(solid.triangles);
    for (std::size_t i = 0; i + 1 < uses.size(); i += 2) {
      const int a = solid.triangle_face[static_cast<std::size_t>(uses[i].triangle)];
      const int b = solid.triangle_face[static_cast<std::size_t>(uses[i + 1].triangle)];
      if (a == b) continue;
      const double cosine =
          solid.faces[static_cast<std::size_t>(a)].normal.dot(solid.faces[static_cast<std::size_t>(b)].normal);
      EXPECT_LT(cosine, 0.95) << solid.name;
    }
  }
}

TEST(RandomSolids, come_in_both_families_with_convex_and_other_shapes) {
  std::set<std::size_t> face_counts;
  int sheared_or_slanted = 0, boxy = 0, convex = 0;
  for (const CadModel& solid : some_solids()) {
    face_counts.insert(solid.faces.size());
    const bool straight = std::all_of(solid.faces.begin(), solid.faces.end(), [](const CadFace& face) {
      return face.normal.cwiseAbs().maxCoeff() > 1.0 - 1e-9;
    });
    ++(straight ? boxy : sheared_or_slanted);
    const bool one_sided = std::all_of(solid.faces.begin(), solid.faces.end(), [&](const CadFace& face) {
      return std::all_of(solid.vertices.begin(), solid.vertices.end(),
                         [&](const Eigen::Vector3d& v) { return face.normal.dot(v) <= face.offset + 1e-6; });
    });
    convex += one_sided ? 1 : 0;
  }
  EXPECT_GT(boxy, kCount / 8);
  EXPECT_GT(sheared_or_slanted, kCount / 2);
  EXPECT_GT(convex, kCount / 8);
  EXPECT_LT(convex, kCount / 2);
  EXPECT_GT(face_counts.size(), 8U);
}

TEST(RandomSolids, are_the_same_for_the_same_seed_and_index) {
  for (int i = 0; i < 20; ++i) {
    const CadModel one = random_solid(kSeed, i);
    const CadModel two = random_solid(kSeed, i);
    EXPECT_EQ(one.name, two.name);
    EXPECT_EQ(one.vertices, two.vertices);
    EXPECT_EQ(one.triangles, two.triangles);
  }
  EXPECT_EQ(random_solid(kSeed, 7).name, "solid_0007");
}

TEST(RandomSolids, differ_for_another_index_or_seed) {
  const std::vector<CadModel> solids = some_solids();
  std::set<std::pair<double, double>> seen;  // diameter and the largest face
  for (const CadModel& solid : solids) {
    double largest = 0.0;
    for (const CadFace& face : solid.faces) largest = std::max(largest, face.area);
    EXPECT_TRUE(seen.emplace(solid.diameter(), largest).second) << solid.name;
  }
  EXPECT_NE(random_solid(kSeed, 0).vertices, random_solid(kSeed + 1, 0).vertices);
}

}  // namespace
}  // namespace foresight
