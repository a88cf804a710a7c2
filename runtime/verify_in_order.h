// The paper's search: the first acceptable hypothesis first (Section V.C).
#pragma once

#include "common/memory_pool.h"
#include "runtime/hypothesis_cliques.h"
#include "runtime/scan_context.h"

namespace foresight {

// Each hypothesis in order is located, refined and verified by alpha, beta and gamma; an accepted one drops its rivals:
// those that share a region with it, or that rest on a region it explains. Fills detections, statistics and times.
void verify_in_order(const ScanContext& scan, const HypothesisField& field,
                     const PoolVector<ObjectHypothesis>& hypotheses, const RecognizeOptions& options,
                     const Deadline& deadline, Recognition& result);

}  // namespace foresight
