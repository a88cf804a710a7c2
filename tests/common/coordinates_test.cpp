#include "common/coordinates.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "common/random.h"

namespace foresight {
namespace {

// Points of a plane with noise, some cells without data.
RangeImage noisy_plane(const Plane& plane, double noise, Random random) {
  RangeImage image(32, 37);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (random.uniform(0, 1) < 0.1) continue;
    const Eigen::Vector3d u = plane.normal.unitOrthogonal();
    const Eigen::Vector3d point = plane.offset * plane.normal + random.uniform(-300, 300) * u +
                                  random.uniform(-300, 300) * plane.normal.cross(u) +
                                  noise * random.gaussian() * plane.normal;
    image[cell] = point.cast<float>();
  }
  return image;
}

TEST(Coordinates, are_those_of_the_image) {
  const RangeImage image = noisy_plane({{0, 0.6, -0.8}, -900}, 1.0, Random(1));
  const Coordinates points(image);
  ASSERT_EQ(points.size(), image.size());
  float largest = 0.0F;
  for (int cell = 0; cell < image.size(); ++cell) {
    ASSERT_EQ(points.valid(cell), image.valid(cell));
    if (!image.valid(cell)) continue;
    EXPECT_EQ(points[cell], image[cell].cast<double>());
    largest = std::max(largest, image[cell].cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(points.largest, largest);
}

TEST(Coordinates, blocks_without_any_data_are_told_from_others) {
  RangeImage image(2, kBlock);
  image[kBlock + 5] = {1, 2, 3};
  const Coordinates points(image);
  EXPECT_FALSE(points.any_valid(0));
  EXPECT_TRUE(points.any_valid(kBlock));
}

TEST(ReachTest, holds_for_cells_within_reach) {
  const Plane plane{{0, 0, -1}, -900};
  RangeImage image(1, 2);
  image[0] = {10, 10, 900.5F};
  image[1] = {10, 10, 901.5F};
  const Coordinates points(image);
  const ReachTest test(points, plane, 1.0);
  EXPECT_TRUE(test.holds(0));
  EXPECT_FALSE(test.holds(1));
}

// Single precision decides about blocks; it must never take in a cell that double precision leaves out.
TEST(ReachTest, holds_for_a_block_only_when_it_holds_for_each_of_its_cells) {
  Random random(2);
  int held = 0, blocks = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Plane plane{random.direction(), -random.uniform(300, 3000)};
    RangeImage image = noisy_plane(plane, 0.1, Random(3, i));
    for (int cell = 0; cell < image.size(); ++cell) {
      if (!image.valid(cell)) image[cell] = (plane.offset * plane.normal).cast<float>();
    }
    const Coordinates points(image);
    for (const double reach : {0.1, 0.2, 0.3}) {
      const ReachTest test(points, plane, reach);
      for (int first = 0; first + kBlock <= image.size(); first += kBlock) {
        ++blocks;
        if (!test.holds_for_block(first)) continue;
        ++held;
        for (int k = first; k < first + kBlock; ++k) ASSERT_TRUE(test.holds(k)) << i;
      }
    }
  }
  EXPECT_GT(held, blocks / 4);  // else the law above says little
  EXPECT_LT(held, blocks);
}

}  // namespace
}  // namespace foresight
