// A pose in the JSON that experiments read: truth files and results.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/pose.h"

namespace foresight {

// From the rows of a 4x4 (the last one is not looked at). Numbers may be rounded to about six decimals. Throws
// InputError for what is no rigid motion, nlohmann::json::exception for what is no matrix of numbers.
[[nodiscard]] Pose pose_from_json(const nlohmann::json& rows, const std::string& file);

}  // namespace foresight
