#include "common/density.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "common/errors.h"
#include "common/random.h"

namespace foresight {
namespace {

std::vector<double> random_samples(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> samples;
  for (int i = 0; i < count; ++i) samples.push_back(random.uniform(0.0, 100.0));
  return samples;
}

double total(const Density& density) { return std::accumulate(density.mass.begin(), density.mass.end(), 0.0); }

TEST(Density, sums_to_one_with_and_without_kernel) {
  for (const double kernel : {0.0, 0.5, 2.0}) {
    EXPECT_NEAR(total(estimate_density(random_samples(320, 1), 0, 100, {24, kernel})), 1.0, 1e-5) << kernel;
  }
}

TEST(Density, raw_histogram_is_the_share_of_samples_in_each_bin) {
  const std::vector<double> samples = {5, 15, 15, 95};
  const Density density = estimate_density(samples, 0, 100, {10, 0.0});
  EXPECT_DOUBLE_EQ(density.probability(7), 0.25);
  EXPECT_DOUBLE_EQ(density.probability(10), 0.5);
  EXPECT_DOUBLE_EQ(density.probability(50), 0.0);
  EXPECT_DOUBLE_EQ(density.probability(99.9), 0.25);
}

TEST(Density, every_sample_has_a_probability_above_zero) {
  const auto samples = random_samples(50, 2);
  for (const double kernel : {0.0, 0.5}) {
    const Density density = estimate_density(samples, 0, *std::max_element(samples.begin(), samples.end()), {24, kernel});
    for (const double sample : samples) EXPECT_GT(density.probability(sample), 0.0);
  }
}

TEST(Density, kernel_reaches_three_standard_deviations_and_no_farther) {
  const std::vector<double> one = {50.0};  // on a bin edge; kernel 0.5 bins of 10: reaches 15 to each side
  const Density density = estimate_density(one, 0, 100, {10, 0.5});
  EXPECT_GT(density.probability(36), 0.0);
  EXPECT_GT(density.probability(64), 0.0);
  EXPECT_EQ(density.probability(29), 0.0);
  EXPECT_EQ(density.probability(71), 0.0);
  EXPECT_NEAR(density.probability(45), density.probability(55), 1e-6);
}

TEST(Density, smoothing_below_the_lower_edge_is_kept) {
  const std::vector<double> one = {0.5};
  const Density density = estimate_density(one, 0, 100, {10, 1.0});
  EXPECT_LT(density.first_bin, 0);
  EXPECT_GT(density.probability(-5), 0.0);
}

TEST(Density, no_probability_for_not_a_number) {
  const Density density = estimate_density(random_samples(10, 3), 0, 100, {24, 0.5});
  EXPECT_EQ(density.probability(std::numeric_limits<double>::quiet_NaN()), 0.0);
  EXPECT_EQ(density.probability(std::numeric_limits<double>::infinity()), 0.0);
}

TEST(Density, at_least_falls_from_one_to_zero) {
  const Density density = estimate_density(random_samples(320, 4), 0, 100, {24, 0.5});
  EXPECT_NEAR(density.probability_at_least(-50), 1.0, 1e-5);
  EXPECT_EQ(density.probability_at_least(150), 0.0);
  double before = 1.0;
  for (double value = -20; value < 130; value += 1.5) {
    EXPECT_LE(density.probability_at_least(value), before + 1e-9);
    before = density.probability_at_least(value);
  }
}

TEST(Density, does_not_depend_on_the_order_of_samples) {
  auto samples = random_samples(100, 5);
  const Density forward = estimate_density(samples, 0, 100, {24, 0.0});
  std::reverse(samples.begin(), samples.end());
  EXPECT_EQ(forward.mass, estimate_density(samples, 0, 100, {24, 0.0}).mass);
}

TEST(Density, options_outside_their_limits_are_refused) {
  EXPECT_NO_THROW(check(DensityOptions{}));
  EXPECT_THROW(check(DensityOptions{1, 0.5}), UsageError);
  EXPECT_THROW(check(DensityOptions{24, -1.0}), UsageError);
  EXPECT_THROW(check(DensityOptions{24, std::nan("")}), UsageError);
}

}  // namespace
}  // namespace foresight
