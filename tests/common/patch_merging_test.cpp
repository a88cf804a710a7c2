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

PoolVector<int> no_labels(const RangeImage& image) { return PoolVector<int>(image.points.size(), 0); }

PointSums sums_at(double z, int count) {
  PointSums sums;
  for (int i = 0; i < count; ++i) sums.add({static_cast<double>(i % 10), static_cast<double>(i / 10), z});
  return sums;
}

TEST(MergeBestFirst, merges_the_nearest_pair_first) {
  // Three parallel patches; the middle one fits with either neighbour, but not with both.
  PoolVector<PointSums> patches = {sums_at(900.0, 100), sums_at(901.0, 100), sums_at(901.9, 100)};
  const PoolVector<int> merged = merge_best_first(patches, {{0, 1}, {1, 2}}, 0.6);
  EXPECT_NE(merged[0], merged[1]);
  EXPECT_EQ(merged[1], merged[2]);
  EXPECT_EQ(patches[static_cast<std::size_t>(merged[1])].count(), 200.0);
}

TEST(MergeBestFirst, a_small_patch_cannot_hide_in_a_large_one) {
  PoolVector<PointSums> patches = {sums_at(900.0, 10000), sums_at(905.0, 10)};
  const PoolVector<int> merged = merge_best_first(patches, {{0, 1}}, 1.0);
  EXPECT_NE(merged[0], merged[1]);
}

TEST(MergeBestFirst, leaves_apart_what_does_not_touch) {
  PoolVector<PointSums> patches = {sums_at(900.0, 100), sums_at(900.0, 100)};
  EXPECT_EQ(merge_best_first(patches, {}, 1.0), (PoolVector<int>{0, 1}));
}

// Labels 1 to the left of a column and 2 from another on, 0 between them.
PoolVector<int> halves(const RangeImage& image, int left_end, int right_begin) {
  PoolVector<int> labels = no_labels(image);
  for (int cell = 0; cell < image.size(); ++cell) {
    const int column = cell % image.columns;
    labels[static_cast<std::size_t>(cell)] = column < left_end ? 1 : column >= right_begin ? 2 : 0;
  }
  return labels;
}

PoolVector<int> merged_labels(const RangeImage& image, const PoolVector<int>& labels) {
  PlaneLabels found(image.size());
  found.labels = labels;
  found.sums.resize(static_cast<std::size_t>(*std::max_element(labels.begin(), labels.end())));
  for (int cell = 0; cell < image.size(); ++cell) {
    const int label = labels[static_cast<std::size_t>(cell)];
    if (label != 0) found.sums[static_cast<std::size_t>(label - 1)].add(image[cell].cast<double>());
  }
  merge_touching_planes(CellConnectivity(image, quiet()), quiet(), found);
  EXPECT_EQ(found.planes.size(), found.sums.size());
  EXPECT_EQ(found.planes.size(), static_cast<std::size_t>(*std::max_element(found.labels.begin(), found.labels.end())));
  return found.labels;
}

TEST(MergeTouchingPlanes, joins_coplanar_pieces_that_touch) {
  const RangeImage image = sloping_image(40.0);
  const PoolVector<int> labels = merged_labels(image, halves(image, 32, 32));
  EXPECT_EQ(std::set<int>(labels.begin(), labels.end()).size(), 1U);
  EXPECT_NE(labels.front(), 0);
}

TEST(MergeTouchingPlanes, leaves_planes_at_an_angle_apart) {
  const RangeImage image = roof_image();
  EXPECT_EQ(merged_labels(image, halves(image, 32, 32)), halves(image, 32, 32));
}

TEST(MergeTouchingPlanes, leaves_coplanar_pieces_apart_that_do_not_touch) {
  const RangeImage image = flat_image();
  EXPECT_EQ(merged_labels(image, halves(image, 28, 34)), halves(image, 28, 34));
}

TEST(MergeTouchingPlanes, joins_chains_of_pieces_and_keeps_free_cells_free) {
  const RangeImage image = flat_image();
  PoolVector<int> labels = no_labels(image);
  for (int cell = 0; cell < image.size(); ++cell) {
    const int row = cell / image.columns;
    labels[static_cast<std::size_t>(cell)] = row < 8 ? 0 : row / 8;
  }
  const PoolVector<int> merged = merged_labels(image, labels);
  EXPECT_EQ(std::set<int>(merged.begin(), merged.end()).size(), 2U);
  for (int cell = 0; cell < image.size(); ++cell) {
    EXPECT_EQ(merged[static_cast<std::size_t>(cell)] == 0, labels[static_cast<std::size_t>(cell)] == 0);
  }
}

}  // namespace
}  // namespace foresight
