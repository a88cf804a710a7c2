#include "common/patch_merging.h"

#include <gtest/gtest.h>

#include <algorithm>
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

std::vector<int> no_labels(const RangeImage& image) { return std::vector<int>(image.points.size(), 0); }

std::vector<std::vector<int>> merged_patches(const RangeImage& image, int fewest_cells = 12) {
  return merge_patches(image, CellConnectivity(image, quiet()), no_labels(image), 4, fewest_cells, quiet());
}

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

TEST(MergePatches, makes_one_plane_of_one_plane) {
  const auto planes = merged_patches(flat_image());
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(planes[0].size(), 48U * 64U);
}

TEST(MergePatches, finds_both_sides_of_a_roof) {
  const RangeImage image = roof_image();
  const auto planes = merged_patches(image);
  ASSERT_EQ(planes.size(), 2U);
  for (const std::vector<int>& plane : planes) {
    const bool left = plane.front() % image.columns < 32;
    for (const int cell : plane) EXPECT_EQ(cell % image.columns < 32, left);
    EXPECT_GT(static_cast<int>(plane.size()), image.size() * 2 / 5);
  }
}

TEST(MergePatches, does_not_join_parallel_planes_across_a_step) {
  EXPECT_EQ(merged_patches(small_image({facing({-100, 0, 880}, 200, 400), facing({0, 0, 900}, 800, 400)})).size(), 2U);
}

TEST(MergePatches, takes_free_and_valid_cells_only_and_none_twice) {
  RangeImage image = flat_image();
  std::vector<int> labels = no_labels(image);
  for (int row = 0; row < image.rows; ++row) labels[static_cast<std::size_t>(image.cell(row, 5))] = 1;
  Random random(3);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (random.uniform() < 0.05) clear(image, cell);
  }
  const auto planes = merge_patches(image, CellConnectivity(image, quiet()), labels, 4, 12, quiet());
  std::set<int> seen;
  std::size_t cells = 0;
  for (const std::vector<int>& plane : planes) {
    cells += plane.size();
    seen.insert(plane.begin(), plane.end());
  }
  EXPECT_GT(cells, 2000U);
  EXPECT_EQ(seen.size(), cells);
  for (const int cell : seen) {
    EXPECT_TRUE(image.valid(cell));
    EXPECT_EQ(labels[static_cast<std::size_t>(cell)], 0);
  }
}

TEST(MergePatches, drops_what_is_too_small) {
  const RangeImage image = flat_image();
  EXPECT_EQ(merged_patches(image, image.size()).size(), 1U);
  EXPECT_TRUE(merged_patches(image, image.size() + 1).empty());
  EXPECT_TRUE(merged_patches(RangeImage(48, 64)).empty());
}

// Labels 1 to the left of a column and 2 from another on, 0 between them.
std::vector<int> halves(const RangeImage& image, int left_end, int right_begin) {
  std::vector<int> labels = no_labels(image);
  for (int cell = 0; cell < image.size(); ++cell) {
    const int column = cell % image.columns;
    labels[static_cast<std::size_t>(cell)] = column < left_end ? 1 : column >= right_begin ? 2 : 0;
  }
  return labels;
}

std::vector<int> merged_labels(const RangeImage& image, std::vector<int> labels) {
  merge_regions(image, CellConnectivity(image, quiet()), quiet(), labels);
  return labels;
}

TEST(MergeRegions, joins_coplanar_pieces_that_touch) {
  const RangeImage image = sloping_image(40.0);
  const std::vector<int> labels = merged_labels(image, halves(image, 32, 32));
  EXPECT_EQ(std::set<int>(labels.begin(), labels.end()).size(), 1U);
  EXPECT_NE(labels.front(), 0);
}

TEST(MergeRegions, leaves_planes_at_an_angle_apart) {
  const RangeImage image = roof_image();
  EXPECT_EQ(merged_labels(image, halves(image, 32, 32)), halves(image, 32, 32));
}

TEST(MergeRegions, leaves_coplanar_pieces_apart_that_do_not_touch) {
  const RangeImage image = flat_image();
  EXPECT_EQ(merged_labels(image, halves(image, 28, 34)), halves(image, 28, 34));
}

TEST(MergeRegions, joins_chains_of_pieces_and_keeps_free_cells_free) {
  const RangeImage image = flat_image();
  std::vector<int> labels = no_labels(image);
  for (int cell = 0; cell < image.size(); ++cell) {
    const int row = cell / image.columns;
    labels[static_cast<std::size_t>(cell)] = row < 4 ? 0 : 1 + row / 8;
  }
  const std::vector<int> merged = merged_labels(image, labels);
  EXPECT_EQ(std::set<int>(merged.begin(), merged.end()).size(), 2U);
  for (int cell = 0; cell < image.size(); ++cell) {
    EXPECT_EQ(merged[static_cast<std::size_t>(cell)] == 0, labels[static_cast<std::size_t>(cell)] == 0);
  }
}

}  // namespace
}  // namespace foresight
