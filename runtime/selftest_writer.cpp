#include "runtime/selftest_writer.h"

#include <nlohmann/json.hpp>
#include <numbers>

#include "runtime/foresight.h"

namespace foresight {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(SelftestVerdict verdict) {
  switch (verdict) {
    case SelftestVerdict::right:
      return "right";
    case SelftestVerdict::ambiguous:
      return "ambiguous";
    case SelftestVerdict::wrong:
      return "wrong";
    case SelftestVerdict::not_found:
      return "not_found";
    case SelftestVerdict::no_golden_scan:
      break;
  }
  return "no_golden_scan";
}

Json object_json(const ObjectSelftest& result) {
  const bool tested = result.verdict != SelftestVerdict::no_golden_scan;
  const bool found = tested && result.verdict != SelftestVerdict::not_found;
  const auto known = [](bool is_known, double value) { return is_known ? Json(value) : Json(nullptr); };
  return {{"object", result.object},
          {"verdict", name_of(result.verdict)},
          {"position_error_mm", known(found, result.position_error)},
          {"angle_error_deg", known(found, result.angle_error * 180.0 / std::numbers::pi)},
          {"score", known(found, result.score)},
          {"milliseconds", known(tested, result.milliseconds)}};
}

}  // namespace

std::string selftest_json(const std::string& database, const std::string& compiler_version,
                          const std::vector<ObjectSelftest>& results) {
  const SelftestCounts counts = count_verdicts(results);
  Json objects = Json::array();
  for (const ObjectSelftest& result : results) objects.push_back(object_json(result));
  const Json json = {{"database", database},    {"passed", counts.all_right()},
                     {"objects", objects},      {"right", counts.passed},
                     {"failed", counts.failed}, {"not_tested", counts.untested},
                     {"version", version()},    {"compiler_version", compiler_version}};
  // File names are bytes, JSON is UTF-8: what is none becomes the replacement character.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace foresight
