#include "runtime/scan_context.h"

#include <algorithm>

#include "runtime/canonical_pose.h"
#include "runtime/pose_from_matches.h"

namespace foresight {

std::optional<Pose> estimate_pose(const ScanContext& scan, const ObjectHypothesis& hypothesis) {
  std::vector<RegionFaceMatch> matches;
  for (const int index : hypothesis.matches) {
    const Match& match = scan.match(index);
    matches.push_back({&scan.regions[static_cast<std::size_t>(match.region)], &scan.database.face(match.face)});
  }
  return pose_from_matches(matches);
}

bool uses_any(const ScanContext& scan, const ObjectHypothesis& hypothesis, const std::vector<bool>& taken) {
  return std::any_of(hypothesis.matches.begin(), hypothesis.matches.end(),
                     [&](int index) { return taken[static_cast<std::size_t>(scan.match(index).region)]; });
}

RefinedPose refine(const ScanContext& scan, const ObjectHypothesis& hypothesis, const Pose& start,
                   const RecognizeOptions& options, RecognitionResult& result, Stopwatch& watch) {
  const CompiledModel& model = scan.model(hypothesis);
  RefinedPose refined;
  refined.localization = localize(model, scan.sphere, start, scan.data, localization_options(options));
  watch.lap(result.milliseconds.localize);
  refined.verification = verify(model, scan.sphere, refined.localization.T_sensor_model, scan.image, scan.camera,
                                scan.data, verification_options(options));
  ++result.statistics.verifications;
  result.statistics.energy_evaluations += refined.localization.energy_evaluations;
  watch.lap(result.milliseconds.verify);
  return refined;
}

Detection make_detection(const ScanContext& scan, const ObjectHypothesis& hypothesis, const RefinedPose& refined,
                         int rank, EquivalentPose pose) {
  const CompiledModel& model = scan.model(hypothesis);
  CanonicalPose chosen{refined.localization.T_sensor_model, Pose{}};
  if (pose == EquivalentPose::canonical) chosen = canonical_choice(model, refined.localization.T_sensor_model);
  RefinedPose reported = refined;
  reported.localization.T_sensor_model = chosen.T_sensor_model;
  Detection detection = to_detection(model, reported);
  detection.rank = rank;
  for (const int index : hypothesis.matches) {
    const Match& match = scan.match(index);
    detection.faces.push_back(scan.database.faces()[static_cast<std::size_t>(match.face)].face);
    detection.regions.push_back(match.region);
  }
  detection.faces = moved_faces(model, detection.faces, chosen.T_model_model);
  return detection;
}

bool limits_reached(const RecognizeOptions& options, const Deadline& deadline, RecognitionResult& result) {
  const auto reached = [](auto count, int most) { return most > 0 && count >= static_cast<decltype(count)>(most); };
  if (reached(result.detections.size(), options.most_detections)) return true;
  if (reached(result.statistics.verifications, options.most_verifications)) return true;
  if (!deadline || std::chrono::steady_clock::now() < *deadline) return false;
  result.complete = false;
  return true;
}

}  // namespace foresight
