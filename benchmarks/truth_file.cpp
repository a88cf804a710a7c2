#include "benchmarks/truth_file.h"

#include <nlohmann/json.hpp>

#include "benchmarks/pose_json.h"
#include "common/atomic_file.h"
#include "common/errors.h"

namespace foresight {
namespace {

ScanTruth scan_of(const nlohmann::json& entry, const std::string& file) {
  ScanTruth truth;
  truth.scan = entry.at("scan").get<std::string>();
  truth.camera = entry.value("camera", std::string());
  for (const auto& object : entry.at("objects")) {
    ScanTruth::Object& added = truth.objects.emplace_back();
    added.object = object.at("object").get<std::string>();
    added.visible_fraction = object.at("visible_fraction").get<double>();
    added.poses.push_back(pose_from_json(object.at("T_sensor_model"), file));
    for (const auto& pose : object.value("equally_good_poses", nlohmann::json::array()))
      added.poses.push_back(pose_from_json(pose, file));
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
