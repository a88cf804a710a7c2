#include "benchmarks/constraint_models.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace foresight {
namespace {

double normal_below(double value, double mean, double sigma) {
  if (sigma <= 0.0) return value > mean ? 1.0 : 0.0;
  return 0.5 * std::erfc((mean - value) / (sigma * std::numbers::sqrt2));
}

double uniform_below(double value, double low, double high) {
  if (high <= low) return value > low ? 1.0 : 0.0;
  return std::clamp((value - low) / (high - low), 0.0, 1.0);
}

Constraint histogram(const Density& density) { return {ConstraintKind::histogram, density, 0, 0, 0, 0}; }
Constraint normal(double mean, double sigma) { return {ConstraintKind::normal, {}, mean, sigma, 0, 0}; }
Constraint bounds(double low, double high) { return {ConstraintKind::bounds, {}, 0, 0, low, high}; }

Constraint fitted_normal(const AttributeKnowledge& knowledge) {
  const std::span<const double> samples = knowledge.samples;
  if (samples.empty()) return bounds(1.0, 0.0);
  const auto n = static_cast<double>(samples.size());
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / n;
  if (samples.size() == 1) return normal(mean, knowledge.cad_sigma);
  double squares = 0.0;
  for (const double sample : samples) squares += (sample - mean) * (sample - mean);
  return normal(mean, std::sqrt(squares / (n - 1.0)));
}

}  // namespace

bool Constraint::keeps(double value) const {
  switch (kind) {
    case ConstraintKind::histogram:
      return density.probability(value) > 0.0;
    case ConstraintKind::normal:
      return std::abs(value - mean) <= kNormalReach * sigma;
    case ConstraintKind::bounds:
      return value >= low && value <= high;
  }
  return false;
}

double Constraint::probability(double value, double bin_width) const {
  if (kind == ConstraintKind::histogram) return density.probability(value);
  const double from = std::floor(value / bin_width) * bin_width;
  const double to = from + bin_width;
  if (kind == ConstraintKind::normal) return normal_below(to, mean, sigma) - normal_below(from, mean, sigma);
  if (low > high) return 0.0;
  return uniform_below(to, low, high) - uniform_below(from, low, high);
}

std::array<Constraint, kConstraintCount> constraints_for(const AttributeKnowledge& knowledge) {
  const double cad = knowledge.cad_value;
  const double slack = kNormalReach * knowledge.cad_sigma;
  const Constraint of_angle = bounds(cad - slack, cad + slack);
  return {histogram(knowledge.density),
          fitted_normal(knowledge),
          normal(cad, knowledge.cad_sigma),
          knowledge.angle ? of_angle : bounds(0.0, cad),
          knowledge.angle ? of_angle : bounds(0.0, cad + slack),
          knowledge.angle ? of_angle : bounds(0.8 * cad, 1.1 * cad)};
}

}  // namespace foresight
