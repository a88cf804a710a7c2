#include "common/cell_connectivity.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>
#include <utility>

#include "tests/images.h"

namespace foresight {
namespace {

using test::facing;
using test::Rectangle;
using test::render;

PinholeCamera small_camera() { return {48, 64, 770.0, 770.0, 31.5, 23.5}; }

const SegmentationOptions& quiet() {
  static const SegmentationOptions options = segmentation_options_for(SensorModel());
  return options;
}

RangeImage small_image(const std::vector<Rectangle>& rectangles) { return render(rectangles, small_camera()); }
RangeImage flat_image() { return small_image({facing({0, 0, 900}, 400, 400)}); }

// A plane through (0, 0, 900), turned about the image's columns; fills the image at any slope.
RangeImage sloping_image(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  const Eigen::Vector3d along(std::cos(angle), 0.0, std::sin(angle));
  return small_image({{Eigen::Vector3d(0, -200, 900) - 400.0 * along, 800.0 * along, {0, 400, 0}}});
}

// Two planes that fall away from a ridge in the middle of the image, each by 30 degrees.
RangeImage roof_image() {
  const double c = std::cos(std::numbers::pi / 6.0);
  const double s = std::sin(std::numbers::pi / 6.0);
  return small_image(
      {{{0, -200, 900}, {200 * c, 0, 200 * s}, {0, 400, 0}}, {{0, -200, 900}, {-200 * c, 0, 200 * s}, {0, 400, 0}}});
}

void clear(RangeImage& image, int cell) { image[cell].setConstant(std::numeric_limits<float>::quiet_NaN()); }

TEST(CellConnectivity, holds_all_of_a_plane_together_up_to_the_border) {
  const RangeImage image = flat_image();
  const CellConnectivity connectivity(image, quiet());
  for (int cell = 0; cell < image.size(); ++cell) {
    EXPECT_EQ(connectivity.right(cell), cell % image.columns + 1 < image.columns ? cell + 1 : -1);
    EXPECT_EQ(connectivity.down(cell), cell / image.columns + 1 < image.rows ? cell + image.columns : -1);
  }
}

TEST(CellConnectivity, ends_at_a_depth_step_and_only_there) {
  // The nearer plane covers the columns to the left of the middle.
  const RangeImage image = small_image({facing({-100, 0, 880}, 200, 400), facing({0, 0, 900}, 800, 400)});
  const CellConnectivity connectivity(image, quiet());
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column + 1 < image.columns; ++column) {
      EXPECT_EQ(connectivity.right(image.cell(row, column)) >= 0, column != 31) << "column " << column;
    }
  }
}

TEST(CellConnectivity, bridges_one_missing_cell_but_not_three) {
  RangeImage image = flat_image();
  const int row = 20;
  clear(image, image.cell(row, 10));
  for (int column = 30; column < 33; ++column) clear(image, image.cell(row, column));
  const CellConnectivity connectivity(image, quiet());
  EXPECT_EQ(connectivity.right(image.cell(row, 9)), image.cell(row, 11));
  EXPECT_EQ(connectivity.down(image.cell(row - 1, 10)), image.cell(row + 1, 10));
  EXPECT_EQ(connectivity.right(image.cell(row, 29)), -1);
  EXPECT_EQ(connectivity.right(image.cell(row, 10)), -1) << "a cell without data holds to nothing";
}

TEST(CellConnectivity, bridges_no_depth_step) {
  RangeImage image = small_image({facing({-100, 0, 880}, 200, 400), facing({0, 0, 900}, 800, 400)});
  for (int row = 0; row < image.rows; ++row) clear(image, image.cell(row, 31));
  const CellConnectivity connectivity(image, quiet());
  for (int row = 0; row < image.rows; ++row) EXPECT_EQ(connectivity.right(image.cell(row, 30)), -1);
}

TEST(CellConnectivity, does_not_wrap_around_the_border) {
  RangeImage image = flat_image();
  for (int row = 0; row < image.rows; ++row) clear(image, image.cell(row, image.columns - 1));
  const CellConnectivity connectivity(image, quiet());
  for (int row = 0; row < image.rows; ++row) EXPECT_EQ(connectivity.right(image.cell(row, image.columns - 2)), -1);
}

TEST(CellConnectivity, follows_a_steep_slope_that_goes_on) {
  // From cell to cell this surface falls by more than an occlusion step may be: 5.7 cell spacings.
  const RangeImage image = sloping_image(80.0);
  const CellConnectivity connectivity(image, quiet());
  ASSERT_GT(std::tan(80.0 * std::numbers::pi / 180.0), quiet().largest_depth_step);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (cell % image.columns + 1 < image.columns && image.valid(cell) && image.valid(cell + 1)) {
      EXPECT_EQ(connectivity.right(cell), cell + 1);
    }
  }
}

TEST(CellConnectivity, parts_at_an_occlusion_edge_of_the_same_step) {
  // The very step of the slope above, but with level ground on both sides of it.
  RangeImage image = flat_image();
  for (int cell = 0; cell < image.size(); ++cell) {
    if (cell % image.columns >= 32) image[cell].z() += 5.7F * 900.0F / 770.0F;
  }
  const CellConnectivity connectivity(image, quiet());
  for (int row = 0; row < image.rows; ++row) EXPECT_EQ(connectivity.right(image.cell(row, 31)), -1);
}

TEST(CellConnectivity, is_mutual) {
  RangeImage image = roof_image();
  Random random(7);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (random.uniform() < 0.2) clear(image, cell);
  }
  const CellConnectivity connectivity(image, quiet());
  std::set<std::pair<int, int>> links;
  for (int cell = 0; cell < image.size(); ++cell) {
    connectivity.for_each_neighbour(cell, [&](int neighbour) { links.insert({cell, neighbour}); });
  }
  ASSERT_GT(links.size(), 1000U);
  for (const auto& [a, b] : links) EXPECT_TRUE(links.contains({b, a})) << a << " to " << b;
}

}  // namespace
}  // namespace foresight
