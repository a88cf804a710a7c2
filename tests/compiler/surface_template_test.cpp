#include "compiler/surface_template.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/random.h"
#include "common/viewing_sphere.h"
#include "tests/solids.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

bool contains(const std::vector<int>& values, int value) {
  return std::binary_search(values.begin(), values.end(), value);
}

Vector3d position(const TemplatePoint& point) { return point.position.cast<double>(); }

std::vector<CadModel> solids() {
  return {test::make_box(40, 30, 20),   test::make_step(),
          test::make_slotted_block(),   test::make_prism(7, 25, 30),
          test::make_prism(40, 25, 10), test::make_box(40, 30, 1)};
}

int points_of_face(const SurfaceTemplate& surface, int face) {
  return static_cast<int>(std::count_if(surface.points.begin(), surface.points.end(),
                                        [face](const TemplatePoint& p) { return contains(p.faces, face); }));
}

TEST(SurfaceTemplate, no_two_points_are_nearer_than_the_spacing) {
  for (const CadModel& model : solids()) {
    const SurfaceTemplate surface = build_surface_template(model, {});
    EXPECT_EQ(surface.spacing, 5.0);
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GE((position(surface.points[i]) - position(surface.points[j])).norm(), 5.0 - 1e-4);  // single precision
      }
    }
  }
}

TEST(SurfaceTemplate, points_lie_on_the_planes_of_their_faces) {
  for (const CadModel& model : solids()) {
    for (const TemplatePoint& point : build_surface_template(model, {}).points) {
      ASSERT_FALSE(point.faces.empty());
      EXPECT_TRUE(std::is_sorted(point.faces.begin(), point.faces.end()));
      for (const int f : point.faces) {
        const CadFace& face = model.faces[static_cast<std::size_t>(f)];
        EXPECT_NEAR(face.normal.dot(position(point)), face.offset, 0.1 + 1e-4);
      }
      const Vector3d normal = model.faces[static_cast<std::size_t>(point.faces.front())].normal;
      EXPECT_LT((point.normal.cast<double>() - normal).norm(), 1e-6);
    }
  }
}

TEST(SurfaceTemplate, covers_a_box_with_a_full_grid_whose_edges_are_shared) {
  const SurfaceTemplate surface = build_surface_template(test::make_box(40, 30, 20), {});
  // 9 x 7 x 5 grid points, without the 7 x 5 x 3 inside.
  EXPECT_EQ(surface.points.size(), 9u * 7u * 5u - 7u * 5u * 3u);
  EXPECT_EQ(points_of_face(surface, 0), 9 * 7);
  int edge_points = 0, corners = 0;
  for (const TemplatePoint& point : surface.points) {
    edge_points += point.faces.size() == 2 ? 1 : 0;
    corners += point.faces.size() == 3 ? 1 : 0;
  }
  EXPECT_EQ(corners, 8);
  EXPECT_EQ(edge_points, 4 * (7 + 5 + 3));
}

TEST(SurfaceTemplate, gives_each_face_a_point_unless_its_neighbours_stand_too_near) {
  for (const CadModel& model : solids()) {
    const SurfaceTemplate surface = build_surface_template(model, {});
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      if (points_of_face(surface, static_cast<int>(f)) > 0) continue;
      EXPECT_TRUE(std::any_of(surface.points.begin(), surface.points.end(), [&](const TemplatePoint& point) {
        return (position(point) - model.faces[f].centroid).norm() < 5.0;
      })) << model.name;
    }
  }
  for (const CadModel& model : {test::make_box(40, 30, 20), test::make_step(), test::make_slotted_block(),
                                test::make_box(40, 6, 6), test::make_prism(7, 25, 30)}) {
    const SurfaceTemplate surface = build_surface_template(model, {});
    for (int f = 0; f < static_cast<int>(model.faces.size()); ++f)
      EXPECT_GT(points_of_face(surface, f), 0) << model.name;
  }
}

TEST(SurfaceTemplate, leaves_no_hole_wider_than_the_grid) {
  const CadModel model = test::make_step();
  const SurfaceTemplate surface = build_surface_template(model, {});
  Random random(3);
  for (int i = 0; i < 3000; ++i) {
    const Triangle& t =
        model.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(model.triangles.size()) - 1))];
    double a = random.uniform(), b = random.uniform();
    if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
    const auto corner = [&](std::size_t k) { return model.vertices[static_cast<std::size_t>(t[k])]; };
    const Vector3d p = corner(0) + a * (corner(1) - corner(0)) + b * (corner(2) - corner(0));
    double nearest = 1e9;
    for (const TemplatePoint& point : surface.points) nearest = std::min(nearest, (position(point) - p).norm());
    EXPECT_LT(nearest, 2.0 * 5.0);
  }
}

