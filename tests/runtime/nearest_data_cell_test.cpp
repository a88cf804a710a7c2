#include "runtime/nearest_data_cell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/random.h"
#include "tests/runtime/box_scene.h"

namespace foresight {
namespace {

// Depths that jump from cell to cell, half of the cells holes, each point within `off` cells of its ray.
RangeImage rough_image(const PinholeCamera& camera, Random& random, double off) {
  RangeImage image(camera.rows, camera.columns);
  for (int row = 0; row < camera.rows; ++row) {
    for (int column = 0; column < camera.columns; ++column) {
      if (random.uniform() < 0.5) continue;
      const double depth = random.uniform() < 0.8 ? 700.0 + 20.0 * std::sin(0.1 * row) : random.uniform(600.0, 800.0);
      const Eigen::Vector3d ray = camera.ray(row + random.uniform(-off, off), column + random.uniform(-off, off));
      image[image.cell(row, column)] = (depth * ray).cast<float>();
    }
  }
  return image;
}

Eigen::Vector3f random_query(const PinholeCamera& camera, Random& random) {
  const double beyond = 15.0;  // cells
  return (random.uniform(640.0, 760.0) *
          camera.ray(random.uniform(-beyond, camera.rows + beyond), random.uniform(-beyond, camera.columns + beyond)))
      .cast<float>();
}

float brute_force_distance(const RangeImage& image, const Eigen::Vector3f& query) {
  float least = std::numeric_limits<float>::infinity();
  for (int cell = 0; cell < image.size(); ++cell) {
    if (image.valid(cell)) least = std::min(least, (image[cell] - query).norm());
  }
  return least;
}

// The paper's camera, and one with a wide field of view off its middle.
const std::vector<PinholeCamera>& cameras() {
  static const std::vector<PinholeCamera> all = {{60, 64, 190.0, 190.0, 31.5, 29.5}, {48, 40, 25.0, 30.0, 33.0, 8.0}};
  return all;
}

TEST(NearestDataCell, equals_brute_force) {
  Random random(1);
  int found = 0;
  int nothing = 0;
  for (const PinholeCamera& camera : cameras()) {
    for (const double off : {0.0, 0.49}) {
      const RangeImage image = rough_image(camera, random, off);
      const NearestDataCell data(image, camera);
      for (int i = 0; i < 1500; ++i) {
        const Eigen::Vector3f query = random_query(camera, random);
        const auto reach = static_cast<float>(random.uniform(1.0, 60.0));
        const float expected = brute_force_distance(image, query);
        const NearestData::Answer answer = data.find_within(query, reach);
        if (expected < reach) {
          ++found;
          ASSERT_GE(answer.index, 0);
          EXPECT_FLOAT_EQ(answer.distance, expected);
          EXPECT_EQ(answer.point, image[answer.cell]);
        } else {
          ++nothing;
          EXPECT_EQ(answer.index, -1);
          EXPECT_EQ(answer.distance, reach);
          EXPECT_EQ(answer.point, query);
        }
        if (i % 10 == 0) {
          EXPECT_FLOAT_EQ(data.find(query).distance, expected);
        }
      }
    }
  }
  EXPECT_GT(found, 500);
  EXPECT_GT(nothing, 500);
}

TEST(NearestDataCell, a_guess_changes_nothing_but_the_cost) {
  Random random(2);
  const PinholeCamera& camera = cameras()[0];
  const RangeImage image = rough_image(camera, random, 0.0);
  const NearestDataCell data(image, camera);
  for (int i = 0; i < 500; ++i) {
    const int guess = random.integer(0, image.size() - 1);
    if (!image.valid(guess)) continue;
    const Eigen::Vector3f query = random_query(camera, random);
    EXPECT_EQ(data.find_within(query, 20.0F, guess).distance, data.find_within(query, 20.0F).distance);
    EXPECT_EQ(data.find(query, guess).distance, data.find(query).distance);
  }
  const int valid = data.find(Eigen::Vector3f(0, 0, 700)).cell;
  EXPECT_EQ(data.find_within(image[valid], 20.0F, valid).cell, valid);
}

TEST(NearestDataCell, finds_every_data_point_at_distance_zero) {
  Random random(3);
  const PinholeCamera& camera = cameras()[1];
  const RangeImage image = rough_image(camera, random, 0.3);
  const NearestDataCell data(image, camera);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (!image.valid(cell)) continue;
    EXPECT_EQ(data.find_within(image[cell], 5.0F).cell, cell);
    EXPECT_EQ(data.find(image[cell]).distance, 0.0F);
  }
}

TEST(NearestDataCell, with_a_stride_it_is_the_nearest_of_every_so_many_cells) {
  Random random(4);
  for (const PinholeCamera& camera : cameras()) {
    const RangeImage image = rough_image(camera, random, 0.3);
    RangeImage few = image;
    for (int cell = 0; cell < image.size(); ++cell) {
      const bool takes_part = cell / image.columns % 3 == 0 && cell % image.columns % 3 == 0;
      if (!takes_part) few[cell] = RangeImage(1, 1)[0];
    }
    const NearestDataCell data(image, camera, 3);
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3f query = random_query(camera, random);
      const NearestData::Answer answer = data.find(query);
      EXPECT_FLOAT_EQ(answer.distance, brute_force_distance(few, query));
      EXPECT_EQ(answer.point, few[answer.cell]);
    }
  }
}

TEST(NearestDataCell, finds_nothing_behind_the_camera_or_without_data) {
  const PinholeCamera camera;
  const RangeImage box = test::box_image(test::box_pose(), camera);
  const NearestDataCell data(box, camera);
  EXPECT_EQ(data.find_within({0.0F, 0.0F, -700.0F}, 12.0F).index, -1);
  EXPECT_EQ(data.find_within({0.0F, 0.0F, 0.0F}, 12.0F).index, -1);
  const RangeImage empty(camera.rows, camera.columns);
  EXPECT_EQ(NearestDataCell(empty, camera).find({0.0F, 0.0F, 700.0F}).index, -1);
}

}  // namespace
}  // namespace foresight
