#include "common/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "common/random.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

const PinholeCamera kCamera{60, 64, 190.0, 210.0, 29.25, 33.5};

// Every cell at some depth between 800 and 1000 mm.
RangeImage image_of(const PinholeCamera& camera) {
  RangeImage image(camera.rows, camera.columns);
  Random random(1);
  for (int row = 0; row < camera.rows; ++row) {
    for (int column = 0; column < camera.columns; ++column) {
      image[image.cell(row, column)] = (random.uniform(800, 1000) * camera.ray(row, column)).cast<float>();
    }
  }
  return image;
}

void clear_all_but(RangeImage& image, const auto& keep) {
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      if (!keep(row, column)) image[image.cell(row, column)].setConstant(std::numeric_limits<float>::quiet_NaN());
    }
  }
}

TEST(PinholeCamera, projection_undoes_the_ray) {
  for (const double row : {-3.5, 0.0, 17.3, 59.0}) {
    for (const double column : {0.0, 12.7, 63.0, 70.0}) {
      const Eigen::Vector2d cell = kCamera.project(437.0 * kCamera.ray(row, column));
      EXPECT_NEAR(cell.x(), column, 1e-10);
      EXPECT_NEAR(cell.y(), row, 1e-10);
      EXPECT_EQ(kCamera.ray(row, column).z(), 1.0);
    }
  }
}

TEST(PinholeCamera, columns_grow_to_the_right_and_rows_downwards) {
  const Eigen::Vector2d middle = kCamera.project({0, 0, 900});
  EXPECT_GT(kCamera.project({10, 0, 900}).x(), middle.x());
  EXPECT_GT(kCamera.project({0, 10, 900}).y(), middle.y());
}

TEST(PinholeCamera, points_around_a_cells_ray_belong_to_it) {
  for (const int row : {0, 30, 59}) {
    for (const int column : {0, 31, 63}) {
      for (const double aside : {-0.49, 0.0, 0.49}) {
        const Vector3d point = 900.0 * kCamera.ray(row + aside, column - aside);
        EXPECT_EQ(kCamera.cell_of(point), row * kCamera.columns + column);
      }
    }
  }
}

TEST(PinholeCamera, points_outside_the_grid_or_behind_the_camera_belong_to_no_cell) {
  EXPECT_EQ(kCamera.cell_of(900.0 * kCamera.ray(-0.51, 10)), -1);
  EXPECT_EQ(kCamera.cell_of(900.0 * kCamera.ray(59.51, 10)), -1);
  EXPECT_EQ(kCamera.cell_of(900.0 * kCamera.ray(10, -0.51)), -1);
  EXPECT_EQ(kCamera.cell_of(900.0 * kCamera.ray(10, 63.51)), -1);
  EXPECT_EQ(kCamera.cell_of(-900.0 * kCamera.ray(10, 10)), -1);
  EXPECT_EQ(kCamera.cell_of({0, 0, 0}), -1);
  EXPECT_EQ(kCamera.cell_of({1e300, 0, 1e-300}), -1);
  EXPECT_EQ(kCamera.cell_of(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())), -1);
}

TEST(PinholeCamera, equality_compares_every_field) {
  EXPECT_TRUE(kCamera == kCamera);
  PinholeCamera other = kCamera;
  other.cy += 1e-9;
  EXPECT_FALSE(other == kCamera);
  other = kCamera;
  other.rows += 1;
  EXPECT_FALSE(other == kCamera);
}

TEST(FitCamera, recovers_the_camera_of_a_grid) {
  const auto camera = fit_camera(image_of(kCamera));
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->rows, kCamera.rows);
  EXPECT_EQ(camera->columns, kCamera.columns);
  EXPECT_NEAR(camera->fx, kCamera.fx, 1e-3);
  EXPECT_NEAR(camera->fy, kCamera.fy, 1e-3);
  EXPECT_NEAR(camera->cx, kCamera.cx, 1e-3);
  EXPECT_NEAR(camera->cy, kCamera.cy, 1e-3);
}

TEST(FitCamera, needs_only_a_part_of_the_grid) {
  RangeImage image = image_of(kCamera);
  clear_all_but(image, [](int row, int column) { return row > 40 && row < 48 && column > 50; });
  const auto camera = fit_camera(image);
  ASSERT_TRUE(camera);
  EXPECT_NEAR(camera->fx, kCamera.fx, 0.01);
  EXPECT_NEAR(camera->cy, kCamera.cy, 0.01);
}

TEST(FitCamera, gives_none_for_too_few_cells_or_cells_in_a_line) {
  EXPECT_FALSE(fit_camera(RangeImage(32, 32)));
  RangeImage few = image_of(kCamera);
  clear_all_but(few, [](int row, int column) { return row % 20 == 0 && column % 20 == 0 && row + column < 80; });
  ASSERT_LT(count_valid(few), 16);
  EXPECT_FALSE(fit_camera(few));
  RangeImage row_only = image_of(kCamera);
  clear_all_but(row_only, [](int row, int) { return row == 7; });
  EXPECT_FALSE(fit_camera(row_only));
  RangeImage column_only = image_of(kCamera);
  clear_all_but(column_only, [](int, int column) { return column == 7; });
  EXPECT_FALSE(fit_camera(column_only));
}

TEST(FitCamera, gives_none_for_grids_that_are_no_pinhole_grid) {
  // Parallel rays: the grid of an orthographic sensor over a slope.
  RangeImage parallel(40, 40);
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) {
      const double z = 300.0 + 10.0 * column + 6.0 * row;
      parallel[parallel.cell(row, column)] = Vector3d(5.0 * column - 100, 5.0 * row - 100, z).cast<float>();
    }
  }
  EXPECT_FALSE(fit_camera(parallel));
  // Points in no order.
  RangeImage shuffled = image_of(kCamera);
  Random random(2);
  for (int cell = 0; cell < shuffled.size(); ++cell) {
    std::swap(shuffled[cell], shuffled[random.integer(0, shuffled.size() - 1)]);
  }
  EXPECT_FALSE(fit_camera(shuffled));
  // Mirrored: columns run to the left.
  RangeImage mirrored = image_of(kCamera);
  for (auto& point : mirrored.points) point.x() = -point.x();
  EXPECT_FALSE(fit_camera(mirrored));
}

}  // namespace
}  // namespace foresight
