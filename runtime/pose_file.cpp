#include "runtime/pose_file.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/errors.h"

namespace foresight {
namespace {

using Json = nlohmann::json;

constexpr const char* kMend = R"(write {"pose": [[r,r,r,tx],[r,r,r,ty],[r,r,r,tz],[0,0,0,1]]}, sensor from model, mm)";

// What rounding in a file may do to a rotation; anything farther off is another kind of matrix.
constexpr double kLargestDeviation = 1e-3;
// Nearer than this the file's own numbers stay, so that a pose written here reads back to the same bits.
constexpr double kExact = 1e-12;

const Json& find_pose(const std::string& file, const Json& json) {
  if (!json.is_object()) throw InputError(file, "it holds no pose", kMend);
  for (const char* key : {"pose", "T_sensor_model"}) {
    if (json.contains(key)) return json[key];
  }
  if (json.contains("detections")) {
    throw InputError(file, "it is a whole result, not a pose", "keep one entry of its detections");
  }
  throw InputError(file, "it has neither pose nor T_sensor_model", kMend);
}

Eigen::Matrix4d read_matrix(const std::string& file, const Json& rows) {
  Eigen::Matrix4d matrix;
  if (!rows.is_array() || rows.size() != 4) throw InputError(file, "its pose is not 4x4", kMend);
  for (int row = 0; row < 4; ++row) {
    const Json& values = rows[static_cast<std::size_t>(row)];
    if (!values.is_array() || values.size() != 4) throw InputError(file, "its pose is not 4x4", kMend);
    for (int column = 0; column < 4; ++column) {
      const Json& value = values[static_cast<std::size_t>(column)];
      if (!value.is_number()) throw InputError(file, "its pose has an entry that is no number", kMend);
      matrix(row, column) = value.get<double>();
    }
  }
  if (!matrix.allFinite()) throw InputError(file, "its pose has an entry that is not finite", kMend);
  return matrix;
}

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

void check_rotation(const std::string& file, const Eigen::Matrix3d& rotation) {
  const double deviation = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kLargestDeviation)) {
    throw InputError(file,
                     "its rotation R is none: R^T R deviates from the identity by " + text(deviation) + ", more than " +
                         text(kLargestDeviation),
                     "give a rotation without scale or shear, row by row");
  }
  if (rotation.determinant() < 0.0) {
    throw InputError(file, "its rotation mirrors: the determinant is " + text(rotation.determinant()),
                     "give a right-handed frame: x right, y down, z forward");
  }
}

}  // namespace

Pose read_pose_file(const std::string& file) {
  const Json json = Json::parse(read_whole_file(file), nullptr, false);
  if (json.is_discarded()) throw InputError(file, "is not JSON", kMend);
  const Eigen::Matrix4d matrix = read_matrix(file, find_pose(file, json));
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    throw InputError(file, "the last row of its pose is not 0 0 0 1", kMend);
  }
  Pose pose{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
  check_rotation(file, pose.rotation);
  if (!is_rotation(pose.rotation, kExact)) pose.rotation = nearest_rotation(pose.rotation);
  return pose;
}

}  // namespace foresight
