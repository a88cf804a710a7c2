#include "runtime/rendering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/runtime/box_scene.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

// A rectangle about a centre, turned by v from facing the camera, as two triangles added to a model.
void add_rectangle(CompiledModel& model, const Vector3d& centre, double width, double height,
                   const Vector3d& v = {0, 0, 0}) {
  const int first = static_cast<int>(model.vertices.size());
  for (const auto& [x, y] : {std::pair(-0.5, -0.5), {-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}}) {
    model.vertices.emplace_back(
        (centre + rotation_from_vector(v) * Vector3d(x * width, y * height, 0.0)).cast<float>());
  }
  model.triangles.push_back({first, first + 1, first + 2});
  model.triangles.push_back({first, first + 2, first + 3});
}

CompiledModel rectangle(const Vector3d& centre, double width, double height, const Vector3d& v = {0, 0, 0}) {
  CompiledModel model;
  add_rectangle(model, centre, width, height, v);
  return model;
}

// Depth in a cell of the image, 0 outside the window.
double depth_at(const Rendering& drawn, int row, int column) {
  row -= drawn.first_row;
  column -= drawn.first_column;
  if (row < 0 || row >= drawn.rows || column < 0 || column >= drawn.columns) return 0.0;
  return static_cast<double>(drawn.depth[static_cast<std::size_t>(drawn.cell(row, column))]);
}

long cells_shown(const Rendering& drawn) {
  return std::count_if(drawn.triangle.begin(), drawn.triangle.end(), [](int triangle) { return triangle >= 0; });
}

TEST(Rendering, depth_is_that_of_the_plane_along_each_ray) {
  const PinholeCamera camera;
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(0.7, 0, 0), Vector3d(0, -0.8, 0.3), Vector3d(0.4, 0.5, 1)}) {
    const Vector3d centre(12.0, -20.0, 850.0);
    const Rendering drawn = render(rectangle(centre, 80.0, 60.0, turn), {}, camera);
    const Vector3d normal = rotation_from_vector(turn) * -Vector3d::UnitZ();
    const Eigen::Matrix3d back = rotation_from_vector(turn).transpose();
    int shown = 0;
    for (int row = 0; row < camera.rows; ++row) {
      for (int column = 0; column < camera.columns; ++column) {
        const Vector3d ray = camera.ray(row, column);
        const double z = normal.dot(centre) / normal.dot(ray);
        const Vector3d inside = (back * (z * ray - centre)).cwiseAbs();
        const double margin = std::max(inside.x() - 40.0, inside.y() - 30.0);  // > 0: outside. Unit: mm.
        if (std::abs(margin) < 1e-3) continue;                                 // rounding decides
        EXPECT_NEAR(depth_at(drawn, row, column), margin < 0.0 ? z : 0.0, 1e-3) << row << " " << column;
        shown += margin < 0.0 ? 1 : 0;
      }
    }
    EXPECT_GT(shown, 1000);
    for (const Eigen::Vector3f& n : drawn.normal) EXPECT_NEAR((n.cast<double>() - normal).norm(), 0.0, 1e-5);
  }
}

TEST(Rendering, shows_a_box_as_rays_meet_it) {
  const PinholeCamera camera;
  const CompiledModel box = test::box_model();
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(2, 1, 0), Vector3d(-1, 0.2, 2.5), Vector3d(0, 3, -1)}) {
    const Pose pose = test::moved(test::box_pose(), {15.0, -10.0, 40.0}, turn);
    const Rendering drawn = render(box, pose, camera);
    const RangeImage image = test::box_image(pose, camera);
    int differ = 0;  // on the outline, by rounding
    int shown = 0;
    for (int cell = 0; cell < image.size(); ++cell) {
      const double depth = depth_at(drawn, cell / camera.columns, cell % camera.columns);
      differ += (depth > 0.0) != image.valid(cell) ? 1 : 0;
      if (!(depth > 0.0) || !image.valid(cell)) continue;
      EXPECT_NEAR(depth, static_cast<double>(image[cell].z()), 1e-2);
      ++shown;
    }
    EXPECT_LE(differ, 2);
    EXPECT_GT(shown, 1000);
  }
}

