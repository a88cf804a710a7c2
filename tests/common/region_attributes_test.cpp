#include "common/region_attributes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/images.h"

namespace foresight {
namespace {

using test::facing;
using test::Rectangle;
using test::render;

DescribedRegion only_region(const std::vector<Rectangle>& rectangles, const SensorModel& sensor = {}) {
  const auto regions =
      extract_regions(render(rectangles, sensor.camera), sensor.camera, segmentation_options_for(sensor));
  EXPECT_EQ(regions.size(), 1U);
  return regions.at(0);
}

TEST(RegionAttributes, of_a_rectangle_are_those_of_geometry) {
  const DescribedRegion region = only_region({facing({0, 0, 900}, 120, 60)});
  EXPECT_NEAR(region.attributes[kArea], 7200, 0.03 * 7200);
  EXPECT_NEAR(region.attributes[kMaxSecondMoment], 120 / std::sqrt(12.0),
              1.0);  // standard deviation of a uniform interval
  EXPECT_NEAR(region.attributes[kMinSecondMoment], 60 / std::sqrt(12.0), 1.0);
  EXPECT_NEAR(region.attributes[kMaxDiameter], std::hypot(120, 60), 3.0);
  EXPECT_NEAR(std::abs(region.major_axis.x()), 1.0, 1e-3);
}

TEST(RegionAttributes, do_not_change_under_a_rigid_motion) {
  const Rectangle flat = facing({0, 0, 0}, 110, 70);
  const AttributeVector reference =
      only_region({moved(flat, Pose{Eigen::Matrix3d::Identity(), {0, 0, 900}})}).attributes;
  Random random(11);
  for (int i = 0; i < 20; ++i) {
    Pose pose;
    pose.rotation = rotation_from_vector({random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), random.uniform(-3, 3)});
    pose.translation = {random.uniform(-25, 25), random.uniform(-25, 25), random.uniform(850, 950)};
    const AttributeVector attributes = only_region({moved(flat, pose)}).attributes;
    for (std::size_t k = 0; k < kAttributeCount; ++k) {
      EXPECT_NEAR(attributes[k], reference[k], 0.06 * reference[k]) << kAttributeNames[k] << " in pose " << i;
    }
  }
}

TEST(RegionAttributes, centroid_and_hull_lie_on_the_plane) {
  Pose pose;
  pose.rotation = rotation_from_vector({0.5, 0.3, 0.2});
  pose.translation = {10, 20, 900};
  const DescribedRegion region = only_region({moved(facing({0, 0, 0}, 100, 80), pose)});
  EXPECT_LT((region.centroid - pose.translation).norm(), 1.5);
  ASSERT_GE(region.hull.size(), 4U);
  for (const Eigen::Vector3d& corner : region.hull)
    EXPECT_NEAR(region.region.normal.dot(corner), region.region.offset, 1e-6);
}

// Cells in any places, on planes that face the camera and on some that it sees at a grazing angle.
TEST(RegionAttributes, hull_holds_every_cell_of_the_region) {
  const PinholeCamera camera{64, 64, 80.0, 80.0, 31.5, 31.5};
  Random random(12);
  for (int i = 0; i < 40; ++i) {
    Region region;
    region.normal = i % 4 == 0 ? Eigen::Vector3d(0.99, 0, -std::sqrt(1 - 0.99 * 0.99))
                               : Eigen::Vector3d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -1).normalized();
    region.offset = -700;
    RangeImage image(camera.rows, camera.columns);
    std::vector<Eigen::Vector3d> points;
    const int row = random.integer(0, 40), column = random.integer(0, 40);
    for (int cell = image.cell(row, 0); cell < image.cell(row + 20, 0); ++cell) {
      if (cell % 64 < column || cell % 64 > column + 20 || random.uniform(0, 1) < 0.3) continue;
      const Eigen::Vector3d ray = camera.ray(cell / 64, cell % 64);
      const double slope = -region.normal.dot(ray);
      if (slope < 1e-3) continue;  // the plane is not in sight there
      points.push_back((-region.offset / slope) * ray);
      image[cell] = points.back().cast<float>();
      region.cells.push_back(cell);
    }
    if (region.cells.size() < 12) continue;
    const DescribedRegion described = describe(region, image, camera);
    const double slack = 1e-6 * described.attributes[kArea] + 1e-2 * described.attributes[kMaxDiameter];
    for (std::size_t k = 0; k < described.hull.size(); ++k) {
      const Eigen::Vector3d& corner = described.hull[k];
      const Eigen::Vector3d side = described.hull[(k + 1) % described.hull.size()] - corner;
      for (const Eigen::Vector3d& point : points)
        EXPECT_GT(side.cross(point - corner).dot(region.normal), -slack) << "region " << i;
    }
  }
}

TEST(RegionAttributes, hull_turns_counter_clockwise_about_the_normal) {
  const DescribedRegion region = only_region({facing({0, 0, 900}, 100, 80)});
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < region.hull.size(); ++i) {
    turned += (region.hull[i] - region.centroid).cross(region.hull[(i + 1) % region.hull.size()] - region.centroid);
  }
  EXPECT_GT(turned.dot(region.region.normal), 0.0);
  EXPECT_NEAR(0.5 * turned.norm(), 8000, 0.05 * 8000);
}

TEST(RegionAttributes, max_diameter_is_at_least_twice_the_max_second_moment) {
  // The standard deviation of anything within an interval is at most half its length.
  Random random(5);
  for (int i = 0; i < 10; ++i) {
    const DescribedRegion region = only_region({facing({0, 0, 900}, random.uniform(20, 150), random.uniform(20, 150))});
    EXPECT_GE(region.attributes[kMaxDiameter], 2 * region.attributes[kMaxSecondMoment]);
    EXPECT_GE(region.attributes[kMaxSecondMoment], region.attributes[kMinSecondMoment]);
  }
}

}  // namespace
}  // namespace foresight
