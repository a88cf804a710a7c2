// A pose as JSON, for `foresight localize`: {"pose": 4x4 row-major} or one detection of a result, T_sensor_model in mm.
#pragma once

#include <string>

#include "common/pose.h"

namespace foresight {

// Throws InputError: missing, not JSON, not 4x4, not a proper rotation (names the deviation), not finite.
[[nodiscard]] Pose read_pose_file(const std::string& file);

}  // namespace foresight
