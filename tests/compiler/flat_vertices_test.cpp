#include "compiler/flat_vertices.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "compiler/mesh_bodies.h"
#include "compiler/triangle_mesh.h"
#include "tests/compiler/solids.h"

namespace foresight {
namespace {

const CadReadOptions kRead;

// Every triangle cut into four at the middles of its edges, so many times.
CadModel finely_cut(CadModel model, int times) {
  for (int i = 0; i < times; ++i) {
    const std::vector<EdgeUse> uses = edge_uses(model.triangles);
    std::vector<std::array<int, 3>> middles(model.triangles.size());
    for (const EdgeUse& use : uses) {
      if (&use != uses.data() && (&use)[-1].low == use.low && (&use)[-1].high == use.high) continue;
      const int middle = static_cast<int>(model.vertices.size());
      const auto place = [&](int v) { return model.vertices[static_cast<std::size_t>(v)]; };
      const Eigen::Vector3d half = 0.5 * (place(use.low) + place(use.high));
      model.vertices.push_back(half);
      for (const EdgeUse* same = &use;
           same != uses.data() + uses.size() && same->low == use.low && same->high == use.high; ++same) {
        const auto& t = model.triangles[static_cast<std::size_t>(same->triangle)];
        for (std::size_t k = 0; k < 3; ++k) {
          if (std::minmax(t[k], t[(k + 1) % 3]) == std::minmax(use.low, use.high))
            middles[static_cast<std::size_t>(same->triangle)][k] = middle;
        }
      }
    }
    std::vector<Triangle> cut;
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
      const auto [a, b, c] = model.triangles[t];
      const auto [ab, bc, ca] = middles[t];
      for (const Triangle& part : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
        cut.push_back(part);
    }
    model.triangles = std::move(cut);
  }
  find_planar_faces(model, kRead);
  return model;
}

double volume_of(const CadModel& model) {
  TriangleMesh mesh{model.vertices, model.triangles};
  const auto bodies = orient_bodies(mesh);
  return bodies && bodies->turned == 0 ? body_volumes(mesh, *bodies).front() : 0.0;
}

void expect_closed(const CadModel& model) {
  const std::vector<EdgeUse> uses = edge_uses(model.triangles);
  ASSERT_EQ(uses.size() % 2, 0U);
  for (std::size_t i = 0; i < uses.size(); i += 2) {
    EXPECT_TRUE(uses[i].low == uses[i + 1].low && uses[i].high == uses[i + 1].high);
    EXPECT_NE(uses[i].forward, uses[i + 1].forward);
  }
}

std::vector<CadModel> coarse_solids() { return {test::box(120, 90, 60), test::angle_block(), test::wedge()}; }

TEST(FlatVertices, are_those_that_a_finer_cut_adds) {
  for (const CadModel& coarse : coarse_solids()) {
    CadModel fine = finely_cut(coarse, 4);
    const int added = static_cast<int>(fine.vertices.size() - coarse.vertices.size());
    EXPECT_EQ(drop_flat_vertices(fine, kRead), added) << coarse.name;
    EXPECT_EQ(fine.vertices, coarse.vertices) << coarse.name;
    EXPECT_EQ(fine.triangles.size(), coarse.triangles.size()) << coarse.name;
  }
}

TEST(FlatVertices, leave_a_closed_surface_where_it_was) {
  for (const CadModel& coarse : coarse_solids()) {
    CadModel fine = finely_cut(coarse, 3);
    drop_flat_vertices(fine, kRead);
    expect_closed(fine);
    EXPECT_NEAR(volume_of(fine), volume_of(coarse), 1e-6 * volume_of(coarse)) << coarse.name;
  }
}

TEST(FlatVertices, leave_the_faces_as_they_were) {
  for (const CadModel& coarse : coarse_solids()) {
    CadModel fine = finely_cut(coarse, 3);
    const std::vector<CadFace> before = fine.faces;
    drop_flat_vertices(fine, kRead);
    ASSERT_EQ(fine.faces.size(), before.size()) << coarse.name;
    for (const CadFace& face : before) {
      EXPECT_TRUE(std::any_of(fine.faces.begin(), fine.faces.end(), [&](const CadFace& other) {
        return face.normal.dot(other.normal) > 1.0 - 1e-9 && std::abs(face.area - other.area) < 1e-6 * face.area &&
               (face.centroid - other.centroid).norm() < 1e-6;
      })) << coarse.name;
    }
  }
}

TEST(FlatVertices, are_none_where_every_vertex_is_a_corner) {
  for (CadModel coarse : coarse_solids()) {
    const CadModel before = coarse;
    EXPECT_EQ(drop_flat_vertices(coarse, kRead), 0) << before.name;
    EXPECT_EQ(coarse.vertices, before.vertices);
    EXPECT_EQ(coarse.triangles, before.triangles);
  }
}

TEST(FlatVertices, are_none_on_an_edge_that_bends) {
  CadModel bent = finely_cut(test::box(120, 90, 60), 1);
  // The middle of a vertical edge moved out along one face: still in that face's plane, no longer in the other's.
  for (Eigen::Vector3d& vertex : bent.vertices) {
    if ((vertex - Eigen::Vector3d(120, 90, 30)).norm() < 1e-9) vertex.y() += 1.0;
  }
  find_planar_faces(bent, kRead);
  drop_flat_vertices(bent, kRead);
  EXPECT_TRUE(std::any_of(bent.vertices.begin(), bent.vertices.end(),
                          [](const Eigen::Vector3d& v) { return (v - Eigen::Vector3d(120, 91, 30)).norm() < 1e-9; }));
  expect_closed(bent);
}

}  // namespace
}  // namespace foresight
