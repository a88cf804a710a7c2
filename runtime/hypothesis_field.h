// The Markov random field over matches, eqs. (1)-(3).
#pragma once

#include <array>
#include <vector>

#include "runtime/foresight.h"
#include "runtime/match_likelihoods.h"

namespace foresight {

enum Label : int { kOff = 0, kOn = 1 };

struct HypothesisField {
  std::vector<Match> matches;
  // [match][label]: 1-clique potential minus log-likelihood of the observation.
  std::vector<std::array<double, 2>> unary;
  // N+, eq. (2): ascending neighbour matches; same model, distinct faces, distinct regions.
  std::vector<std::vector<int>> supports;
  // Matches of each region: any two of them contradict, N-, eq. (1).
  std::vector<std::vector<int>> by_region;
  Potentials potentials;
};

// REQUIRES: matches as match_likelihoods returns them for these regions, database and background.
[[nodiscard]] HypothesisField build_hypothesis_field(const std::vector<DescribedRegion>& regions,
                                                     const std::vector<Match>& matches, const Database& database,
                                                     const BackgroundOptions& background, const Potentials& potentials);

// U(omega | R) of eq. (3) for a complete assignment, one label a match.
[[nodiscard]] double energy(const HypothesisField& field, const std::vector<Label>& labels);

}  // namespace foresight
