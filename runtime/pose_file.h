// A pose as JSON, for `foresight localize`: {"pose": 4x4 row-major}, {"T_sensor_model": the same} or one detection of a
// result; T_sensor_model in mm.
#pragma once

#include <string>

#include "common/pose.h"

namespace foresight {

// A rotation within 1e-3 of a proper one is taken as rounded and made proper; one within 1e-12 keeps its bits.
// Throws InputError: missing, not JSON, not 4x4, last row not 0 0 0 1, not a proper rotation (names the deviation), not
// finite.
[[nodiscard]] Pose read_pose_file(const std::string& file);

}  // namespace foresight
