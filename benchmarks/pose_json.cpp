#include "benchmarks/pose_json.h"

#include <nlohmann/json.hpp>

#include "common/errors.h"

namespace foresight {

Pose pose_from_json(const nlohmann::json& rows, const std::string& file) {
  Pose pose;
  for (int row = 0; row < 3; ++row) {
    const nlohmann::json& values = rows.at(static_cast<std::size_t>(row));
    for (int column = 0; column < 3; ++column)
      pose.rotation(row, column) = values.at(static_cast<std::size_t>(column)).get<double>();
    pose.translation[row] = values.at(3).get<double>();
  }
  // Six decimals make proper rotations only to about that.
  if (!is_rotation(pose.rotation, 1e-4))
    throw InputError(file, "a pose is not a proper rotation", "check the poses in it");
  pose.rotation = nearest_rotation(pose.rotation);
  return pose;
}

}  // namespace foresight
