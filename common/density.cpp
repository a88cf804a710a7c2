#include "common/density.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "common/errors.h"

namespace foresight {
namespace {

constexpr double kKernelReach = 3.0;  // the kernel ends at three standard deviations: beyond is P = 0, which prunes matches

double gaussian_below(double u) { return 0.5 * std::erfc(-u / std::numbers::sqrt2); }

// Bin that holds a position given in bins.
int bin_of(double position) { return static_cast<int>(std::floor(position)); }

// Spreads one sample over bins by the kernel. Position and kernel in bins.
void add_sample(double position, double kernel, int first_bin, std::vector<double>& mass) {
  if (kernel == 0.0) {
    mass[static_cast<std::size_t>(bin_of(position) - first_bin)] += 1.0;
    return;
  }
  const double low = position - kKernelReach * kernel;
  const double high = position + kKernelReach * kernel;
  const double inside = gaussian_below(kKernelReach) - gaussian_below(-kKernelReach);
  for (int bin = bin_of(low); bin <= bin_of(high); ++bin) {
    const double left = (std::max(static_cast<double>(bin), low) - position) / kernel;
    const double right = (std::min(static_cast<double>(bin + 1), high) - position) / kernel;
    mass[static_cast<std::size_t>(bin - first_bin)] += (gaussian_below(right) - gaussian_below(left)) / inside;
  }
}

}  // namespace

bool operator==(const DensityOptions& a, const DensityOptions& b) { return a.bins == b.bins && a.kernel == b.kernel; }

void check(const DensityOptions& options) {
  if (options.bins < 2 || options.bins > 1000) throw UsageError("density.bins", "outside its limits", "give 2 to 1000");
  if (!(options.kernel >= 0.0 && options.kernel <= 10.0)) {
    throw UsageError("density.kernel", "outside its limits", "give 0 to 10 bins");
  }
}

double Density::probability(double value) const {
  const double position = (value - lower) / bin_width;
  // Negated so that NaN, which fails every comparison, has no probability.
  if (!(position >= first_bin && position < first_bin + static_cast<double>(mass.size()))) return 0.0;
  return static_cast<double>(mass[static_cast<std::size_t>(bin_of(position) - first_bin)]);
}

double Density::probability_at_least(double value) const {
  const double position = (value - lower) / bin_width;
  double sum = 0.0;
  for (std::size_t i = mass.size(); i-- > 0;) {
    const double left = first_bin + static_cast<double>(i);
    if (!(position < left + 1.0)) break;
    sum += static_cast<double>(mass[i]) * std::min(1.0, left + 1.0 - position);
  }
  return std::min(1.0, sum);
}

Density estimate_density(std::span<const double> samples, double lower, double upper, const DensityOptions& options) {
  assert(!samples.empty() && upper > lower);
  Density density;
  density.lower = lower;
  density.bin_width = (upper - lower) / options.bins;
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  const double reach = kKernelReach * options.kernel;
  density.first_bin = bin_of((*least - lower) / density.bin_width - reach);
  const int last_bin = bin_of((*most - lower) / density.bin_width + reach);

  std::vector<double> mass(static_cast<std::size_t>(last_bin - density.first_bin + 1), 0.0);
  for (const double sample : samples) {
    add_sample((sample - lower) / density.bin_width, options.kernel, density.first_bin, mass);
  }
  for (const double value : mass) density.mass.push_back(static_cast<float>(value / static_cast<double>(samples.size())));
  return density;
}

}  // namespace foresight
