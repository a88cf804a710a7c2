#include "benchmarks/intervals.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace foresight {

Interval wilson_interval(long hits, long trials) {
  assert(hits >= 0 && hits <= trials);
  if (trials == 0) return {};
  constexpr double kZ = 1.959963984540054;  // two-sided 95 % of the normal distribution
  const double n = static_cast<double>(trials);
  const double share = static_cast<double>(hits) / n;
  const double spread = kZ * std::sqrt(share * (1.0 - share) / n + kZ * kZ / (4.0 * n * n));
  const double middle = share + kZ * kZ / (2.0 * n);
  const double scale = 1.0 + kZ * kZ / n;
  return {std::max(0.0, (middle - spread) / scale), std::min(1.0, (middle + spread) / scale)};
}

}  // namespace foresight
