#include "runtime/scan_context.h"

namespace foresight {

RefinedPose refine(const ScanContext& scan, const CompiledModel& model, const Pose& start,
                   const RecognizeOptions& options, Recognition& result, Stopwatch& watch) {
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

bool limits_reached(const RecognizeOptions& options, const Deadline& deadline, Recognition& result) {
  const auto reached = [](auto count, int most) { return most > 0 && count >= static_cast<decltype(count)>(most); };
  if (reached(result.objects.size(), options.most_detections)) return true;
  if (reached(result.statistics.verifications, options.most_verifications)) return true;
  if (!deadline || std::chrono::steady_clock::now() < *deadline) return false;
  result.complete = false;
  return true;
}

}  // namespace foresight
