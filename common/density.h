// A one-dimensional distribution of an attribute as compiled from sample views: P(f|M), Section III and Fig. 2.
#pragma once

#include <span>
#include <vector>

namespace foresight {

struct DensityOptions {
  int bins = 24;          // P(R|B) = 3e-6 of Section IV.A is 24^-4: a uniform background over four attributes of 24 bins. Limit: 2 to 1000.
  // Standard deviation of the Gaussian each sample is smoothed with, in bins; 0 = the raw histogram of the paper. Limit: 0 to 10.
  // DEFAULT: raw. Bins span a model's whole range of values, so that one bin is wide already; a kernel of half a bin let
  // 39 % instead of 20 % of the possible matches through, for 12 times the hypotheses and no more objects (80 clean scans).
  double kernel = 0.0;
};

bool operator==(const DensityOptions& a, const DensityOptions& b);
void check(const DensityOptions& options);  // throws UsageError

// Equal bins over [lower, upper); mass sums to 1 over the non-empty run of bins that is stored.
struct Density {
  double lower = 0.0;              // lower edge of bin 0
  double bin_width = 0.0;          // > 0
  int first_bin = 0;               // of mass[0]; smoothing may reach below `lower`, so it may be negative
  std::vector<float> mass;         // probability of each stored bin; outside: zero

  // Probability mass of the bin holding the value; 0 outside the stored bins or for NaN.
  [[nodiscard]] double probability(double value) const;
  // Probability of a value of at least this one (the attribute of a partly hidden region is only a lower bound).
  [[nodiscard]] double probability_at_least(double value) const;
};

// REQUIRES: samples non-empty and finite, upper > lower.
[[nodiscard]] Density estimate_density(std::span<const double> samples, double lower, double upper,
                                       const DensityOptions& options);

}  // namespace foresight
