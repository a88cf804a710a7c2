#include "runtime/settled_localization.h"

#include <utility>

namespace foresight {
namespace {

constexpr int kSettlings = 3;
constexpr double kReach = 12.0;  // Unit: mm.
constexpr int kMostRounds = 12;
constexpr int kMostPoints = 160;
constexpr double kLocalizationError = 1.0;  // one step. Unit: mm.

}  // namespace

PoseCheckOptions settling_options(const SensorModel& sensor) {
  PoseCheckOptions options;
  options.distance = kLocalizationError + agreeing_distance(sensor);
  return options;
}

LocalizationOptions near_localization_options(const RecognizeOptions& options) {
  LocalizationOptions localization = localization_options(options);
  localization.reach = kReach;
  localization.most_rounds = kMostRounds;
  localization.most_points = kMostPoints;
  return localization;
}

Pose settle(const ScanContext& scan, int model, Pose pose, PoseChecker& settling) {
  const CompiledModel& compiled = scan.database.models()[static_cast<std::size_t>(model)];
  for (int i = 0; i < kSettlings; ++i) {
    pose = refit_to_planes(compiled, pose, settling.check(model, pose), scan.regions);
  }
  return pose;
}

SettledPose localize_and_settle(const ScanContext& scan, const LabelledScan& labelled, int model, const Pose& start,
                                const RecognizeOptions& options, PoseChecker& settling, const Stop& stop) {
  const CompiledModel& compiled = scan.database.models()[static_cast<std::size_t>(model)];
  SettledPose result;
  result.localization = localize(compiled, scan.sphere, start, scan.data, near_localization_options(options), stop);
  Pose& pose = result.localization.T_sensor_model;
  const EvidenceOptions fine = judging_options(labelled.sensor);
  const auto balance = [](const PoseEvidence& evidence) {
    return evidence.owned - evidence.behind - evidence.tilted - evidence.front;
  };
  result.evidence = gather_evidence(compiled, pose, labelled, fine);
  if (stop && stop()) return result;
  const Pose settled = settle(scan, model, pose, settling);
  PoseEvidence at_settled = gather_evidence(compiled, settled, labelled, fine);
  if (balance(at_settled) > balance(result.evidence)) {
    pose = settled;
    result.evidence = std::move(at_settled);
  }
  return result;
}

}  // namespace foresight
