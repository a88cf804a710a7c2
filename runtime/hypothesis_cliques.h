// Object hypotheses: cliques of two or three mutually supporting active matches, most likely first (Section IV.B).
#pragma once

#include <vector>

#include "runtime/hypothesis_field.h"

namespace foresight {

struct ObjectHypothesis {
  int model = 0;
  std::vector<int> matches;  // 2 or 3, ascending indices into HypothesisField::matches
  double energy = 0.0;       // contribution to eq. (3): its unaries (ON) and its pair potentials
};

// All 3-cliques of active matches in N+, and the 2-cliques that no 3-clique contains, ordered by energy (ties: by
// matches).
[[nodiscard]] std::vector<ObjectHypothesis> hypothesis_cliques(const HypothesisField& field, const Database& database,
                                                               const std::vector<Label>& labels);

}  // namespace foresight
