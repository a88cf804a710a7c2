#include "benchmarks/mean_interval.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/random.h"

namespace foresight {
namespace {

TEST(MeanInterval, holds_the_mean_and_is_a_point_for_equal_values) {
  const Mean equal = mean_of({3.0, 3.0, 3.0}, 1);
  EXPECT_EQ(equal.value, 3.0);
  EXPECT_EQ(equal.interval.low, 3.0);
  EXPECT_EQ(equal.interval.high, 3.0);
  const Mean skewed = mean_of({1, 1, 1, 1, 1, 1, 1, 2, 2, 40}, 1);
  EXPECT_NEAR(skewed.value, 5.1, 1e-12);
  EXPECT_LT(skewed.interval.low, 5.1);
  EXPECT_GT(skewed.interval.high, 5.1);
  EXPECT_GE(skewed.interval.low, 1.0);
}

TEST(MeanInterval, is_as_wide_as_the_normal_one_for_many_values) {
  Random random(4);
  std::vector<double> values(400);
  for (double& value : values) value = random.gaussian();
  const Mean mean = mean_of(values, 2);
  EXPECT_NEAR(mean.interval.high - mean.interval.low, 2.0 * 1.96 / 20.0, 0.04);
}

TEST(MeanInterval, is_the_same_for_the_same_seed) {
  const std::vector<double> values = {1, 5, 2, 9, 30};
  EXPECT_EQ(mean_of(values, 7).interval.low, mean_of(values, 7).interval.low);
  EXPECT_EQ(mean_of(values, 7).interval.high, mean_of(values, 7).interval.high);
}

TEST(MeanInterval, is_nothing_over_nothing) {
  const Mean none = mean_of({}, 1);
  EXPECT_TRUE(std::isnan(none.value));
  EXPECT_TRUE(std::isnan(none.interval.low));
}

}  // namespace
}  // namespace foresight
