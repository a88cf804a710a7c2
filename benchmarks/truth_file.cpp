#include "benchmarks/truth_file.h"

#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/errors.h"

namespace foresight {
namespace {

// The poses are printed with six decimals: proper rotations only to about that.
Pose pose_of(const nlohmann::json& rows, const std::string& file) {
  Pose pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      pose.rotation(row, column) =
          rows.at(static_cast<std::size_t>(row)).at(static_cast<std::size_t>(column)).get<double>();
    pose.translation[row] = rows.at(static_cast<std::size_t>(row)).at(3).get<double>();
  }
  if (!is_rotation(pose.rotation, 1e-4))
    throw InputError(file, "a pose is not a proper rotation", "check T_sensor_model");
  pose.rotation = nearest_rotation(pose.rotation);
  return pose;
}

ScanTruth scan_of(const nlohmann::json& entry, const std::string& file) {
  ScanTruth truth;
  truth.scan = entry.at("scan").get<std::string>();
  truth.camera = entry.at("camera").get<std::string>();
  for (const auto& object : entry.at("objects")) {
    ScanTruth::Object& added = truth.objects.emplace_back();
    added.object = object.at("object").get<std::string>();
    added.visible_fraction = object.at("visible_fraction").get<double>();
    added.poses.push_back(pose_of(object.at("T_sensor_model"), file));
    for (const auto& pose : object.at("equally_good_poses")) added.poses.push_back(pose_of(pose, file));
  }
  return truth;
}

}  // namespace

std::vector<ScanTruth> read_truth_file(const std::string& file) {
  const std::string text = read_whole_file(file);
  try {
    std::vector<ScanTruth> scans;
    const nlohmann::json document = nlohmann::json::parse(text);
    for (const auto& entry : document.at("scans")) scans.push_back(scan_of(entry, file));
    return scans;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, std::string("not a truth file: ") + error.what(),
                     "give a truth.json with scans, objects and poses");
  }
}

}  // namespace foresight
