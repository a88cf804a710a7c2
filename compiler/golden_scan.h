// Chooses the golden scan of a compiled model: what selftest will recognize (common/golden_scan.h).
#pragma once

#include <optional>

#include "common/compiled_model.h"
#include "compiler/cad_model.h"

namespace foresight {

struct GoldenScanOptions {
  double least_score = 0.9;  // of a scan that is taken at once: machines whose rounding differs find it too
  int most_tries = 6;        // views in which recognition is tried. Limit: >= 0.
};

// Of the object alone on the optical axis at the working distance, seen from a direction in each octant and each time
// turned about the axis: the view that shows most faces as regions (at least two; most cells in them where that is
// equal) in which the runtime's default method finds the object, searching for it alone in the scan as it will be
// stored. The first such view whose score is at least least_score, else the one with the best; one in which the right
// pose is only named as an alternative where there is no other. None when no view will do. compiled: the model with its
// acceptance; settings: of its database. Deterministic.
[[nodiscard]] std::optional<GoldenScan> choose_golden_scan(const CadModel& cad, const CompiledModel& compiled,
                                                           const CompiledDatabase& settings,
                                                           const GoldenScanOptions& options = {});

}  // namespace foresight
