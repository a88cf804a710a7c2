#include "runtime/two_way_search.h"

#include <algorithm>

#include "runtime/pose_check.h"
#include "runtime/pose_evidence.h"
#include "runtime/start_search.h"

namespace foresight {
namespace {

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
        checker_(scan.database, labelled_) {}

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
    return gather_evidence(model(starts_[candidate.start]), candidate.refined.localization.T_sensor_model, labelled_);
  }

  void try_start(std::size_t i) {
    const StartPose& start = starts_[i];
    const CompiledModel& compiled = model(start);
    // Read again: regions may have been taken since.
    ++result_.statistics.pose_checks;
    const double quality = checker_.check(start.model, start.T_sensor_model).quality();
    EvidenceOptions rough;
    rough.distance = two_way_.start_distance;
    const bool worth = quality >= compiled.acceptance.least_quality &&
                       probability_right(compiled.acceptance, gather_evidence(compiled, start.T_sensor_model, labelled_,
                                                                              rough)) >= compiled.acceptance.least_probability;
    watch_.lap(result_.milliseconds.verify);
    if (!worth) return;
    Candidate candidate{i, refine(scan_, compiled, start.T_sensor_model, options_, result_, watch_), 0.0};
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
    Detection detection = to_detection(model(start), candidate.refined);
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
  std::vector<StartPose> starts_;
  std::vector<Candidate> candidates_;
  Stopwatch watch_;
};

}  // namespace

void search_two_way(const ScanContext& scan, const RecognizeOptions& options, const Deadline& deadline,
                    RecognitionResult& result, const TwoWayOptions& two_way) {
  TwoWaySearch(scan, options, two_way, result).run(deadline);
}

}  // namespace foresight
