// How sure a measured mean is.
#pragma once

#include <cstdint>
#include <vector>

#include "benchmarks/intervals.h"

namespace foresight {

struct Mean {
  double value = 0.0;   // NaN over nothing
  Interval interval{};  // 95 %
};

// The mean with the 2.5 % and 97.5 % quantiles of the means of 1000 samples drawn from the values with replacement (the
// percentile bootstrap; Efron and Tibshirani, "An Introduction to the Bootstrap", 1993): counts of tests are too skewed
// for a normal interval. Same values and seed, same interval.
[[nodiscard]] Mean mean_of(const std::vector<double>& values, std::uint64_t seed);

}  // namespace foresight
