#include "runtime/verify_in_order.h"

#include <algorithm>

#include "runtime/detection.h"
#include "runtime/explained_regions.h"
#include "runtime/pose_from_matches.h"

namespace foresight {
namespace {

class VerificationInOrder {
 public:
  VerificationInOrder(const ScanContext& scan, const HypothesisField& field, const RecognizeOptions& options,
                      Recognition& result)
      : scan_(scan), field_(field), options_(options), result_(result), taken_(scan.regions.size(), false) {}

  void run(const PoolVector<ObjectHypothesis>& hypotheses, const Deadline& deadline) {
    for (std::size_t i = 0; i < hypotheses.size(); ++i) {
      if (uses_taken(hypotheses[i])) continue;
      if (limits_reached(options_, deadline, result_)) return;
      verify_one(hypotheses[i], static_cast<int>(i) + 1);
    }
  }

 private:
  [[nodiscard]] const Match& match(int index) const { return field_.matches[static_cast<std::size_t>(index)]; }

  [[nodiscard]] bool uses_taken(const ObjectHypothesis& hypothesis) const {
    return std::any_of(hypothesis.matches.begin(), hypothesis.matches.end(),
                       [&](int index) { return taken_[static_cast<std::size_t>(match(index).region)]; });
  }

  // The pose of the matches, none where they do not determine one.
  [[nodiscard]] std::optional<Pose> estimate_pose(const ObjectHypothesis& hypothesis) const {
    PoolVector<RegionFaceMatch> matches;
    for (const int index : hypothesis.matches) {
      const auto region = static_cast<std::size_t>(match(index).region);
      matches.push_back({&scan_.regions[region], &scan_.database.face(match(index).face)});
    }
    return pose_from_matches(matches);
  }

  void verify_one(const ObjectHypothesis& hypothesis, int rank) {
    const std::optional<Pose> start = estimate_pose(hypothesis);
    if (!start) return;
    const CompiledModel& model = scan_.database.models()[static_cast<std::size_t>(hypothesis.model)];
    const RefinedPose refined = refine(scan_, model, *start, options_, result_, watch_);
    if (!refined.verification.accepted) return;
    FoundObject found;
    found.model = hypothesis.model;
    found.pose = refined;
    found.score = refined.verification.matched;
    found.rank = rank;
    found.covariance = covariance_at(model, refined.localization.T_sensor_model, scan_.image, scan_.camera,
                                     scan_.database.content().sensor);
    for (const int index : hypothesis.matches) {
      found.faces.push_back(scan_.database.faces()[static_cast<std::size_t>(match(index).face)].face);
      found.regions.push_back(match(index).region);
    }
    for (const int region : found.regions) taken_[static_cast<std::size_t>(region)] = true;
    const Pose& pose = refined.localization.T_sensor_model;
    for (const int region : explained_regions(model, pose, scan_.image, scan_.regions)) {
      taken_[static_cast<std::size_t>(region)] = true;
    }
    result_.objects.push_back(std::move(found));
    watch_.lap(result_.milliseconds.verify);
  }

  const ScanContext& scan_;
  const HypothesisField& field_;
  const RecognizeOptions& options_;
  Recognition& result_;
  PoolVector<bool> taken_;  // by region
  Stopwatch watch_;
};

}  // namespace

void verify_in_order(const ScanContext& scan, const HypothesisField& field,
                     const PoolVector<ObjectHypothesis>& hypotheses, const RecognizeOptions& options,
                     const Deadline& deadline, Recognition& result) {
  VerificationInOrder(scan, field, options, result).run(hypotheses, deadline);
}

}  // namespace foresight
