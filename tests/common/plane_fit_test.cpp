#include "common/plane_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/random.h"

namespace foresight {
namespace {

PointSums sums_on_plane(const Eigen::Vector3d& normal, double offset, double noise, Random random, int count = 200) {
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  PointSums sums;
  for (int i = 0; i < count; ++i) {
    sums.add(offset * normal + random.uniform(-30, 30) * u + random.uniform(-30, 30) * v +
             noise * random.gaussian() * normal);
  }
  return sums;
}

TEST(PlaneFit, finds_the_plane_of_exact_points_for_any_orientation) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    Eigen::Vector3d normal = random.direction();
    const Plane plane = sums_on_plane(normal, -900, 0.0, Random(2, static_cast<std::uint64_t>(i))).fit();
    EXPECT_NEAR(plane.normal.dot(normal), 1.0, 1e-9);
    EXPECT_NEAR(plane.offset, -900, 1e-3);
  }
}

TEST(PlaneFit, turns_the_normal_towards_the_sensor) {
  const Plane plane = sums_on_plane(Eigen::Vector3d::UnitZ(), 900, 0.1, Random(3)).fit();
  EXPECT_LT(plane.normal.z(), 0.0);
  EXPECT_LT(plane.offset, 0.0);
}

TEST(PlaneFit, mean_squared_distance_is_that_of_the_noise) {
  const PointSums sums = sums_on_plane(Random(4).direction(), -700, 0.5, Random(5), 20000);
  EXPECT_NEAR(std::sqrt(sums.mean_squared_distance(sums.fit())), 0.5, 0.02);
}

TEST(PlaneFit, is_least_among_neighbouring_planes) {
  const PointSums sums = sums_on_plane(Eigen::Vector3d(0.2, 0.3, -0.9).normalized(), -500, 1.0, Random(6));
  const Plane best = sums.fit();
  Random random(7);
  for (int i = 0; i < 50; ++i) {
    Plane other = best;
    other.normal = (other.normal + 0.01 * random.direction()).normalized();
    other.offset += random.uniform(-0.5, 0.5);
    EXPECT_GE(sums.mean_squared_distance(other), sums.mean_squared_distance(best) - 1e-9);
  }
}

TEST(PlaneFit, sums_of_two_parts_are_the_sums_of_the_whole) {
  PointSums a = sums_on_plane(Eigen::Vector3d::UnitX(), -600, 1.0, Random(8));
  const PointSums b = sums_on_plane(Eigen::Vector3d::UnitX(), -600, 1.0, Random(9));
  const double before = a.count();
  a.add(b);
  EXPECT_EQ(a.count(), before + b.count());
  EXPECT_NEAR(a.fit().offset, -600, 0.5);
}

TEST(PlaneFit, removed_points_are_as_if_never_added) {
  PointSums sums = sums_on_plane(Eigen::Vector3d::UnitX(), -600, 1.0, Random(8));
  const double before = sums.mean_squared_distance(sums.fit());
  sums.add({-300, 20, 30});
  EXPECT_GT(sums.mean_squared_distance(sums.fit()), 2.0 * before);
  sums.remove({-300, 20, 30});
  EXPECT_NEAR(sums.mean_squared_distance(sums.fit()), before, 1e-6);
}

TEST(PlaneFit, narrow_spread_is_that_of_the_narrow_side) {
  PointSums sums;
  for (int i = 0; i < 100; ++i) {
    for (const double y : {-1.0, 1.0}) sums.add({static_cast<double>(i), y, -500.0});
  }
  EXPECT_NEAR(sums.narrow_spread(), 1.0, 1e-6);
}

}  // namespace
}  // namespace foresight
