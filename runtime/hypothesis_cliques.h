// Object hypotheses: cliques of two or three mutually supporting active matches, most likely first (Section IV.B).
#pragma once

#include "common/memory_pool.h"
#include "runtime/hypothesis_field.h"

namespace foresight {

struct ObjectHypothesis {
  int model = 0;
  PoolVector<int> matches;  // 2 or 3, ascending indices into HypothesisField::matches
  double energy = 0.0;      // contribution to eq. (3): its unaries (ON) and its pair potentials
};

// All 3-cliques of active matches in N+, and the 2-cliques that no 3-clique contains, ordered by energy (ties: by
// matches).
[[nodiscard]] PoolVector<ObjectHypothesis> hypothesis_cliques(const HypothesisField& field, const Database& database,
                                                              const PoolVector<Label>& labels);

}  // namespace foresight
