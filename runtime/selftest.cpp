#include "runtime/selftest.h"

#include <array>
#include <cstdio>
#include <limits>
#include <numbers>

#include "runtime/pose_distance.h"
#include "runtime/recognize.h"

namespace foresight {
namespace {

// The nearest of the poses looked at so far.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  Pose T_sensor_model;
  double score = 0.0;

  void look_at(const std::array<double, 16>& T, double its_score, const ScoredObject& object, const Pose& truth) {
    const Pose pose = pose_of(T);
    const double its_distance = mssd(object, pose, truth);
    if (its_distance < distance) *this = {its_distance, pose, its_score};
  }
};

const char* words_of(SelftestVerdict verdict) {
  switch (verdict) {
    case SelftestVerdict::right:
      return "right";
    case SelftestVerdict::ambiguous:
      return "right among the alternatives named";
    case SelftestVerdict::wrong:
      return "FAILED, wrong pose";
    case SelftestVerdict::not_found:
      return "FAILED, not found";
    case SelftestVerdict::no_golden_scan:
      break;
  }
  return "not tested, no golden scan in the database";
}

}  // namespace

bool is_failure(SelftestVerdict verdict) {
  return verdict == SelftestVerdict::wrong || verdict == SelftestVerdict::not_found;
}

ObjectSelftest judge_golden_scan(const RecognitionResult& recognized, const CompiledModel& model) {
  ObjectSelftest result;
  result.object = model.name;
  result.milliseconds = recognized.milliseconds.total;
  const ScoredObject object = scored_object(model);
  const Pose& truth = model.golden_scan->T_sensor_model;
  Nearest reported, alternative;
  for (const Detection& detection : recognized.detections) {
    reported.look_at(detection.T_sensor_model, detection.score, object, truth);
    for (const Alternative& other : detection.ambiguous_with) {
      alternative.look_at(other.T_sensor_model, other.score, object, truth);
    }
  }
  const bool declared = reported.distance > object.tolerance() && alternative.distance <= object.tolerance();
  const Nearest& nearest = declared ? alternative : reported;
  result.verdict = recognized.detections.empty()            ? SelftestVerdict::not_found
                   : declared                               ? SelftestVerdict::ambiguous
                   : reported.distance > object.tolerance() ? SelftestVerdict::wrong
                                                            : SelftestVerdict::right;
  if (recognized.detections.empty()) return result;
  const Pose equal = nearest_equal(object, nearest.T_sensor_model, truth);
  result.position_error = (nearest.T_sensor_model * model.centre - equal * model.centre).norm();
  result.angle_error = rotation_angle(nearest.T_sensor_model.rotation * equal.rotation.transpose());
  result.score = nearest.score;
  return result;
}

ObjectSelftest selftest_object(const CompiledModel& model, const CompiledDatabase& settings) {
  // The compiler leaves no golden scan in a model that lacks what the two-way method needs.
  if (!model.golden_scan || model.acceptance.samples == 0 || model.triangle_faces.empty()) return {model.name};
  const PinholeCamera& camera = settings.sensor.camera;
  const RangeImage image = decode_golden_scan(*model.golden_scan, camera);
  const Database alone(
      {settings.tool_version, settings.ray_isa, settings.sensor, settings.segmentation, settings.density, {model}});
  return judge_golden_scan(recognize(image, camera, alone, {}), model);
}

SelftestCounts count_verdicts(const std::vector<ObjectSelftest>& results) {
  SelftestCounts counts;
  for (const ObjectSelftest& result : results) {
    if (is_failure(result.verdict)) {
      ++counts.failed;
    } else if (result.verdict == SelftestVerdict::no_golden_scan) {
      ++counts.untested;
    } else {
      ++counts.passed;
    }
  }
  return counts;
}

std::string selftest_line(const ObjectSelftest& result) {
  std::string line = result.object + ": " + words_of(result.verdict);
  std::array<char, 128> numbers{};
  if (result.verdict == SelftestVerdict::not_found) {
    std::snprintf(numbers.data(), numbers.size(), ", %.1f ms", result.milliseconds);
  } else if (result.verdict != SelftestVerdict::no_golden_scan) {
    std::snprintf(numbers.data(), numbers.size(), ", %.3f mm and %.3f degrees off, score %.3f, %.1f ms",
                  result.position_error, result.angle_error * 180.0 / std::numbers::pi, result.score,
                  result.milliseconds);
  }
  return line + numbers.data() + "\n";
}

std::string selftest_summary(const SelftestCounts& counts, const std::string& compiler_version) {
  const char* verdict = counts.failed > 0 ? "FAILED" : counts.passed > 0 ? "passed" : "nothing to test";
  return std::string(verdict) + ": " + std::to_string(counts.passed) + " right, " + std::to_string(counts.failed) +
         " failed, " + std::to_string(counts.untested) + " not tested; foresight " + version() +
         ", database of foresightc " + compiler_version + "\n";
}

}  // namespace foresight
