#include "benchmarks/intervals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace foresight {
namespace {

// Values by the closed formula, computed apart from this code.
TEST(WilsonInterval, has_its_known_values) {
  const Interval paper = wilson_interval(148, 160);
  EXPECT_NEAR(paper.low, 0.873492, 1e-6);
  EXPECT_NEAR(paper.high, 0.956579, 1e-6);
  const Interval half = wilson_interval(5, 10);
  EXPECT_NEAR(half.low, 0.236593, 1e-6);
  EXPECT_NEAR(half.high, 0.763407, 1e-6);
}

TEST(WilsonInterval, of_none_and_all_stays_within_0_and_1) {
  EXPECT_DOUBLE_EQ(wilson_interval(0, 20).low, 0.0);
  EXPECT_NEAR(wilson_interval(0, 20).high, 0.161125, 1e-6);
  EXPECT_DOUBLE_EQ(wilson_interval(20, 20).high, 1.0);
  EXPECT_DOUBLE_EQ(wilson_interval(0, 0).low, 0.0);
  EXPECT_DOUBLE_EQ(wilson_interval(0, 0).high, 1.0);
}

TEST(WilsonInterval, ends_where_the_normal_test_of_the_end_just_rejects) {
  for (const long hits : {1L, 7L, 30L, 59L}) {
    const Interval interval = wilson_interval(hits, 60);
    for (const double end : {interval.low, interval.high}) {
      EXPECT_NEAR(std::abs(static_cast<double>(hits) / 60.0 - end) / std::sqrt(end * (1.0 - end) / 60.0), 1.959964,
                  1e-5);
    }
  }
}

}  // namespace
}  // namespace foresight
