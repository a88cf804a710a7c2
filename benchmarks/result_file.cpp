#include "benchmarks/result_file.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "benchmarks/pose_json.h"
#include "common/atomic_file.h"
#include "common/errors.h"

namespace foresight {
namespace {

constexpr const char* kMend = "give what `foresight recognize --format json` printed";

ScanResult::Object parse_object(const nlohmann::json& json, const std::string& file) {
  return {json.at("object").get<std::string>(), pose_from_json(json.at("pose"), file)};
}

ScanResult parse_line(const std::string& line, const std::string& file) {
  const nlohmann::json json = nlohmann::json::parse(line);
  ScanResult result;
  result.scan = json.at("scan").get<std::string>();
  for (const auto& detection : json.at("detections")) {
    ScanResult::Object object = parse_object(detection, file);
    if (detection.contains("ambiguous_with")) {
      for (const auto& other : detection.at("ambiguous_with"))
        object.ambiguous_with.push_back(parse_object(other, file));
    }
    result.detections.push_back(std::move(object));
  }
  return result;
}

}  // namespace

std::vector<ScanResult> read_result_file(const std::string& file) {
  std::istringstream lines(read_whole_file(file));
  std::vector<ScanResult> results;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    try {
      results.push_back(parse_line(line, file));
    } catch (const nlohmann::json::exception& error) {
      throw InputError(file, "line " + std::to_string(number) + " is no result: " + error.what(), kMend);
    }
  }
  if (results.empty()) throw InputError(file, "it holds no result", kMend);
  return results;
}

}  // namespace foresight