TEST(SurfaceTemplate, neighbours_are_mutual_and_just_those_within_the_radius) {
  const SurfaceTemplate surface = build_surface_template(test::make_slotted_block(), {});
  const int count = static_cast<int>(surface.points.size());
  for (int i = 0; i < count; ++i) {
    const TemplatePoint& point = surface.points[static_cast<std::size_t>(i)];
    EXPECT_TRUE(std::is_sorted(point.neighbours.begin(), point.neighbours.end()));
    for (int j = 0; j < count; ++j) {
      const double apart = (position(point) - position(surface.points[static_cast<std::size_t>(j)])).norm();
      if (i == j) {
        EXPECT_FALSE(contains(point.neighbours, j));
      } else if (std::abs(apart - 10.0) > 1e-4) {
        EXPECT_EQ(contains(point.neighbours, j), apart < 10.0);
      }
      EXPECT_EQ(contains(point.neighbours, j), contains(surface.points[static_cast<std::size_t>(j)].neighbours, i));
    }
  }
}

TEST(SurfaceTemplate, shows_of_a_convex_solid_the_faces_in_front_and_no_other) {
  const ViewingSphere sphere(kAspectCells);
  for (const CadModel& model : {test::make_box(40, 30, 20), test::make_prism(7, 25, 30)}) {
    const SurfaceTemplate surface = build_surface_template(model, {});
    for (int cell = 0; cell < kAspectCells; ++cell) {
      for (int f = 0; f < static_cast<int>(model.faces.size()); ++f) {
        const double cosine = model.faces[static_cast<std::size_t>(f)].normal.dot(sphere.centre(cell));
        const bool visible = contains(surface.aspects[static_cast<std::size_t>(cell)], f);
        if (cosine > 0.3) {  // more than half a cell in front
          EXPECT_TRUE(visible) << "face " << f << " from cell " << cell;
        }
        if (cosine < -0.3) {
          EXPECT_FALSE(visible) << "face " << f << " from cell " << cell;
        }
      }
    }
  }
}

TEST(SurfaceTemplate, shows_the_floor_of_a_deep_slot_only_along_the_slot) {
  const CadModel model = test::make_slotted_block();
  const Vector3d normal = model.faces[test::kSlotFloor].normal;
  ASSERT_NEAR(normal.y(), 1.0, 1e-12);
  ASSERT_NEAR(model.faces[test::kSlotFloor].offset, 10.0, 1e-9);
  const SurfaceTemplate surface = build_surface_template(model, {});
  const ViewingSphere sphere(kAspectCells);
  bool seen = false;
  for (int cell = 0; cell < kAspectCells; ++cell) {
    const Vector3d& direction = sphere.centre(cell);
    const bool visible = contains(surface.aspects[static_cast<std::size_t>(cell)], test::kSlotFloor);
    seen = seen || visible;
    // The slot is 10 mm wide along x and 40 mm deep and long: from the side its walls stand before the floor.
    if (std::abs(direction.x()) > 1.2 * std::max(std::abs(direction.y()), std::abs(direction.z()))) {
      EXPECT_FALSE(visible) << direction.transpose();
    }
  }
  EXPECT_TRUE(seen);
}

TEST(SurfaceTemplate, asks_for_more_of_a_face_when_the_visible_share_is_larger) {
  const CadModel model = test::make_slotted_block();
  std::size_t last = 0;
  for (const double share : {0.9, 0.3}) {
    SurfaceTemplateOptions options;
    options.visible_share = share;
    std::size_t visible = 0;
    for (const auto& aspect : build_surface_template(model, options).aspects) visible += aspect.size();
    EXPECT_GE(visible, last);
    last = visible;
  }
  EXPECT_GT(last, 0u);
}

TEST(SurfaceTemplate, keeps_its_statistics_when_the_solid_moves) {
  Random random(5);
  for (const CadModel& model : {test::make_step(), test::make_slotted_block()}) {
    const SurfaceTemplate still = build_surface_template(model, {});
    const SurfaceTemplate moved =
        build_surface_template(test::moved(model, {random.rotation(), Vector3d(200, -300, 50)}), {});
    EXPECT_EQ(still.points.size(), moved.points.size());
    double seen_still = 0.0, seen_moved = 0.0;
    for (std::size_t cell = 0; cell < kAspectCells; ++cell) {
      seen_still += static_cast<double>(still.aspects[cell].size());
      seen_moved += static_cast<double>(moved.aspects[cell].size());
    }
    EXPECT_NEAR(seen_moved, seen_still, 0.1 * seen_still);
  }
}

TEST(SurfaceTemplate, is_the_same_every_time) {
  const SurfaceTemplate a = build_surface_template(test::make_step(), {}),
                        b = build_surface_template(test::make_step(), {});
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].position, b.points[i].position);
    EXPECT_EQ(a.points[i].faces, b.points[i].faces);
    EXPECT_EQ(a.points[i].neighbours, b.points[i].neighbours);
  }
  EXPECT_EQ(a.aspects, b.aspects);
}

TEST(SurfaceTemplate, takes_an_eye_inside_the_object_further_out) {
  SurfaceTemplateOptions options;
  options.distance = 1.0;
  for (const auto& aspect : build_surface_template(test::make_box(40, 30, 20), options).aspects)
    EXPECT_FALSE(aspect.empty());
}

}  // namespace
}  // namespace foresight
