#include "runtime/verify_in_order.h"

#include "runtime/explained_regions.h"

namespace foresight {

void verify_in_order(const ScanContext& scan, const std::vector<ObjectHypothesis>& hypotheses,
                     const RecognizeOptions& options, const Deadline& deadline, RecognitionResult& result) {
  std::vector<bool> taken(scan.regions.size(), false);
  Stopwatch watch;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const ObjectHypothesis& hypothesis = hypotheses[i];
    if (uses_any(scan, hypothesis, taken)) continue;
    if (limits_reached(options, deadline, result)) return;
    const std::optional<Pose> start = estimate_pose(scan, hypothesis);
    if (!start) continue;
    const RefinedPose refined = refine(scan, hypothesis, *start, options, result, watch);
    if (!refined.verification.accepted) continue;
    result.detections.push_back(
        make_detection(scan, hypothesis, refined, static_cast<int>(i) + 1, EquivalentPose::as_found));
    for (const int region : result.detections.back().regions) taken[static_cast<std::size_t>(region)] = true;
    for (const int region :
         explained_regions(scan.model(hypothesis), refined.localization.T_sensor_model, scan.image, scan.regions)) {
      taken[static_cast<std::size_t>(region)] = true;
    }
    watch.lap(result.milliseconds.verify);
  }
}

}  // namespace foresight
