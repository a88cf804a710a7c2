#include "runtime/settled_localization.h"

namespace foresight {
namespace {

constexpr int kSettlings = 3;
constexpr double kReach = 12.0;  // Unit: mm.
constexpr int kMostRounds = 12;
constexpr double kLocalizationError = 1.0;  // one step. Unit: mm.

}  // namespace

PoseCheckOptions settling_options(const SensorModel& sensor) {
  PoseCheckOptions options;
  options.distance = kLocalizationError + agreeing_distance(sensor);
  return options;
}

Pose settle(const ScanContext& scan, int model, Pose pose, PoseChecker& settling) {
  const CompiledModel& compiled = scan.database.models()[static_cast<std::size_t>(model)];
  for (int i = 0; i < kSettlings; ++i) {
    pose = refit_to_planes(compiled, pose, settling.check(model, pose), scan.regions);
  }
  return pose;
}

Localization localize_and_settle(const ScanContext& scan, const LabelledScan& labelled, int model, const Pose& start,
                                 const RecognizeOptions& options, PoseChecker& settling) {
  const CompiledModel& compiled = scan.database.models()[static_cast<std::size_t>(model)];
  LocalizationOptions localization = localization_options(options);
  localization.reach = kReach;
  localization.most_rounds = kMostRounds;
  Localization localized = localize(compiled, scan.sphere, start, *scan.data, localization);
  const Pose settled = settle(scan, model, localized.T_sensor_model, settling);
  EvidenceOptions fine;
  fine.distance = agreeing_distance(labelled.sensor);
  const auto balance = [&](const Pose& pose) {
    const PoseEvidence evidence = gather_evidence(compiled, pose, labelled, fine);
    return evidence.owned - evidence.behind - evidence.tilted - evidence.front;
  };
  if (balance(settled) > balance(localized.T_sensor_model)) localized.T_sensor_model = settled;
  return localized;
}

}  // namespace foresight
