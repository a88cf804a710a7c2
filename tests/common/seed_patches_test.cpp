#include "common/seed_patches.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

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

// Two planes that fall away from a ridge in the middle of the image, each by 30 degrees.
RangeImage roof_image() {
  const double c = std::cos(std::numbers::pi / 6.0);
  const double s = std::sin(std::numbers::pi / 6.0);
  return small_image(
      {{{0, -200, 900}, {200 * c, 0, 200 * s}, {0, 400, 0}}, {{0, -200, 900}, {-200 * c, 0, 200 * s}, {0, 400, 0}}});
}

void clear(RangeImage& image, int cell) { image[cell].setConstant(std::numeric_limits<float>::quiet_NaN()); }

PlaneLabels seeds_of(const RangeImage& image, const SegmentationOptions& options = quiet()) {
  PlaneLabels found(image.size());
  seed_on_grid(image, CellConnectivity(image, options), options, found);
  return found;
}

int count_of(const PlaneLabels& found, int label) {
  return static_cast<int>(std::count(found.labels.begin(), found.labels.end(), label));
}

void expect_sums_of_the_cells(const PlaneLabels& found) {
  for (std::size_t i = 0; i < found.planes.size(); ++i)
    EXPECT_EQ(found.sums[i].count(), count_of(found, static_cast<int>(i) + 1));
}

TEST(SeedOnGrid, makes_one_plane_of_one_plane) {
  const PlaneLabels found = seeds_of(flat_image());
  ASSERT_EQ(found.planes.size(), 1U);
  EXPECT_EQ(count_of(found, 1), 48 * 63) << "all blocks of 3 x 3 cells";
  expect_sums_of_the_cells(found);
}

TEST(SeedOnGrid, finds_both_sides_of_a_roof_and_leaves_the_ridge_free) {
  const RangeImage image = roof_image();
  const PlaneLabels found = seeds_of(image);
  ASSERT_EQ(found.planes.size(), 2U);
  expect_sums_of_the_cells(found);
  for (int row = 0; row < image.rows; ++row) {
    EXPECT_EQ(found.labels[static_cast<std::size_t>(image.cell(row, 32))], 0);
    EXPECT_NE(found.labels[static_cast<std::size_t>(image.cell(row, 20))],
              found.labels[static_cast<std::size_t>(image.cell(row, 44))]);
  }
}

TEST(SeedOnGrid, does_not_join_parallel_planes_across_a_step) {
  EXPECT_EQ(seeds_of(small_image({facing({-100, 0, 880}, 200, 400), facing({0, 0, 900}, 800, 400)})).planes.size(), 2U);
}

TEST(SeedOnGrid, finds_nothing_in_an_empty_image) { EXPECT_TRUE(seeds_of(RangeImage(48, 64)).planes.empty()); }

TEST(SeedOnGrid, drops_what_is_too_small) {
  SegmentationOptions options = quiet();
  options.smallest_region = 2 * 48 * 63;
  EXPECT_EQ(seeds_of(flat_image(), options).planes.size(), 1U) << "growing may double a seed";
  options.smallest_region += 2;
  EXPECT_TRUE(seeds_of(flat_image(), options).planes.empty());
}

TEST(SeedBetween, finds_a_strip_two_cells_wide_wherever_it_lies) {
  const RangeImage image = flat_image();
  for (const int first : {0, 5, 8, 62}) {
    PlaneLabels found(image.size());
    found.planes.resize(1);
    found.sums.resize(1);
    for (int cell = 0; cell < image.size(); ++cell) {
      const int column = cell % image.columns;
      found.labels[static_cast<std::size_t>(cell)] = column < first || column > first + 1 ? 1 : 0;
    }
    seed_between(image, CellConnectivity(image, quiet()), quiet(), 2, found);
    ASSERT_EQ(found.planes.size(), 2U) << "from column " << first;
    EXPECT_EQ(count_of(found, 2), 2 * 48);
  }
}

TEST(SeedBetween, takes_free_and_valid_cells_only) {
  RangeImage image = flat_image();
  Random random(3);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (random.uniform() < 0.05) clear(image, cell);
  }
  PlaneLabels found(image.size());
  found.planes.resize(1);
  found.sums.resize(1);
  for (int row = 0; row < image.rows; ++row) {
    const int cell = image.cell(row, 5);
    if (!image.valid(cell)) continue;
    found.labels[static_cast<std::size_t>(cell)] = 1;
    found.sums[0].add(image[cell].cast<double>());
  }
  const PlaneLabels before = found;
  seed_between(image, CellConnectivity(image, quiet()), quiet(), 2, found);
  EXPECT_GT(count_of(found, 0), 0);
  EXPECT_GT(image.size() - count_of(found, 0), 1500);
  expect_sums_of_the_cells(found);
  for (std::size_t at = 0; at < found.labels.size(); ++at) {
    if (found.labels[at] != 0) {
      EXPECT_TRUE(image.valid(static_cast<int>(at)));
    }
    if (before.labels[at] != 0) {
      EXPECT_EQ(found.labels[at], before.labels[at]);
    }
  }
}

}  // namespace
}  // namespace foresight
