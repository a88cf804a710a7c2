#include "runtime/rated_matches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace foresight {
namespace {

// Density at a value, spread over the neighbouring bins: a sample near the edge of a bin might as well have been
// beyond.
double smooth_density(const Density& density, double value) {
  const double near = density.probability(value - density.bin_width) + density.probability(value + density.bin_width);
  return (0.5 * density.probability(value) + 0.25 * near) / density.bin_width;
}

// The background: any value from 0 to `range` is as likely. Ratio of likelihoods.
double ratio(const Density& density, double value, double range, bool lower_bound, const RatingOptions& options) {
  if (lower_bound) {
    const double least = std::max(0.0, value - density.bin_width);
    const double background = std::max(1.0 - least / range, density.bin_width / range);
    return std::max(density.probability_at_least(least) / background, options.least_ratio);
  }
  return std::max(smooth_density(density, value) * range, options.least_ratio);
}

double last_edge(const Density& density) {
  return density.lower + (density.first_bin + static_cast<double>(density.mass.size())) * density.bin_width;
}

}  // namespace

MatchRater::MatchRater(const Database& database, const RatingOptions& options)
    : database_(database), options_(options) {
  for (std::size_t j = 0; j < database.faces().size(); ++j) {
    const ModelFace& face = database.face(static_cast<int>(j));
    for (std::size_t k = 0; k < ranges_.size(); ++k) ranges_[k] = std::max(ranges_[k], last_edge(face.densities[k]));
  }
  double narrowest = std::numeric_limits<double>::max();  // bin, as a share of the range
  for (const CompiledModel& model : database.models()) {
    for (const FacePair& pair : model.pairs) {
      distance_range_ = std::max(distance_range_, last_edge(pair.densities[kMaxDistance]));
      narrowest = std::min(narrowest, pair.densities[kOrientation].bin_width / std::numbers::pi);
    }
  }
  for (const CompiledModel& model : database.models()) {
    for (const FacePair& pair : model.pairs) {
      const double distance = pair.densities[kMaxDistance].bin_width / distance_range_;
      highest_pair_rating_ = std::max(highest_pair_rating_, -std::log(narrowest) - std::log(distance));
    }
  }
}

PoolVector<RegionMatches> MatchRater::rate(const PoolVector<DescribedRegion>& regions, const Stop& stop) const {
  const double faces = static_cast<double>(database_.faces().size());
  const double least = std::exp(options_.least_rating);
  PoolVector<RegionMatches> rated(regions.size());
  for (std::size_t i = 0; i < regions.size() && !(stop && stop()); ++i) {
    const bool cut = is_cut(regions[i]);
    for (std::size_t j = 0; j < database_.faces().size(); ++j) {
      const ModelFace& face = database_.face(static_cast<int>(j));
      double ratios = faces * database_.prior(static_cast<int>(j), 0.0);
      for (std::size_t k = 0; k < ranges_.size(); ++k) {
        ratios *= ratio(face.densities[k], regions[i].attributes[k], ranges_[k], cut, options_);
      }
      if (ratios < least) continue;
      const FaceIndex at = database_.faces()[j];
      rated[i].push_back({static_cast<int>(i), at.model, at.face, std::log(ratios)});
    }
  }
  return rated;
}

double MatchRater::rate(const FacePair& pair, const RelationVector& relation, bool cut) const {
  return std::log(ratio(pair.densities[kOrientation], relation[kOrientation], std::numbers::pi, false, options_) *
                  ratio(pair.densities[kMaxDistance], relation[kMaxDistance], distance_range_, cut, options_));
}

}  // namespace foresight
