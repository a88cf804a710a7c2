// A recognized scan as a picture.
#pragma once

#include <span>

#include "benchmarks/overlay.h"
#include "benchmarks/pose_scoring.h"
#include "compiler/cad_model.h"

namespace foresight {

// The shaded scan; over it the reported objects as wide wireframes in the colours of object_colour(), and the true ones
// thin and white. Objects index `models`; a report of none of them is not drawn. pixels: across one cell. Limit: >= 1.
[[nodiscard]] Picture draw_scene(const RangeImage& image, const PinholeCamera& camera, std::span<const CadModel> models,
                                 std::span<const TrueObject> truth, std::span<const ReportedObject> reported,
                                 int pixels = 1);

}  // namespace foresight
