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

// Points on a line or at one place lie on many planes: any of them will do.
TEST(PlaneFit, finds_some_plane_through_points_that_lie_on_many) {
  Random random(10);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d at(random.uniform(-100, 100), random.uniform(-100, 100), 900);
    const Eigen::Vector3d along = i == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(10.0 * random.direction());
    PointSums sums;
    for (int k = 0; k < 5; ++k) sums.add(at + k * along);
    const Plane plane = sums.fit();
    EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-9);
    EXPECT_NEAR(sums.mean_squared_distance(plane), 0.0, 1e-6);
    EXPECT_NEAR(sums.narrow_spread(), 0.0, 1e-6);
  }
}

TEST(PlaneFit, finds_the_thin_side_of_any_box_of_points) {
  Random random(11);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), random.direction());
    const Eigen::Vector3d half(random.uniform(0.5, 1), random.uniform(1.1, 2), random.uniform(2.1, 100));
    PointSums sums;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign((corner & 1) - 0.5, (corner & 2) / 2 - 0.5, (corner & 4) / 4 - 0.5);
      sums.add(turn * Eigen::Vector3d(2.0 * sign.cwiseProduct(half)) + Eigen::Vector3d(0, 0, 500));
    }
    const Plane plane = sums.fit();
    EXPECT_NEAR(std::abs(plane.normal.dot(turn * Eigen::Vector3d::UnitX())), 1.0, 1e-6);
    EXPECT_NEAR(sums.mean_squared_distance(plane), half.x() * half.x(), 1e-6);
    EXPECT_NEAR(sums.narrow_spread(), half.y() * half.y(), 1e-6);
  }
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
