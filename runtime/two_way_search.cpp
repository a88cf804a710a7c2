#include "runtime/two_way_search.h"

#include <algorithm>
#include <map>

#include "runtime/pose_check.h"
#include "runtime/pose_evidence.h"
#include "runtime/start_search.h"

namespace foresight {
namespace {

constexpr int kSettlings = 3;
constexpr double kLocalizationError = 1.0;  // one step. Unit: mm.

// A refined pose that may be reported.
struct Candidate {
  std::size_t start = 0;
  RefinedPose refined;
  double probability = 0.0;
};

class TwoWaySearch {
 public:
  TwoWaySearch(const ScanContext& scan, const RecognizeOptions& options, const TwoWayOptions& two_way,
               RecognitionResult& result)
      : scan_(scan),
        options_(options),
        two_way_(two_way),
        result_(result),
        labelled_(label_scan(scan.image, scan.camera, scan.database.content().sensor, scan.regions)),
        checker_(scan.database, labelled_),
        settling_(scan.database, labelled_, settling_options(labelled_.sensor)) {}

  void run(const Deadline& deadline) {
    StartSearchCounts counts;
    starts_ = find_starts(scan_.database, labelled_, {}, counts);
    result_.statistics.threshold_matches = counts.matches;
    result_.statistics.active_matches = counts.matches;
    result_.statistics.hypotheses = counts.hypotheses;
    result_.statistics.pose_checks = counts.checks;
    watch_.lap(result_.milliseconds.hypotheses);
    for (std::size_t i = 0; i < starts_.size() && !limits_reached(options_, deadline, result_); ++i) {
      if (!uses_taken(starts_[i])) try_start(i);
    }
    decide_among_candidates();
  }

 private:
  [[nodiscard]] const CompiledModel& model(const StartPose& start) const {
    return scan_.database.models()[static_cast<std::size_t>(start.model)];
  }
  [[nodiscard]] bool uses_taken(const StartPose& start) const {
    return std::any_of(start.regions.begin(), start.regions.end(),
                       [&](int region) { return labelled_.taken[static_cast<std::size_t>(region)]; });
  }
  [[nodiscard]] PoseEvidence evidence(const Candidate& candidate) const {
    EvidenceOptions fine;
    fine.distance = agreeing_distance(labelled_.sensor);
    return gather_evidence(model(starts_[candidate.start]), candidate.refined.localization.T_sensor_model, labelled_,
                           fine);
  }
  // Counts tries of the same regions with one model.
  bool tried_enough(const StartPose& start) {
    std::vector<int> key = start.regions;
    std::sort(key.begin(), key.end());
    key.push_back(start.model);
    return ++tries_[key] > two_way_.most_tries;
  }

  void try_start(std::size_t i) {
    const StartPose& start = starts_[i];
    const CompiledModel& compiled = model(start);
    // Read again: regions may have been taken since.
    ++result_.statistics.pose_checks;
    const double quality = checker_.check(start.model, start.T_sensor_model).quality();
    EvidenceOptions rough;
    rough.distance = two_way_.start_distance;
    const bool worth =
        quality >= compiled.acceptance.least_quality &&
        probability_right(compiled.acceptance, gather_evidence(compiled, start.T_sensor_model, labelled_, rough)) >=
            compiled.acceptance.least_probability;
    watch_.lap(result_.milliseconds.verify);
    if (!worth) return;
    if (tried_enough(start)) return;
    Candidate candidate{i, {}, 0.0};
    candidate.refined.localization =
        localize_and_settle(compiled, start.model, start.T_sensor_model, scan_, labelled_, options_, settling_);
    ++result_.statistics.verifications;
    result_.statistics.energy_evaluations += candidate.refined.localization.energy_evaluations;
    watch_.lap(result_.milliseconds.localize);
    candidate.probability = probability_right(compiled.acceptance, evidence(candidate));
    watch_.lap(result_.milliseconds.verify);
    if (candidate.probability >= two_way_.sure) {
      accept(candidate);
    } else if (candidate.probability >= two_way_.accepted) {
      candidates_.push_back(candidate);
    }
  }

