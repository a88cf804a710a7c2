#include "common/region_boundary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/images.h"

namespace foresight {
namespace {

using Eigen::Vector3d;
using test::facing;
using test::Rectangle;

constexpr double kDepth = 900.0;

struct Cut {
  PoolVector<Region> regions;
  PoolVector<double> shares;
};

Cut cut_of(const RangeImage& image) {
  Cut cut{segment(image, {}), {}};
  cut.shares = cut_shares(cut.regions, image, PinholeCamera{});
  EXPECT_EQ(cut.shares.size(), cut.regions.size());
  for (const double share : cut.shares) EXPECT_TRUE(share >= 0.0 && share <= 1.0) << share;
  return cut;
}

Cut cut_of(const std::vector<Rectangle>& scene, double noise = 0.0) {
  return cut_of(test::render(scene, PinholeCamera{}, noise));
}

// Shares of the regions that lie at this depth, in order of size.
PoolVector<double> shares_at(const Cut& cut, double depth) {
  PoolVector<double> shares;
  for (std::size_t r = 0; r < cut.regions.size(); ++r) {
    if (std::abs(-cut.regions[r].offset - depth) < 1.0) shares.push_back(cut.shares[r]);
  }
  return shares;
}

// Of a rectangle's outline, that of one side of this length.
double side_share(double side, double other) { return side / (2.0 * (side + other)); }

Rectangle upright_bar(double left, double right, double depth) {
  return facing({0.5 * (left + right), 0, depth}, right - left, 600);
}

TEST(CutShares, are_none_without_regions) { EXPECT_TRUE(cut_shares({}, RangeImage(240, 256), {}).empty()); }

TEST(CutShares, a_face_alone_is_not_cut) {
  const Cut cut = cut_of({facing({10, -5, kDepth}, 100, 80)});
  ASSERT_EQ(cut.shares.size(), 1U);
  EXPECT_EQ(cut.shares[0], 0.0);
}

TEST(CutShares, what_lies_farther_away_does_not_cut) {
  for (const double beyond : {10.0, 50.0, 300.0}) {
    const PoolVector<double> shares =
        shares_at(cut_of({facing({0, 0, kDepth}, 100, 80), facing({0, 0, kDepth + beyond}, 900, 900)}), kDepth);
    ASSERT_EQ(shares.size(), 1U);
    EXPECT_EQ(shares[0], 0.0) << beyond;
  }
}

TEST(CutShares, what_lies_nearer_cuts_the_side_it_hides) {
  for (const double width : {30.0, 60.0, 90.0}) {
    // The left end of the face at x = -60 shows `width` of it beside the bar.
    const double edge = (-60.0 + width) * 700.0 / kDepth;
    const Cut cut = cut_of({facing({0, 0, kDepth}, 120, 80), upright_bar(edge, 150, 700)});
    const PoolVector<double> hidden = shares_at(cut, kDepth);
    ASSERT_EQ(hidden.size(), 1U);
    EXPECT_NEAR(hidden[0], side_share(80, width), 0.02) << width;
    const PoolVector<double> bar = shares_at(cut, 700.0);
    ASSERT_EQ(bar.size(), 1U);
    EXPECT_GT(bar[0], 0.05);  // only at the border of the image, which it reaches on three sides
  }
}

TEST(CutShares, only_sides_towards_something_nearer_are_cut) {
  const Cut cut = cut_of({facing({-60, 0, kDepth}, 60, 80), facing({60, 0, 700}, 50, 300)});
  const PoolVector<double> shares = shares_at(cut, kDepth);
  ASSERT_EQ(shares.size(), 1U);
  // Beyond the right side, over cells without data, comes the nearer object: a shadow of it might lie between.
  EXPECT_NEAR(shares[0], side_share(80, 60), 0.02);
  const PoolVector<double> apart =
      shares_at(cut_of({facing({-60, -50, kDepth}, 60, 60), facing({40, 60, 700}, 50, 40)}), kDepth);
  ASSERT_EQ(apart.size(), 1U);
  EXPECT_EQ(apart[0], 0.0);
}

TEST(CutShares, the_border_of_the_image_cuts) {
  // Half a field of view is 149.6 mm wide here; 50 mm of the face lie within.
  const Cut cut = cut_of({facing({199.6 - 50.0, 0, kDepth}, 100, 80)});
  ASSERT_EQ(cut.shares.size(), 1U);
  EXPECT_NEAR(cut.shares[0], side_share(80, 50), 0.02);
  const Cut filled = cut_of({facing({0, 0, kDepth}, 900, 900)});
  ASSERT_EQ(filled.shares.size(), 1U);
  EXPECT_EQ(filled.shares[0], 1.0);
}

// Two faces meet in an upright crease before the camera, each turned away (convex) or towards it (concave).
std::vector<Rectangle> crease(double turn) {
  const Pose left{rotation_from_vector({0, -turn, 0}), {0, 0, kDepth}};
  const Pose right{rotation_from_vector({0, turn, 0}), {0, 0, kDepth}};
  return {test::moved({{-50, -40, 0}, {50, 0, 0}, {0, 80, 0}}, left),
          test::moved({{0, -40, 0}, {50, 0, 0}, {0, 80, 0}}, right)};
}

TEST(CutShares, faces_that_end_where_they_meet_another_are_not_cut) {
  for (const double noise : {0.0, 0.1}) {
    for (const double turn : {-0.8, -0.5, -0.3, 0.3, 0.5, 0.8}) {
      const Cut cut = cut_of(crease(turn), noise);
      ASSERT_GE(cut.shares.size(), 2U) << turn;
      for (std::size_t r = 0; r < 2; ++r) EXPECT_LT(cut.shares[r], 0.03) << turn << ", noise " << noise;
    }
  }
}

TEST(CutShares, the_faces_of_a_box_are_not_cut) {
  const Pose pose{rotation_from_vector({0.6, 0.5, 0.2}), {0, 0, kDepth}};
  std::vector<Rectangle> sides;
  for (const Rectangle& side : test::box_sides({120, 70, 50})) sides.push_back(test::moved(side, pose));
  const Cut cut = cut_of(sides);
  ASSERT_EQ(cut.shares.size(), 3U);
  for (const double share : cut.shares) EXPECT_LT(share, 0.03);
}

TEST(CutShares, both_parts_of_a_face_behind_a_bar_are_cut) {
  const PoolVector<double> shares = shares_at(
      cut_of({facing({0, 0, kDepth}, 160, 80), upright_bar(-10.0 * 700 / kDepth, 20.0 * 700 / kDepth, 700)}), kDepth);
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_NEAR(shares[0], side_share(80, 70), 0.02);
  EXPECT_NEAR(shares[1], side_share(80, 60), 0.02);
}

// A stripe without data, as of a shadow: what goes on beyond it on the same plane is one face.
TEST(CutShares, both_parts_of_a_face_beside_a_gap_are_cut) {
  const PinholeCamera camera;
  RangeImage image = test::render({facing({0, 0, kDepth}, 160, 80)}, camera);
  for (int cell = 0; cell < image.size(); ++cell) {
    const int column = cell % camera.columns;
    if (column >= 120 && column < 140) image[cell].setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  const Cut cut = cut_of(image);
  ASSERT_EQ(cut.shares.size(), 2U);
  for (const double share : cut.shares) EXPECT_NEAR(share, side_share(80, 70), 0.04);
}

TEST(CutShares, a_hole_is_no_cut) {
  RangeImage image = test::render({facing({0, 0, kDepth}, 160, 160)}, PinholeCamera{});
  for (int row = 110; row < 130; ++row) {
    for (int column = 118; column < 138; ++column) {
      image[image.cell(row, column)].setConstant(std::numeric_limits<float>::quiet_NaN());
    }
  }
  const Cut cut = cut_of(image);
  ASSERT_EQ(cut.shares.size(), 1U);
  EXPECT_EQ(cut.shares[0], 0.0);
}

// More of a face hidden: more of its outline cut, until only a corner is left.
TEST(CutShares, a_narrower_rest_is_cut_by_a_larger_share) {
  double last = 0.0;
  for (const double width : {100.0, 70.0, 40.0, 20.0}) {
    const PoolVector<double> shares = shares_at(
        cut_of({facing({0, 0, kDepth}, 120, 80), upright_bar((-60.0 + width) * 700.0 / kDepth, 150, 700)}), kDepth);
    ASSERT_EQ(shares.size(), 1U);
    EXPECT_GT(shares[0], last);
    last = shares[0];
  }
}

}  // namespace
}  // namespace foresight
