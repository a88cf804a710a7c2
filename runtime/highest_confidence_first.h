// Highest Confidence First: energy minimisation of the field (Chou and Brown, "The Theory and Practice of Bayesian
// Image Labeling", IJCV 4, 1990; Section IV.B).
#pragma once

#include "common/memory_pool.h"
#include "runtime/hypothesis_field.h"

namespace foresight {

// All matches start uncommitted; the one most stable to decide is decided (or changed) first, through a heap keyed on
// stability with O(log n) updates, until no change lowers the energy. A local minimum of energy(). Deterministic.
[[nodiscard]] PoolVector<Label> highest_confidence_first(const HypothesisField& field);

}  // namespace foresight
