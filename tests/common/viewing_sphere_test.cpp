#include "common/viewing_sphere.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/errors.h"
#include "common/random.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

TEST(ViewingSphere, has_as_many_cells_as_asked) {
  for (const int cells : {20, 80, 320, 1280, 5120, 20480}) EXPECT_EQ(ViewingSphere(cells).size(), cells);
}

TEST(ViewingSphere, refuses_other_numbers_of_cells) {
  for (const int cells : {-20, 0, 1, 19, 21, 60, 81, 319, 321, 81920}) {
    EXPECT_THROW(ViewingSphere sphere(cells), UsageError) << cells;
  }
}

TEST(ViewingSphere, centres_have_unit_length_and_lie_in_their_own_cells) {
  for (const int cells : {20, 80, 320, 1280}) {
    const ViewingSphere sphere(cells);
    for (int i = 0; i < cells; ++i) {
      EXPECT_NEAR(sphere.centre(i).norm(), 1.0, 1e-12);
      EXPECT_EQ(sphere.cell_of(sphere.centre(i)), i);
      EXPECT_EQ(sphere.cell_of(1e3 * sphere.centre(i)), i) << "the length of a direction must not matter";
    }
  }
}

TEST(ViewingSphere, centres_balance_and_have_their_opposites) {
  const ViewingSphere sphere(320);
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < sphere.size(); ++i) {
    sum += sphere.centre(i);
    const int opposite = sphere.cell_of(-sphere.centre(i));
    EXPECT_NEAR((sphere.centre(opposite) + sphere.centre(i)).norm(), 0.0, 1e-9);
  }
  EXPECT_NEAR(sum.norm(), 0.0, 1e-9);
}

TEST(ViewingSphere, cells_lie_in_the_cell_of_the_coarser_level) {
  const ViewingSphere coarse(80), fine(320);
  for (int i = 0; i < fine.size(); ++i) EXPECT_EQ(coarse.cell_of(fine.centre(i)), i / 4);
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d direction = random.direction();
    EXPECT_EQ(coarse.cell_of(direction), fine.cell_of(direction) / 4);
  }
}

TEST(ViewingSphere, cells_are_of_similar_size) {
  const ViewingSphere sphere(80);
  std::vector<int> hits(80, 0);
  Random random(11);
  for (int i = 0; i < 80 * 2000; ++i) ++hits[static_cast<std::size_t>(sphere.cell_of(random.direction()))];
  const auto [least, most] = std::minmax_element(hits.begin(), hits.end());
  EXPECT_GT(*least, 1500);  // an even share is 2000
  EXPECT_LT(*most, 2500);
}

TEST(ViewingSphere, finds_a_cell_whose_centre_is_about_the_nearest) {
  for (const int cells : {20, 80, 320}) {
    const ViewingSphere sphere(cells);
    const double cell_size = std::sqrt(4.0 * std::numbers::pi / cells);
    Random random(static_cast<std::uint64_t>(cells));
    int nearest_hits = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vector3d direction = random.direction();
      int nearest = 0;
      for (int c = 1; c < cells; ++c) {
        if (sphere.centre(c).dot(direction) > sphere.centre(nearest).dot(direction)) nearest = c;
      }
      const int found = sphere.cell_of(direction);
      nearest_hits += found == nearest ? 1 : 0;
      EXPECT_LT(angle_between(sphere.centre(found), direction), cell_size);
      EXPECT_LT(angle_between(sphere.centre(found), direction) - angle_between(sphere.centre(nearest), direction),
                0.25 * cell_size);
    }
    EXPECT_GT(nearest_hits, 900) << cells;  // triangles are not quite the Voronoi cells of their centres
  }
}

TEST(ViewingSphere, edges_belong_to_one_cell_only) {
  const ViewingSphere sphere(20);
  for (int i = 0; i < 20; ++i) {
    for (int j = i + 1; j < 20; ++j) {
      const double apart = angle_between(sphere.centre(i), sphere.centre(j));
      if (apart > 0.8) continue;  // neighbours are 0.73 rad apart, and meet in the middle between their centres
      EXPECT_EQ(sphere.cell_of(sphere.centre(i) + sphere.centre(j)), i) << "the lower index wins";
    }
  }
}

}  // namespace
}  // namespace foresight
