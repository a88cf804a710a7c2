#include "runtime/result_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>

namespace foresight {
namespace {

using Json = nlohmann::ordered_json;

Json pose_json(const std::array<double, 16>& T) {
  Json rows = Json::array();
  for (std::size_t row = 0; row < 4; ++row) {
    rows.push_back({T[4 * row], T[4 * row + 1], T[4 * row + 2], T[4 * row + 3]});
  }
  return rows;
}

Json covariance_json(const std::array<double, 36>& covariance) {
  Json rows = Json::array();
  for (auto row = covariance.begin(); row != covariance.end(); row += 6) rows.push_back(std::vector(row, row + 6));
  return rows;
}

Json alternative_json(const Alternative& alternative) {
  Json json;
  json["object"] = alternative.object;
  json["pose"] = pose_json(alternative.T_sensor_model);
  json["score"] = alternative.score;
  return json;
}

Json detection_json(const Detection& detection) {
  Json json;
  json["object"] = detection.object;
  json["pose"] = pose_json(detection.T_sensor_model);
  json["score"] = detection.score;
  json["alpha"] = detection.matched;
  json["beta"] = detection.coherent;
  json["gamma"] = detection.occluding;
  json["rank"] = detection.rank;
  json["faces"] = detection.faces;
  json["regions"] = detection.regions;
  json["ambiguous_with"] = Json::array();
  for (const Alternative& other : detection.ambiguous_with) json["ambiguous_with"].push_back(alternative_json(other));
  json["quaternion"] = detection.quaternion;
  json["covariance"] = covariance_json(detection.covariance);
  json["box"]["centre"] = detection.box_centre;
  json["box"]["size"] = detection.box_size;
  return json;
}

Json statistics_json(const Statistics& statistics) {
  Json json;
  json["regions"] = statistics.regions;
  json["possible_matches"] = statistics.possible_matches;
  json["threshold_matches"] = statistics.threshold_matches;
  json["active_matches"] = statistics.active_matches;
  json["hypotheses"] = statistics.hypotheses;
  json["verifications"] = statistics.verifications;
  json["energy_evaluations"] = statistics.energy_evaluations;
  json["pose_checks"] = statistics.pose_checks;
  return json;
}

// The user waits for the file too: total includes reading it.
Json times_json(const StageTimes& times, double read) {
  Json json;
  json["read"] = read;
  json["extract"] = times.extract;
  json["field"] = times.field;
  json["hypotheses"] = times.hypotheses;
  json["localize"] = times.localize;
  json["verify"] = times.verify;
  json["total"] = read + times.total;
  return json;
}

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 256> buffer{};
  std::snprintf(buffer.data(), buffer.size(), pattern, values...);
  return buffer.data();
}

// Names come from files: control characters would reach the terminal.
std::string printable(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, '?');
  return name;
}

std::string list(const std::vector<int>& numbers) {
  std::string text;
  for (const int number : numbers) text.append(" ").append(std::to_string(number));
  return text;
}

// One line: the rows of the pose one after the other.
std::string alternative_text(const Alternative& alternative) {
  std::string text =
      "  ambiguous with " + printable(alternative.object) + format("  score %.3f  pose", alternative.score);
  for (std::size_t row = 0; row < 3; ++row) {
    const double* T = alternative.T_sensor_model.data() + 4 * row;
    text += format("%s %.6f %.6f %.6f %.3f", row == 0 ? "" : ",", T[0], T[1], T[2], T[3]);
  }
  return text + " mm\n";
}

std::string detection_text(const Detection& detection) {
  std::string text = "  ";
  text += printable(detection.object);
  text += format("  score %.3f  alpha %.3f  beta %.3f  gamma %.3f  rank %d", detection.score, detection.matched,
                 detection.coherent, detection.occluding, detection.rank);
  text += "  faces" + list(detection.faces) + "  regions" + list(detection.regions) + "\n";
  for (std::size_t row = 0; row < 3; ++row) {
    const double* T = detection.T_sensor_model.data() + 4 * row;
    text += format("    %9.6f %9.6f %9.6f  %10.3f mm\n", T[0], T[1], T[2], T[3]);
  }
  for (const Alternative& other : detection.ambiguous_with) text += alternative_text(other);
  return text;
}

// The shortest text that reads back to the same number.
std::string shortest(double number) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr};
}

// The last whole number in a name, 0 where there is none or none that fits.
long long last_number(std::string_view name) {
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t last = name.find_last_of(kDigits);
  if (last == std::string_view::npos) return 0;
  name = name.substr(0, last + 1);
  const std::size_t before = name.find_last_not_of(kDigits);
  if (before != std::string_view::npos) name = name.substr(before + 1);
  long long number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() ? number : 0;
}

