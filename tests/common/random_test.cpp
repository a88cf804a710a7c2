#include "common/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "common/pose.h"

namespace foresight {
namespace {

constexpr int kDraws = 20000;
constexpr double kSigmas = 5.0;

TEST(Random, is_splitmix64) {
  // The first numbers of the published generator from state 0.
  Random random(0);
  EXPECT_EQ(random.next(), 0xE220A8397B1DCDAFULL);
  EXPECT_EQ(random.next(), 0x6E789E6AA1B965F4ULL);
  EXPECT_EQ(random.next(), 0x06C45D188009454FULL);
}

TEST(Random, same_seed_gives_the_same_numbers) {
  Random a(42, 7);
  Random b(42, 7);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next(), b.next());
}

TEST(Random, copy_continues_like_the_original) {
  Random a(42);
  EXPECT_NE(a.next(), a.next());
  Random b = a;
  EXPECT_EQ(a.next(), b.next());
}

TEST(Random, streams_of_neighbouring_seeds_and_indices_differ) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (std::uint64_t index = 0; index < 100; ++index) first.insert(Random(seed, index).next());
  }
  EXPECT_EQ(first.size(), 10000U);
}

TEST(Random, streams_are_uncorrelated) {
  for (const auto& [seed, index] : {std::pair{1, 1}, std::pair{2, 0}, std::pair{0, 1}}) {
    Random a(1, 0);
    Random b(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(index));
    double sum = 0.0;
    for (int i = 0; i < kDraws; ++i) sum += (a.uniform() - 0.5) * (b.uniform() - 0.5);
    EXPECT_LT(std::abs(sum / kDraws), kSigmas / 12.0 / std::sqrt(kDraws)) << seed << " " << index;
  }
  // Also across streams: the first draws of the streams 0, 1, 2, ... look like one sequence of draws.
  double mean = 0.0;
  for (std::uint64_t i = 0; i < kDraws; ++i) mean += Random(3, i).uniform() / kDraws;
  EXPECT_NEAR(mean, 0.5, kSigmas / std::sqrt(12.0 * kDraws));
}

TEST(Random, uniform_stays_in_its_range_with_its_mean_and_variance) {
  Random random(1);
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.uniform(-2.0, 4.0);
    ASSERT_GE(x, -2.0);
    ASSERT_LT(x, 4.0);
    sum += x;
    squares += (x - 1.0) * (x - 1.0);
  }
  EXPECT_NEAR(sum / kDraws, 1.0, kSigmas * std::sqrt(3.0 / kDraws));
  EXPECT_NEAR(squares / kDraws, 3.0, kSigmas * std::sqrt((81.0 / 5.0 - 9.0) / kDraws));
}

TEST(Random, integer_reaches_both_ends_and_no_further_equally_often) {
  Random random(2);
  std::array<int, 7> counts{};
  for (int i = 0; i < kDraws; ++i) {
    const int x = random.integer(-3, 3);
    ASSERT_GE(x, -3);
    ASSERT_LE(x, 3);
    ++counts[static_cast<std::size_t>(x + 3)];
  }
  for (const int count : counts) EXPECT_NEAR(count, kDraws / 7.0, kSigmas * std::sqrt(kDraws * 6.0 / 49.0));
  EXPECT_EQ(random.integer(5, 5), 5);
}

TEST(Random, gaussian_has_the_moments_of_the_normal_distribution) {
  Random random(3);
  std::array<double, 5> moments{};
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.gaussian();
    ASSERT_TRUE(std::isfinite(x));
    for (std::size_t k = 1; k < 5; ++k) moments[k] += std::pow(x, static_cast<double>(k)) / kDraws;
  }
  EXPECT_NEAR(moments[1], 0.0, kSigmas / std::sqrt(kDraws));
  EXPECT_NEAR(moments[2], 1.0, kSigmas * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(moments[3], 0.0, kSigmas * std::sqrt(15.0 / kDraws));
  EXPECT_NEAR(moments[4], 3.0, kSigmas * std::sqrt(96.0 / kDraws));
}

TEST(Random, direction_is_uniform_on_the_sphere) {
  Random random(4);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector3d direction = random.direction();
    ASSERT_NEAR(direction.norm(), 1.0, 1e-14);
    mean += direction / kDraws;
    second += direction * direction.transpose() / kDraws;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), kSigmas / std::sqrt(3.0 * kDraws));
  EXPECT_LT((second - Eigen::Matrix3d::Identity() / 3.0).cwiseAbs().maxCoeff(), kSigmas * 0.3 / std::sqrt(kDraws));
}

TEST(Random, rotation_is_uniform_over_all_rotations) {
  Random random(5);
  const Eigen::Matrix3d fixed = rotation_from_vector({0.4, -1.0, 2.0});
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  double traces = 0.0;
  double turned_traces = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Matrix3d rotation = random.rotation();
    ASSERT_TRUE(is_rotation(rotation, 1e-13));
    mean += rotation / kDraws;
    // Under the uniform measure E[trace^2] = 1, and so it is after any fixed rotation.
    traces += rotation.trace() * rotation.trace() / kDraws;
    const double turned = (fixed * rotation).trace();
    turned_traces += turned * turned / kDraws;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), kSigmas / std::sqrt(3.0 * kDraws));
  // trace is 1 + 2 cos(angle): E[trace^4] = 3, so trace^2 has variance 2.
  EXPECT_NEAR(traces, 1.0, kSigmas * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(turned_traces, 1.0, kSigmas * std::sqrt(2.0 / kDraws));
}

}  // namespace
}  // namespace foresight
