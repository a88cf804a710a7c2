// Whether two solids stand where they cannot both be (beyond the paper, whose objects are verified one by one).
#pragma once

#include "common/compiled_model.h"
#include "common/pose.h"

namespace foresight {

// The share of a's surface that lies inside b, deeper than this below b's surface: of a's template points, one by one.
// Inside by the winding number of b's closed mesh (sum of solid angles, van Oosterom and Strackee, "The Solid Angle of
// a Plane Triangle", IEEE Trans. Biomed. Eng. 30(2), 1983). depth: Unit: mm. Limit: >= 0.
[[nodiscard]] double share_inside(const CompiledModel& a, const Pose& T_sensor_a, const CompiledModel& b,
                                  const Pose& T_sensor_b, double depth);

}  // namespace foresight
