#include "common/range_image.h"

#include <gtest/gtest.h>

#include <set>

namespace foresight {
namespace {

TEST(RangeImage, starts_without_data) {
  const RangeImage image(33, 47);
  EXPECT_EQ(image.size(), 33 * 47);
  EXPECT_EQ(image.points.size(), 33U * 47U);
  EXPECT_EQ(count_valid(image), 0);
  for (const Eigen::Vector3f& point : image.points) EXPECT_TRUE(point.array().isNaN().all());
}

TEST(RangeImage, cells_are_numbered_row_by_row) {
  const RangeImage image(33, 47);
  std::set<int> cells;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) cells.insert(image.cell(row, column));
  }
  EXPECT_EQ(cells.size(), image.points.size());
  EXPECT_EQ(*cells.begin(), 0);
  EXPECT_EQ(*cells.rbegin(), image.size() - 1);
  EXPECT_EQ(image.cell(2, 5) - image.cell(2, 4), 1);
}

TEST(RangeImage, counts_the_cells_that_hold_a_point) {
  RangeImage image(32, 32);
  image[image.cell(3, 4)] = {1.0F, 2.0F, 900.0F};
  image[image.cell(31, 31)] = {0.0F, 0.0F, 0.0F};
  EXPECT_TRUE(image.valid(image.cell(3, 4)));
  EXPECT_TRUE(image.valid(image.cell(31, 31)));
  EXPECT_FALSE(image.valid(image.cell(4, 3)));
  EXPECT_EQ(count_valid(image), 2);
}

TEST(RangeImage, largest_image_has_a_number_for_every_cell) {
  const RangeImage image(kLargestImageSide, 32);
  EXPECT_EQ(image.cell(kLargestImageSide - 1, 31), image.size() - 1);
}

TEST(RangeImage, default_is_empty) {
  const RangeImage image;
  EXPECT_EQ(image.size(), 0);
  EXPECT_EQ(count_valid(image), 0);
}

}  // namespace
}  // namespace foresight
