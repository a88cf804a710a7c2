#include "compiler/surface_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/random.h"
#include "compiler/triangle_mesh.h"
#include "tests/compiler/solids.h"

namespace foresight {
namespace {

constexpr double kAnyNormal = -2.0;

double nearest_of_all(const CadModel& model, const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                      double least_cosine) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    if (model.faces[static_cast<std::size_t>(model.triangle_face[t])].normal.dot(normal) < least_cosine) continue;
    const auto corner = [&](std::size_t k) { return model.vertices[static_cast<std::size_t>(model.triangles[t][k])]; };
    nearest = std::min(nearest, distance_to_triangle(point, corner(0), corner(1), corner(2)));
  }
  return nearest;
}

TEST(SurfaceGrid, finds_what_a_search_of_all_triangles_finds) {
  Random random(5);
  for (const CadModel& model : {test::angle_block(), test::wedge(), test::box(200, 3, 70)}) {
    for (const double reach : {1.0, 4.0, 30.0}) {
      const SurfaceGrid grid(model, reach);
      for (int i = 0; i < 2000; ++i) {
        const Eigen::Vector3d point(random.uniform(-40, 220), random.uniform(-40, 100), random.uniform(-40, 100));
        const Eigen::Vector3d normal = random.direction();
        for (const double cosine : {kAnyNormal, 0.5}) {
          const double truth = nearest_of_all(model, point, normal, cosine);
          const double found = grid.distance(point, normal, cosine);
          if (truth > reach) {
            EXPECT_TRUE(std::isinf(found));
          } else {
            EXPECT_NEAR(found, truth, 1e-9);
          }
        }
      }
    }
  }
}

TEST(SurfaceGrid, passes_over_surface_that_faces_elsewhere) {
  const SurfaceGrid grid(test::box(50, 50, 50), 5.0);
  const Eigen::Vector3d below_the_top(25, 25, 48);
  EXPECT_NEAR(grid.distance(below_the_top, Eigen::Vector3d::UnitZ(), 0.9), 2.0, 1e-9);
  EXPECT_TRUE(std::isinf(grid.distance(below_the_top, Eigen::Vector3d::UnitX(), 0.9)));
  EXPECT_TRUE(std::isinf(grid.distance(below_the_top, -Eigen::Vector3d::UnitZ(), 0.9)));
}

}  // namespace
}  // namespace foresight
