#include "benchmarks/mean_interval.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "common/random.h"

namespace foresight {
namespace {

constexpr int kSamples = 1000;

}  // namespace

Mean mean_of(const std::vector<double>& values, std::uint64_t seed) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {kNone, {kNone, kNone}};
  const auto count = static_cast<double>(values.size());
  Random random(seed);
  std::vector<double> means(kSamples);
  for (double& mean : means) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      mean += values[static_cast<std::size_t>(random.integer(0, static_cast<int>(values.size()) - 1))];
    }
    mean /= count;
  }
  std::sort(means.begin(), means.end());
  const auto at_share = [&](double share) { return means[static_cast<std::size_t>(share * (kSamples - 1))]; };
  return {std::accumulate(values.begin(), values.end(), 0.0) / count, {at_share(0.025), at_share(0.975)}};
}

}  // namespace foresight
