// The Markov random field over matches, eqs. (1)-(3).
#pragma once

#include <array>

#include "common/memory_pool.h"
#include "runtime/foresight.h"
#include "runtime/match_likelihoods.h"

namespace foresight {

enum Label : int { kOff = 0, kOn = 1 };

struct HypothesisField {
  PoolVector<Match> matches;
  // [match][label]: 1-clique potential minus log-likelihood of the observation.
  PoolVector<std::array<double, 2>> unary;
  // N+, eq. (2): ascending neighbour matches; same model, distinct faces, distinct regions.
  PoolVector<PoolVector<int>> supports;
  // Matches of each region: any two of them contradict, N-, eq. (1).
  PoolVector<PoolVector<int>> by_region;
  Potentials potentials;
};

// REQUIRES: matches as match_likelihoods returns them for these regions, database and background.
[[nodiscard]] HypothesisField build_hypothesis_field(const PoolVector<DescribedRegion>& regions,
                                                     const PoolVector<Match>& matches, const Database& database,
                                                     const BackgroundOptions& background, const Potentials& potentials);

// U(omega | R) of eq. (3) for a complete assignment, one label a match.
[[nodiscard]] double energy(const HypothesisField& field, const PoolVector<Label>& labels);

}  // namespace foresight