TEST(Rendering, the_nearer_triangle_wins_in_either_order) {
  const PinholeCamera camera;
  for (const bool near_first : {true, false}) {
    CompiledModel model;
    add_rectangle(model, {0, 0, near_first ? 700.0 : 900.0}, 50, 50);
    add_rectangle(model, {0, 0, near_first ? 900.0 : 700.0}, 50, 50);
    const Rendering drawn = render(model, {}, camera);
    EXPECT_NEAR(depth_at(drawn, 119, 127), 700.0, 1e-3);
    const int middle =
        drawn.triangle[static_cast<std::size_t>(drawn.cell(119 - drawn.first_row, 127 - drawn.first_column))];
    EXPECT_EQ(middle / 2, near_first ? 0 : 1);
  }
}

TEST(Rendering, leaves_out_back_faces) {
  const PinholeCamera camera;
  CompiledModel model = rectangle({0, 0, 900}, 50, 50);
  EXPECT_GT(cells_shown(render(model, {}, camera)), 1000);
  for (auto& triangle : model.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_EQ(cells_shown(render(model, {}, camera)), 0);
}

TEST(Rendering, leaves_out_triangles_without_area) {
  CompiledModel model;
  model.vertices = {{-20, 0, 900}, {0, 0, 900}, {20, 0, 900}, {0, 20, 900}};
  model.triangles = {{0, 1, 2}, {0, 0, 3}};
  EXPECT_EQ(cells_shown(render(model, {}, PinholeCamera{})), 0);
}

TEST(Rendering, is_empty_behind_the_camera_and_outside_the_image) {
  const PinholeCamera camera;
  const CompiledModel model = rectangle({0, 0, 0}, 50, 50);
  const Pose seen{Eigen::Matrix3d::Identity(), {0, 0, 900}};
  ASSERT_GT(cells_shown(render(model, seen, camera)), 1000);
  for (const Vector3d& place : {Vector3d(0, 0, -900), Vector3d(0, 0, 0), Vector3d(400, 0, 900), Vector3d(-400, 0, 900),
                                Vector3d(0, 400, 900), Vector3d(0, -400, 900)}) {
    const Rendering drawn = render(model, {seen.rotation, place}, camera);
    EXPECT_EQ(drawn.depth.size(), 0U) << place.transpose();
    EXPECT_EQ(drawn.triangle.size(), 0U) << place.transpose();
  }
}

TEST(Rendering, is_empty_when_one_vertex_lies_behind_the_camera) {
  CompiledModel model = rectangle({0, 0, 900}, 50, 50);
  model.vertices.emplace_back(0.0F, 0.0F, -1.0F);
  EXPECT_TRUE(render(model, {}, PinholeCamera{}).depth.empty());
}

TEST(Rendering, cuts_at_the_border_of_the_image) {
  const PinholeCamera camera;
  const Rendering drawn = render(rectangle({0, 0, 900}, 1000, 1000), {}, camera);
  EXPECT_EQ(drawn.first_row, 0);
  EXPECT_EQ(drawn.first_column, 0);
  EXPECT_EQ(drawn.rows, camera.rows);
  EXPECT_EQ(drawn.columns, camera.columns);
  EXPECT_EQ(cells_shown(drawn), static_cast<long>(camera.rows) * camera.columns);
}

// Their images lie farther away than integers reach.
TEST(Rendering, bears_vertices_close_to_the_plane_of_the_camera) {
  const PinholeCamera camera;
  for (const float side : {-1.0F, 1.0F}) {
    CompiledModel beside;
    beside.vertices = {
        {side * 1e3F, side * 900.0F, 1e-9F}, {side * 1e3F, side * 1e3F, 1e-9F}, {side * 2e3F, side * 1e3F, 2e-9F}};
    beside.triangles = {{0, 1, 2}, {0, 2, 1}};
    EXPECT_EQ(cells_shown(render(beside, {}, camera)), 0);
  }
  CompiledModel reaching = rectangle({0, 0, 900}, 50, 50);
  const long alone = cells_shown(render(reaching, {}, camera));
  reaching.vertices.emplace_back(1e3F, 1e3F, 1e-9F);
  reaching.triangles.push_back({0, 1, 4});
  reaching.triangles.push_back({1, 0, 4});
  EXPECT_GE(cells_shown(render(reaching, {}, camera)), alone);
}

TEST(SameShare, of_a_view_with_itself_is_all) {
  const PinholeCamera camera;
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(2, 1, 0)}) {
    const Rendering drawn = render(test::box_model(), test::moved(test::box_pose(), {0, 0, 0}, turn), camera);
    EXPECT_EQ(same_share(drawn, drawn, 1e-6), 1.0);
  }
}