  // Takes the regions that the pose explains for the most part, and those it was made of.
  void accept(const Candidate& candidate) {
    const StartPose& start = starts_[candidate.start];
    const Pose& pose = candidate.refined.localization.T_sensor_model;
    RefinedPose refined = candidate.refined;
    refined.verification =
        verify(model(start), scan_.sphere, pose, scan_.image, scan_.camera, scan_.data, verification_options(options_));
    Detection detection = to_detection(model(start), refined);
    detection.rank = static_cast<int>(candidate.start) + 1;
    detection.score = candidate.probability;
    list_supports(start.model, pose, detection);
    const PoseEvidence found = evidence(candidate);
    for (const int region : start.regions) labelled_.taken[static_cast<std::size_t>(region)] = true;
    for (std::size_t r = 0; r < scan_.regions.size(); ++r) {
      if (2 * static_cast<std::size_t>(found.explained_of_region[r]) >= scan_.regions[r].region.cells.size()) {
        labelled_.taken[r] = true;
      }
    }
    result_.detections.push_back(std::move(detection));
  }

  // Faces with the regions that show them: each region once, with the face that most of it shows.
  void list_supports(int model, const Pose& pose, Detection& detection) {
    std::vector<FaceSupport> supports = checker_.check(model, pose).supports;
    std::stable_sort(supports.begin(), supports.end(),
                     [](const FaceSupport& a, const FaceSupport& b) { return a.cells > b.cells; });
    for (const FaceSupport& support : supports) {
      if (std::count(detection.regions.begin(), detection.regions.end(), support.region) > 0) continue;
      detection.faces.push_back(support.face);
      detection.regions.push_back(support.region);
    }
  }

  // The most probable first. What the others rest on may have been taken since: their evidence is read again.
  void decide_among_candidates() {
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.probability > b.probability; });
    for (Candidate& candidate : candidates_) {
      const auto most = static_cast<std::size_t>(options_.most_detections);
      if (most > 0 && result_.detections.size() >= most) break;
      if (uses_taken(starts_[candidate.start])) continue;
      candidate.probability = probability_right(model(starts_[candidate.start]).acceptance, evidence(candidate));
      if (candidate.probability >= two_way_.accepted) accept(candidate);
    }
    watch_.lap(result_.milliseconds.verify);
  }

  const ScanContext& scan_;
  const RecognizeOptions& options_;
  const TwoWayOptions two_way_;
  RecognitionResult& result_;
  LabelledScan labelled_;
  PoseChecker checker_;
  PoseChecker settling_;
  std::vector<StartPose> starts_;
  std::vector<Candidate> candidates_;
  std::map<std::vector<int>, int> tries_;  // by regions and model
  Stopwatch watch_;
};

}  // namespace

PoseCheckOptions settling_options(const SensorModel& sensor) {
  PoseCheckOptions options;
  options.distance = kLocalizationError + agreeing_distance(sensor);
  return options;
}

Localization localize_and_settle(const CompiledModel& model, int model_index, const Pose& start,
                                 const ScanContext& scan, const LabelledScan& labelled, const RecognizeOptions& options,
                                 PoseChecker& checker) {
  LocalizationOptions localization = localization_options(options);
  localization.reach = kTwoWayReach;
  Localization localized = localize(model, scan.sphere, start, scan.data, localization);
  Pose settled = localized.T_sensor_model;
  for (int i = 0; i < kSettlings; ++i) {
    settled = refit_to_planes(model, settled, checker.check(model_index, settled), scan.regions);
  }
  EvidenceOptions fine;
  fine.distance = agreeing_distance(labelled.sensor);
  const auto balance = [&](const Pose& pose) {
    const PoseEvidence evidence = gather_evidence(model, pose, labelled, fine);
    return evidence.owned - evidence.behind - evidence.tilted - evidence.front;
  };
  if (balance(settled) > balance(localized.T_sensor_model)) localized.T_sensor_model = settled;
  return localized;
}

void search_two_way(const ScanContext& scan, const RecognizeOptions& options, const Deadline& deadline,
                    RecognitionResult& result, const TwoWayOptions& two_way) {
  TwoWaySearch(scan, options, two_way, result).run(deadline);
}

}  // namespace foresight
