#include "runtime/nearest_data_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <thread>
#include <utility>
#include <vector>

#include "common/random.h"

namespace foresight {
namespace {

Eigen::Vector3f random_point(Random& random, double reach) {
  return Eigen::Vector3d(random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(600.0, 900.0))
      .cast<float>();
}

// An image in which about half of the cells are holes.
RangeImage random_image(Random& random, int rows, int columns) {
  RangeImage image(rows, columns);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (random.uniform() < 0.5) image[cell] = random_point(random, 100.0);
  }
  if (count_valid(image) == 0) image[0] = random_point(random, 100.0);
  return image;
}

float brute_force_distance(const RangeImage& image, const Eigen::Vector3f& query) {
  float least = std::numeric_limits<float>::infinity();
  for (int cell = 0; cell < image.size(); ++cell) {
    if (image.valid(cell)) least = std::min(least, (image[cell] - query).norm());
  }
  return least;
}

TEST(NearestDataPoint, equals_brute_force_on_random_images) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const RangeImage image = random_image(random, random.integer(1, 40), random.integer(1, 40));
    const NearestDataPoint data(image);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3f query = random_point(random, 150.0);
      EXPECT_FLOAT_EQ(data.find(query).distance, brute_force_distance(image, query));
    }
  }
}

TEST(NearestDataPoint, answers_with_a_cell_its_point_and_its_distance) {
  Random random(2);
  const RangeImage image = random_image(random, 30, 30);
  const NearestDataPoint data(image);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f query = random_point(random, 150.0);
    const NearestDataPoint::Answer answer = data.find(query);
    ASSERT_TRUE(image.valid(answer.cell));
    EXPECT_EQ(answer.point, image[answer.cell]);
    EXPECT_FLOAT_EQ(answer.distance, (answer.point - query).norm());
  }
}

TEST(NearestDataPoint, finds_every_data_point_at_distance_zero) {
  Random random(3);
  const RangeImage image = random_image(random, 40, 40);
  const NearestDataPoint data(image);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (!image.valid(cell)) continue;
    EXPECT_EQ(data.find(image[cell]).cell, cell);
    EXPECT_EQ(data.find(image[cell]).distance, 0.0F);
  }
}

TEST(NearestDataPoint, needs_no_more_than_one_valid_cell) {
  RangeImage image(32, 32);
  image[77] = Eigen::Vector3f(1.0F, 2.0F, 500.0F);
  EXPECT_EQ(NearestDataPoint(image).find({900.0F, -900.0F, 10.0F}).cell, 77);
}

TEST(NearestDataPoint, bears_many_equal_points) {
  RangeImage image(32, 32);
  for (Eigen::Vector3f& point : image.points) point = Eigen::Vector3f(1.0F, 2.0F, 500.0F);
  EXPECT_FLOAT_EQ(NearestDataPoint(image).find({1.0F, 2.0F, 503.0F}).distance, 3.0F);
}

TEST(NearestDataPoint, outlives_its_image_and_a_move) {
  Random random(4);
  const Eigen::Vector3f query(0.0F, 0.0F, 700.0F);
  RangeImage image = random_image(random, 40, 40);
  const float expected = brute_force_distance(image, query);
  NearestDataPoint first(image);
  image = RangeImage();
  const NearestDataPoint second(std::move(first));
  EXPECT_FLOAT_EQ(second.find(query).distance, expected);
}

TEST(NearestDataPoint, answers_the_same_from_several_threads) {
  Random random(5);
  const NearestDataPoint data(random_image(random, 60, 60));
  std::vector<Eigen::Vector3f> queries(2000);
  for (Eigen::Vector3f& query : queries) query = random_point(random, 150.0);
  std::vector<std::vector<int>> answers(3);
  std::vector<std::thread> threads;
  for (std::vector<int>& answer : answers) {
    threads.emplace_back([&answer, &queries, &data] {
      for (const Eigen::Vector3f& query : queries) answer.push_back(data.find(query).cell);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(answers[0], answers[1]);
  EXPECT_EQ(answers[0], answers[2]);
}

TEST(NearestDataPoint, within_reach_it_is_the_nearest_of_all) {
  Random random(6);
  int near = 0;
  int far = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const RangeImage image = random_image(random, random.integer(1, 30), random.integer(1, 30));
    const NearestDataPoint data(image);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3f query = random_point(random, 150.0);
      const NearestDataPoint::Answer nearest = data.find(query);
      for (const float reach : {0.9F * nearest.distance, 1.1F * nearest.distance, 500.0F}) {
        const NearestDataPoint::Answer answer = data.find_within(query, reach);
        if (reach > nearest.distance) {
          EXPECT_EQ(answer.index, nearest.index);
          EXPECT_EQ(answer.cell, nearest.cell);
          EXPECT_EQ(answer.point, nearest.point);
          EXPECT_EQ(answer.distance, nearest.distance);
          ++near;
        } else {
          EXPECT_EQ(answer.index, -1);
          EXPECT_EQ(answer.point, query);
          EXPECT_FLOAT_EQ(answer.distance, reach);
          ++far;
        }
      }
    }
  }
  EXPECT_GT(near, 1000);
  EXPECT_GE(far, 1000);
}

TEST(NearestDataPoint, a_guess_changes_no_answer_within_reach) {
  Random random(7);
  const RangeImage image = random_image(random, 40, 40);
  const NearestDataPoint data(image);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3f query = random_point(random, 150.0);
    const Eigen::Vector3f other = query + 20.0F * random.direction().cast<float>();
    const int guess = i % 3 == 0 ? data.find(random_point(random, 150.0)).index : data.find(other).index;
    EXPECT_EQ(data.find(query, guess).distance, data.find(query).distance);
    for (const float reach : {5.0F, 15.0F, 60.0F}) {
      const NearestDataPoint::Answer plain = data.find_within(query, reach);
      const NearestDataPoint::Answer guessed = data.find_within(query, reach, guess);
      EXPECT_EQ(guessed.distance, plain.distance);
      EXPECT_EQ(guessed.index < 0, plain.index < 0);
    }
  }
}

}  // namespace
}  // namespace foresight
