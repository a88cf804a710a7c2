#include "runtime/two_way_search.h"

#include <algorithm>

#include "runtime/pose_evidence.h"

namespace foresight {
namespace {

// A refined pose that may be reported.
struct Candidate {
  std::size_t hypothesis = 0;
  RefinedPose refined;
  double probability = 0.0;
};

// The poses of one model that were looked at.
class TriedPoses {
 public:
  TriedPoses(std::size_t models, const TwoWayOptions& options) : poses_(models), options_(options) {}

  // Whether a pose near this one is there already; adds it where not.
  bool seen(const CompiledModel& model, int index, const Pose& pose) {
    std::vector<Pose>& poses = poses_[static_cast<std::size_t>(index)];
    const Eigen::Vector3d centre = pose * model.centre;
    // trace(A^T B) = 1 + 2 cos(angle between A and B)
    const double least_trace = 1.0 + 2.0 * std::cos(options_.same_angle);
    for (const Pose& other : poses) {
      if ((other * model.centre - centre).squaredNorm() > options_.same_distance * options_.same_distance) continue;
      if (other.rotation.cwiseProduct(pose.rotation).sum() >= least_trace) return true;
    }
    poses.push_back(pose);
    return false;
  }

 private:
  std::vector<std::vector<Pose>> poses_;
  const TwoWayOptions& options_;
};

class TwoWaySearch {
 public:
  TwoWaySearch(const ScanContext& scan, const std::vector<ObjectHypothesis>& hypotheses,
               const RecognizeOptions& options, const TwoWayOptions& two_way, RecognitionResult& result)
      : scan_(scan),
        hypotheses_(hypotheses),
        options_(options),
        two_way_(two_way),
        result_(result),
        labelled_(label_scan(scan.image, scan.camera, scan.database.content().sensor, scan.regions)),
        tried_(scan.database.models().size(), two_way_) {}

  void run(const Deadline& deadline) {
    for (std::size_t i = 0; i < hypotheses_.size() && !limits_reached(options_, deadline, result_); ++i) {
      if (!uses_any(scan_, hypotheses_[i], labelled_.taken)) try_hypothesis(i);
    }
    decide_among_candidates();
  }

 private:
  [[nodiscard]] PoseEvidence evidence(std::size_t i, const Pose& pose, const EvidenceOptions& options = {}) const {
    return gather_evidence(scan_.model(hypotheses_[i]), pose, labelled_, options);
  }

  void try_hypothesis(std::size_t i) {
    const ObjectHypothesis& hypothesis = hypotheses_[i];
    const CompiledModel& model = scan_.model(hypothesis);
    const std::optional<Pose> start = estimate_pose(scan_, hypothesis);
    if (!start || tried_.seen(model, hypothesis.model, *start)) return;
    ++result_.statistics.pose_checks;
    EvidenceOptions rough;
    rough.distance = two_way_.start_distance;
    const PoseEvidence at_start = evidence(i, *start, rough);
    watch_.lap(result_.milliseconds.verify);
    if (at_start.explained <= model.acceptance.least_overlap * at_start.drawn) return;

    Candidate candidate{i, refine(scan_, hypothesis, *start, options_, result_, watch_), 0.0};
    const Pose& pose = candidate.refined.localization.T_sensor_model;
    (void)tried_.seen(model, hypothesis.model, pose);
    candidate.probability = probability_right(model.acceptance, evidence(i, pose));
    watch_.lap(result_.milliseconds.verify);
    if (candidate.probability >= two_way_.sure) {
      accept(candidate);
    } else if (candidate.probability >= two_way_.accepted) {
      candidates_.push_back(candidate);
    }
  }

  // Takes the regions that the pose explains for the most part, and those it was made of.
  void accept(const Candidate& candidate) {
    const ObjectHypothesis& hypothesis = hypotheses_[candidate.hypothesis];
    const Pose& pose = candidate.refined.localization.T_sensor_model;
    const PoseEvidence found = evidence(candidate.hypothesis, pose);
    Detection detection =
        make_detection(scan_, hypothesis, candidate.refined, static_cast<int>(candidate.hypothesis) + 1);
    detection.score = candidate.probability;
    for (const int region : detection.regions) labelled_.taken[static_cast<std::size_t>(region)] = true;
    for (std::size_t r = 0; r < scan_.regions.size(); ++r) {
      if (2 * static_cast<std::size_t>(found.explained_of_region[r]) >= scan_.regions[r].region.cells.size()) {
        labelled_.taken[r] = true;
      }
    }
    result_.detections.push_back(std::move(detection));
  }

  // The most probable first. What the others rest on may have been taken since: their evidence is read again.
  void decide_among_candidates() {
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.probability > b.probability; });
    for (Candidate& candidate : candidates_) {
      const auto most = static_cast<std::size_t>(options_.most_detections);
      if (most > 0 && result_.detections.size() >= most) break;
      const std::size_t i = candidate.hypothesis;
      if (uses_any(scan_, hypotheses_[i], labelled_.taken)) continue;
      candidate.probability = probability_right(scan_.model(hypotheses_[i]).acceptance,
                                                evidence(i, candidate.refined.localization.T_sensor_model));
      if (candidate.probability >= two_way_.accepted) accept(candidate);
    }
    watch_.lap(result_.milliseconds.verify);
  }

  const ScanContext& scan_;
  const std::vector<ObjectHypothesis>& hypotheses_;
  const RecognizeOptions& options_;
  const TwoWayOptions two_way_;
  RecognitionResult& result_;
  LabelledScan labelled_;
  TriedPoses tried_;
  std::vector<Candidate> candidates_;
  Stopwatch watch_;
};

}  // namespace

void search_two_way(const ScanContext& scan, const std::vector<ObjectHypothesis>& hypotheses,
                    const RecognizeOptions& options, const Deadline& deadline, RecognitionResult& result,
                    const TwoWayOptions& two_way) {
  TwoWaySearch(scan, hypotheses, options, two_way, result).run(deadline);
}

}  // namespace foresight