TEST(SameShare, is_the_same_either_way_and_a_share) {
  const PinholeCamera camera;
  const CompiledModel box = test::box_model();
  const Rendering here = render(box, test::box_pose(), camera);
  for (const Vector3d& move : {Vector3d(3, 0, 0), Vector3d(-20, 10, 5), Vector3d(0, 0, 30), Vector3d(40, 40, 0)}) {
    const Rendering there = render(box, test::moved(test::box_pose(), move, 0.01 * move), camera);
    const double share = same_share(here, there, 5.0);
    EXPECT_EQ(share, same_share(there, here, 5.0)) << move.transpose();
    EXPECT_GE(share, 0.0);
    EXPECT_LT(share, 1.0);
  }
}

TEST(SameShare, is_none_for_views_apart_or_empty) {
  const PinholeCamera camera;
  const Rendering left = render(rectangle({-60, 0, 900}, 50, 50), {}, camera);
  const Rendering right = render(rectangle({60, 0, 900}, 50, 50), {}, camera);
  EXPECT_EQ(same_share(left, right, 1e9), 0.0);
  EXPECT_EQ(same_share(left, Rendering{}, 1e9), 0.0);
  EXPECT_EQ(same_share(Rendering{}, left, 1e9), 0.0);
  EXPECT_EQ(same_share(Rendering{}, Rendering{}, 1e9), 0.0);
}

TEST(SameShare, counts_the_cells_both_show_of_those_either_shows) {
  const PinholeCamera camera;
  // 60 mm wide each, 30 mm of them shared: a third of all.
  const Rendering left = render(rectangle({-15, 0, 900}, 60, 50), {}, camera);
  const Rendering right = render(rectangle({15, 0, 900}, 60, 50), {}, camera);
  EXPECT_NEAR(same_share(left, right, 1.0), 1.0 / 3.0, 0.02);
  const Rendering within = render(rectangle({0, 0, 900}, 30, 50), {}, camera);
  EXPECT_NEAR(same_share(left, within, 1.0), 0.5, 0.03);
}

TEST(SameShare, grows_with_the_reach_of_a_sensor_that_matches_windows) {
  const PinholeCamera camera;
  const Rendering narrow = render(rectangle({0, 0, 900}, 60, 50), {}, camera);
  const Rendering wide = render(rectangle({0, 0, 900}, 70, 50), {}, camera);  // by 4 cells at either side
  double last = 0.0;
  for (const int reach : {0, 2, 5}) {
    const double share = same_share(narrow, wide, 1.0, reach);
    EXPECT_EQ(share, same_share(wide, narrow, 1.0, reach));
    EXPECT_GT(share, last);
    last = share;
  }
  EXPECT_EQ(last, 1.0);
}

TEST(SameShare, depths_are_the_same_within_the_distance) {
  const PinholeCamera camera;
  const Rendering near = render(rectangle({0, 0, 900}, 60, 50), {}, camera);
  const Rendering far = render(rectangle({0, 0, 904}, 60, 50), {}, camera);
  EXPECT_EQ(same_share(near, far, 3.9), 0.0);
  EXPECT_GT(same_share(near, far, 4.1), 0.95);
}

}  // namespace
}  // namespace foresight