struct ScanNumbers {
  long long scene = 0;
  long long image = 0;
};

// BOP keeps the depth image of scene 000048 as 000048/depth/000012.png.
ScanNumbers scan_numbers(std::string_view path) {
  const auto take_last = [&path] {
    while (path.ends_with('/')) path.remove_suffix(1);
    const std::size_t slash = path.rfind('/');
    const std::string_view name = path.substr(slash == std::string_view::npos ? 0 : slash + 1);
    path.remove_suffix(name.size());
    return name;
  };
  std::string_view name = take_last();
  name = name.substr(0, name.rfind('.'));
  std::string_view folder = take_last();
  if (folder == "depth") folder = take_last();
  return {last_number(folder), last_number(name)};
}

// The number of an object named as in BOP, obj_000005.
std::optional<long long> bop_number(std::string_view name) {
  constexpr std::string_view kStart = "obj_";
  if (!name.starts_with(kStart)) return std::nullopt;
  name.remove_prefix(kStart.size());
  long long number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size() || number < 0) return std::nullopt;
  return number;
}

// obj_id by name. One rule for the whole database: numbers and places together could mean two objects by one number.
std::map<std::string_view, long long> object_ids(const std::vector<std::string>& object_names) {
  std::map<std::string_view, long long> places;
  std::map<std::string_view, long long> numbers;
  std::set<long long> different;
  for (const std::string& name : object_names) {
    places.emplace(name, static_cast<long long>(places.size()) + 1);
    const std::optional<long long> number = bop_number(name);
    if (number && different.insert(*number).second) numbers.emplace(name, *number);
  }
  return numbers.size() == places.size() ? numbers : places;
}

}  // namespace

std::string result_json(const std::string& scan, const RecognitionResult& result, double read_milliseconds) {
  Json json;
  json["scan"] = scan;
  json["complete"] = result.complete;
  json["detections"] = Json::array();
  for (const Detection& detection : result.detections) json["detections"].push_back(detection_json(detection));
  json["statistics"] = statistics_json(result.statistics);
  json["milliseconds"] = times_json(result.milliseconds, read_milliseconds);
  // File names are bytes, JSON is UTF-8: what is none becomes the replacement character.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string result_text(const std::string& scan, const RecognitionResult& result, double read_milliseconds) {
  const Statistics& counts = result.statistics;
  const StageTimes& times = result.milliseconds;
  const std::size_t found = result.detections.size();
  std::string text = printable(scan) + ": " + (found == 0 ? "nothing" : std::to_string(found)) + " recognized" +
                     (result.complete ? "" : " until the deadline; the search is incomplete") + "\n";
  for (const Detection& detection : result.detections) text += detection_text(detection);
  text += format("  %d regions; matches: %ld possible, %ld above the threshold, %ld active; ", counts.regions,
                 counts.possible_matches, counts.threshold_matches, counts.active_matches);
  text += format("%ld hypotheses, %ld verified, %ld energy evaluations\n", counts.hypotheses, counts.verifications,
                 counts.energy_evaluations);
  text += format("  %.1f ms: read %.1f, extract %.1f, field %.1f, hypotheses %.1f, localize %.1f, verify %.1f\n",
                 read_milliseconds + times.total, read_milliseconds, times.extract, times.field, times.hypotheses,
                 times.localize, times.verify);
  return text;
}

std::string bop_csv_header() { return "scene_id,im_id,obj_id,score,R,t,time\n"; }

std::string bop_csv_rows(const std::string& scan, const RecognitionResult& result,
                         const std::vector<std::string>& object_names, double read_milliseconds) {
  const ScanNumbers numbers = scan_numbers(scan);
  const std::map<std::string_view, long long> ids = object_ids(object_names);
  // BOP wants the time of the whole image in every row of it.
  const std::string seconds = shortest((read_milliseconds + result.milliseconds.total) / 1000.0);
  std::string rows;
  for (const Detection& detection : result.detections) {
    const auto id = ids.find(detection.object);
    const long long object = id == ids.end() ? 0 : id->second;
    const std::array<double, 16>& T = detection.T_sensor_model;
    rows += std::to_string(numbers.scene) + "," + std::to_string(numbers.image) + "," + std::to_string(object) + "," +
            shortest(detection.score) + ",";
    for (const std::size_t i : {0, 1, 2, 4, 5, 6, 8, 9, 10}) rows += shortest(T[i]) + (i < 10 ? " " : ",");
    rows += shortest(T[3]) + " " + shortest(T[7]) + " " + shortest(T[11]) + "," + seconds + "\n";
  }
  return rows;
}

}  // namespace foresight
