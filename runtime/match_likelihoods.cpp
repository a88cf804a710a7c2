#include "runtime/match_likelihoods.h"

#include <cassert>
#include <cmath>

namespace foresight {
namespace {

// P(R|not M_j) of eq. (5) for each face j of one region. The sum over k != j is a sum over the faces before j plus one
// over the faces behind j: all its terms are positive, so nothing cancels where one face explains nearly everything, as
// it would in the whole sum minus its own term.
PoolVector<double> likelihoods_off(const PoolVector<double>& likelihoods, const PoolVector<double>& priors,
                                   const BackgroundOptions& background) {
  const std::size_t faces = likelihoods.size();
  PoolVector<double> result(faces);
  double behind = 0.0;
  for (std::size_t j = faces; j-- > 0;) {
    result[j] = behind;
    behind += likelihoods[j] * priors[j];
  }
  double before = background.likelihood * background.prior;
  for (std::size_t j = 0; j < faces; ++j) {
    result[j] = (before + result[j]) / (1.0 - priors[j]);
    before += likelihoods[j] * priors[j];
  }
  return result;
}

}  // namespace

BackgroundOptions background_for(const DensityOptions& densities) {
  BackgroundOptions background;
  if (densities.bins != DensityOptions{}.bins) background.likelihood = std::pow(densities.bins, -kAttributeCount);
  return background;
}

PoolVector<Match> match_likelihoods(const PoolVector<DescribedRegion>& regions, const Database& database,
                                    const BackgroundOptions& options) {
  assert(options.prior > 0.0 && options.prior < 1.0 && options.likelihood > 0.0);
  const std::size_t faces = database.faces().size();
  PoolVector<double> priors(faces);
  for (std::size_t j = 0; j < faces; ++j) priors[j] = database.prior(static_cast<int>(j), options.prior);

  PoolVector<Match> matches;
  PoolVector<double> likelihoods(faces);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    for (std::size_t j = 0; j < faces; ++j) {
      likelihoods[j] = database.likelihood(static_cast<int>(j), regions[i].attributes);  // eq. (4)
    }
    const PoolVector<double> off = likelihoods_off(likelihoods, priors, options);
    for (std::size_t j = 0; j < faces; ++j) {
      if (!(likelihoods[j] > 0.0)) continue;  // "we throw out hypotheses that have zero probability", Section IV.A
      matches.push_back({static_cast<int>(i), static_cast<int>(j), std::log(likelihoods[j]), std::log(off[j])});
    }
  }
  return matches;
}

}  // namespace foresight
