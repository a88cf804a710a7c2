// Densities P(f|M), P(f|M,M') and prior counts from the samples of all views (Section III).
#pragma once

#include <vector>

#include "common/compiled_model.h"
#include "compiler/face_samples.h"

namespace foresight {

// Fills faces[..].views_found and densities, and pairs, of a model whose faces are in place.
// Bins are shared by all faces of the model: from 0 to the largest value seen, so that bin masses of different faces compare.
void estimate_statistics(const std::vector<ViewSample>& views, const DensityOptions& options, CompiledModel& model);

}  // namespace foresight
