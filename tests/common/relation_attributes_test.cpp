#include "common/relation_attributes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/images.h"

namespace foresight {
namespace {

PoolVector<DescribedRegion> regions_of(const std::vector<test::Rectangle>& rectangles) {
  const SensorModel sensor;
  return extract_regions(test::render(rectangles, sensor.camera), sensor.camera, segmentation_options_for(sensor));
}

std::vector<test::Rectangle> box(const Pose& pose) {
  std::vector<test::Rectangle> sides;
  for (const auto& side : test::box_sides({100, 80, 60})) sides.push_back(moved(side, pose));
  return sides;
}

Pose corner_pose(const Eigen::Vector3d& translation) {
  return {rotation_from_vector({0.6, 0, 0}) * rotation_from_vector({0, 0.75, 0}), translation};
}

TEST(RelationAttributes, sides_of_a_box_meet_at_right_angles) {
  const auto regions = regions_of(box(corner_pose({0, 0, 900})));
  ASSERT_EQ(regions.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_NEAR(relate(regions[i], regions[j])[kOrientation], std::numbers::pi / 2, 0.01);
  }
}

TEST(RelationAttributes, are_symmetric) {
  const auto regions = regions_of(box(corner_pose({0, 0, 900})));
  ASSERT_GE(regions.size(), 2U);
  EXPECT_EQ(relate(regions[0], regions[1]), relate(regions[1], regions[0]));
}

TEST(RelationAttributes, distance_is_at_least_either_diameter_of_touching_patches_and_at_most_their_sum) {
  const auto regions = regions_of(box(corner_pose({0, 0, 900})));
  for (std::size_t i = 1; i < regions.size(); ++i) {
    const double distance = relate(regions[0], regions[i])[kMaxDistance];
    EXPECT_GE(distance, regions[i].attributes[kMaxDiameter] - 5.0);
    EXPECT_LE(distance, regions[0].attributes[kMaxDiameter] + regions[i].attributes[kMaxDiameter] + 5.0);
  }
}

TEST(RelationAttributes, of_two_facing_squares_are_known) {
  const auto regions = regions_of({test::facing({-40, 0, 900}, 40, 40), test::facing({40, 0, 900}, 40, 40)});
  ASSERT_EQ(regions.size(), 2U);
  const RelationVector relation = relate(regions[0], regions[1]);
  EXPECT_NEAR(relation[kOrientation], 0.0, 1e-3);
  EXPECT_NEAR(relation[kMaxDistance], std::hypot(120.0, 40.0), 3.0);
}

TEST(RelationAttributes, do_not_change_when_the_object_moves) {
  const auto here = regions_of(box(corner_pose({0, 0, 900})));
  const auto there = regions_of(box(corner_pose({25, -15, 940})));
  ASSERT_EQ(here.size(), 3U);
  ASSERT_EQ(there.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NEAR(relate(here[i], here[j])[kOrientation], relate(there[i], there[j])[kOrientation], 0.01);
      EXPECT_NEAR(relate(here[i], here[j])[kMaxDistance], relate(there[i], there[j])[kMaxDistance], 4.0);
    }
  }
}

}  // namespace
}  // namespace foresight
