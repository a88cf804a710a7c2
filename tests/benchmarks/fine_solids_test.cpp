#include "benchmarks/fine_solids.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compiler/mesh_bodies.h"
#include "compiler/solid_check.h"

namespace foresight {
namespace {

void expect_solid(TriangleMesh mesh, double volume) {
  EXPECT_TRUE(check_solid("fine solid", mesh).empty()) << "something had to be repaired";
  const auto bodies = orient_bodies(mesh);
  ASSERT_TRUE(bodies.has_value());
  ASSERT_EQ(bodies->count, 1);
  EXPECT_NEAR(body_volumes(mesh, *bodies).front(), volume, 0.02 * volume);
}

TEST(FineSolids, are_closed_outward_and_of_their_size) {
  for (const int triangles : {1000, 20000}) {
    expect_solid(fine_box(triangles), 120.0 * 90.0 * 60.0);
    expect_solid(fine_cylinder(triangles), std::numbers::pi * 50.0 * 50.0 * 80.0);
  }
}

TEST(FineSolids, have_about_as_many_triangles_as_asked_for) {
  for (const int triangles : {1000, 20000}) {
    EXPECT_NEAR(static_cast<double>(fine_box(triangles).triangles.size()), triangles, 0.15 * triangles);
    EXPECT_NEAR(static_cast<double>(fine_cylinder(triangles).triangles.size()), triangles, 0.15 * triangles);
  }
}

}  // namespace
}  // namespace foresight
