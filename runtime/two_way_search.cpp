#include "runtime/two_way_search.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "runtime/canonical_pose.h"
#include "runtime/detection.h"
#include "runtime/interpenetration.h"
#include "runtime/pose_check.h"
#include "runtime/pose_evidence.h"
#include "runtime/rendering.h"
#include "runtime/settled_localization.h"
#include "runtime/start_search.h"

namespace foresight {
namespace {

// A refined pose that may be reported.
struct Candidate {
  std::size_t start = 0;  // that it came of
  int rank = 0;           // of the start in the order of trying
  Localization localization;
  double probability = 0.0;
  std::array<double, kEvidenceFeatureCount> features{};

  [[nodiscard]] const Pose& pose() const { return localization.T_sensor_model; }
};

struct AcceptedPose {
  int model = 0;
  Pose T_sensor_model;
};

constexpr double kNearSymmetricQuality = 0.8;        // of the pose found, for a near-symmetric one to be worth refining
constexpr int kMostDoublings = 12;                   // of a stretch of hypotheses
constexpr std::chrono::microseconds kDecision{800};  // about what it takes to decide on a candidate, and to report it
constexpr int kRoughStride = 2;                      // for a look at whether a start is worth refining
constexpr double kRivalQuality = 0.5;  // of the start of the pose found, for a rival's to be worth settling
constexpr double kRivalView = 0.9;     // of the cells a rival's start must show alike to be worth refining

StartSearchOptions start_search_options(const RecognizeOptions& options) {
  StartSearchOptions search;
  search.pruned = options.pruning != Pruning::none;
  return search;
}

class TwoWaySearch {
 public:
  TwoWaySearch(const ScanContext& scan, const RecognizeOptions& options, const TwoWayOptions& two_way,
               const Deadline& deadline, Recognition& result)
      : scan_(scan),
        options_(options),
        two_way_(two_way),
        deadline_(deadline),
        result_(result),
        labelled_(label_scan(scan.image, scan.camera, scan.database.content().sensor, scan.regions)),
        fine_(judging_options(labelled_.sensor)),
        checker_(scan.database, labelled_),
        settling_(scan.database, labelled_, settling_options(labelled_.sensor)),
        search_(scan.database, labelled_, start_search_options(options), counts_, stop()) {}

  // Looks for starts and tries them by turns: the best rated hypotheses are right so often that what they find, and
  // take, spares looking at most of the others. Starts that look less well wait until more are known.
  void run() {
    bool more = true;
    for (int turn = 0; more && !out_of_limits(); ++turn) {
      watch_.lap(result_.milliseconds.verify);
      more = search_.look_further(two_way_.first_stretch << std::min(turn, kMostDoublings), stop());
      watch_.lap(result_.milliseconds.hypotheses);
      try_starts(more ? std::max(two_way_.eager_quality - turn * two_way_.eager_step, two_way_.least_eager) : 0.0);
    }
    decide_among_candidates();
    result_.statistics.threshold_matches = counts_.matches;
    result_.statistics.active_matches = counts_.matches;
    result_.statistics.hypotheses = counts_.hypotheses;
    result_.statistics.pose_checks += counts_.checks;
  }

 private:
  [[nodiscard]] const CompiledModel& model_of(std::size_t start) const {
    return scan_.database.models()[static_cast<std::size_t>(start_pose(start).model)];
  }
  [[nodiscard]] const StartPose& start_pose(std::size_t start) const { return search_.starts()[start]; }
  // Of all starts for which `wanted` holds, the best looking first.
  template <typename Wanted>
  [[nodiscard]] PoolVector<std::size_t> best_starts(const Wanted& wanted) const {
    PoolVector<std::size_t> best;
    for (std::size_t i = 0; i < search_.starts().size(); ++i) {
      if (wanted(i)) best.push_back(i);
    }
    const auto place = [this](std::size_t i) { return std::pair(-start_pose(i).quality, i); };
    std::sort(best.begin(), best.end(), [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
    return best;
  }
  // In time to decide on what waits, and on what may be in hand.
  [[nodiscard]] bool out_of_limits() const {
    if (!deadline_) return limits_reached(options_, deadline_, result_);
    return limits_reached(options_, *deadline_ - (1 + static_cast<int>(candidates_.size())) * kDecision, result_);
  }
  [[nodiscard]] Stop stop() const {
    return [this] { return out_of_limits(); };
  }
  [[nodiscard]] bool uses_taken(const StartPose& start) const {
    return std::any_of(start.regions.begin(), start.regions.end(),
                       [&](int region) { return is_taken(labelled_, region); });
  }
  [[nodiscard]] PoseEvidence evidence(std::size_t start, const Pose& pose) const {
    return gather_evidence(model_of(start), pose, labelled_, fine_);
  }
  // Whether it stands in one of the objects accepted so far, or one of them in it.
  [[nodiscard]] bool penetrates_accepted(const Candidate& candidate) const {
    const double depth = two_way_.penetration * fine_.distance;
    return std::any_of(accepted_.begin(), accepted_.end(), [&](const AcceptedPose& other) {
      const CompiledModel& a = model_of(candidate.start);
      const CompiledModel& b = scan_.database.models()[static_cast<std::size_t>(other.model)];
      return share_inside(a, candidate.pose(), b, other.T_sensor_model, depth) > two_way_.most_inside ||
             share_inside(b, other.T_sensor_model, a, candidate.pose(), depth) > two_way_.most_inside;
    });
  }
  [[nodiscard]] Rendering drawn(std::size_t start, const Pose& pose) const {
    return render(model_of(start), pose, scan_.camera);
  }
  [[nodiscard]] double quality(std::size_t start, const Pose& pose) {
    ++result_.statistics.pose_checks;
    return checker_.check(start_pose(start).model, pose).quality();
  }

  // Counts tries of the same regions with one model.
  int& tries_of(const StartPose& start) {
    PoolVector<int> key = start.regions;
    std::sort(key.begin(), key.end());
    key.push_back(start.model);
    return tries_[key];
  }

  // Whether training saw anything come of starts like this. Read anew: regions may have been taken since it was found.
  bool worth_refining(std::size_t start) {
    const AcceptanceModel& acceptance = model_of(start).acceptance;
    const Pose& pose = start_pose(start).T_sensor_model;
    if (quality(start, pose) < acceptance.least_quality) return false;
    EvidenceOptions rough;
    rough.distance = kStartDistance;
    rough.stride = kRoughStride * fine_.stride;
    return probability_right(acceptance, gather_evidence(model_of(start), pose, labelled_, rough)) >=
           acceptance.least_probability;
  }

  Candidate refined(std::size_t start, const Pose& from) {
    watch_.lap(result_.milliseconds.verify);
    Candidate candidate;
    candidate.start = start;
    candidate.rank = order_;
    const SettledPose settled =
        localize_and_settle(scan_, labelled_, start_pose(start).model, from, options_, settling_, stop());
    candidate.localization = settled.localization;
    ++result_.statistics.verifications;
    result_.statistics.energy_evaluations += candidate.localization.energy_evaluations;
    watch_.lap(result_.milliseconds.localize);
    candidate.features = evidence_features(settled.evidence);
    candidate.probability = probability_right(model_of(start).acceptance, candidate.features);
    return candidate;
  }

  // All that are untried and look this well, the best first. Trying one may find others, of its rivals.
  void try_starts(double least_quality) {
    while (true) {
      tried_.resize(search_.starts().size(), false);
      const auto untried =
          best_starts([&](std::size_t i) { return !tried_[i] && start_pose(i).quality >= least_quality; });
      if (untried.empty()) return;
      for (const std::size_t i : untried) {
        if (out_of_limits()) return;
        tried_[i] = true;
        ++order_;
        if (!uses_taken(start_pose(i))) try_start(i);
      }
    }
  }

  void try_start(std::size_t i) {
    int& tries = tries_of(start_pose(i));
    if (tries >= two_way_.most_tries || !worth_refining(i) || out_of_limits()) return;
    ++tries;
    Candidate candidate = refined(i, start_pose(i).T_sensor_model);
    if (candidate.probability < two_way_.accepted) return;
    prefer_near_symmetric(candidate);
    prefer_rival(candidate);
    if (penetrates_accepted(candidate)) return;
    if (candidate.probability >= two_way_.sure) {
      accept(candidate);
    } else {
      candidates_.push_back(candidate);
    }
  }

  // An object that looks almost the same after some turn is easily found turned: the better pose counts.
  void prefer_near_symmetric(Candidate& candidate) {
    const double least = kNearSymmetricQuality * quality(candidate.start, candidate.pose());
    for (const Pose& turned : near_symmetric_poses(model_of(candidate.start), candidate.pose())) {
      if (out_of_limits()) return;
      if (quality(candidate.start, turned) < least) continue;
      const Candidate other = refined(candidate.start, turned);
      if (other.probability > candidate.probability) candidate = other;
    }
  }

  // Other starts for the same regions, of any object, may explain them better still. What they explain when settled on
  // planes tells which are worth localizing.
  void prefer_rival(Candidate& candidate) {
    look_for_rivals(candidate);
    int looked_at = 0;
    const double least = kRivalQuality * start_pose(candidate.start).quality;
    for (const std::size_t i : rivals(candidate)) {
      if (looked_at++ == two_way_.most_rivals || start_pose(i).quality < least || out_of_limits()) return;
      if (i < tried_.size() && tried_[i]) continue;
      const Pose settled = settle(scan_, start_pose(i).model, start_pose(i).T_sensor_model, settling_);
      if (already_known({candidate}, i, settled)) continue;
      EvidenceOptions rough = fine_;
      rough.stride *= kRoughStride;
      const PoseEvidence evidence = gather_evidence(model_of(i), settled, labelled_, rough);
      if (!speaks_more_for(i, evidence_features(evidence), candidate)) continue;
      if (out_of_limits()) return;
      const Candidate rival = refined(i, settled);
      if (rival.probability >= two_way_.accepted && speaks_more_for(i, rival.features, candidate)) candidate = rival;
    }
  }

  // Whether evidence for a rival is stronger than that for the candidate, by the judges of both their objects together:
  // each knows what right poses of its own look like, and one may be more easily convinced than the other.
  [[nodiscard]] bool speaks_more_for(std::size_t rival, const std::array<double, kEvidenceFeatureCount>& features,
                                     const Candidate& candidate) const {
    double more = 0.0;
    for (const std::size_t judge : {rival, candidate.start}) {
      const AcceptanceModel& acceptance = model_of(judge).acceptance;
      more += log_odds_right(acceptance, features) - log_odds_right(acceptance, candidate.features);
    }
    return more > 0.0;
  }

  // What would show the same matches the regions of which the pose explains most.
  void look_for_rivals(const Candidate& candidate) {
    watch_.lap(result_.milliseconds.verify);
    PoolMap<int, double> cells;
    for (const FaceSupport& support : checker_.check(start_pose(candidate.start).model, candidate.pose()).supports) {
      if (!is_taken(labelled_, support.region)) cells[support.region] += support.cells;
    }
    PoolVector<std::pair<double, int>> regions;
    for (const auto& [region, count] : cells) regions.push_back({-count, region});
    std::sort(regions.begin(), regions.end());
    if (!regions.empty()) {
      search_.look_for_rivals(regions[0].second, regions.size() > 1 ? regions[1].second : -1, stop());
    }
    watch_.lap(result_.milliseconds.hypotheses);
  }

  // Other starts that rest on the same regions, the best looking first.
  [[nodiscard]] PoolVector<std::size_t> rivals(const Candidate& candidate) const {
    return best_starts([&](std::size_t i) {
      return i != candidate.start && shares_region(start_pose(i), start_pose(candidate.start)) &&
             !uses_taken(start_pose(i));
    });
  }

  [[nodiscard]] static bool shares_region(const StartPose& a, const StartPose& b) {
    return std::any_of(a.regions.begin(), a.regions.end(),
                       [&](int region) { return std::count(b.regions.begin(), b.regions.end(), region) > 0; });
  }

  // Takes the regions that the pose explains for the most part, and those it was made of.
  void accept(const Candidate& candidate) {
    const CompiledModel& model = model_of(candidate.start);
    const CanonicalPose reported = canonical_choice(model, candidate.pose());
    RefinedPose pose{candidate.localization, {}};
    pose.localization.T_sensor_model = reported.T_sensor_model;
    pose.verification = verify(model, scan_.sphere, reported.T_sensor_model, scan_.image, scan_.camera, scan_.data,
                               verification_options(options_));
    FoundObject found;
    found.model = start_pose(candidate.start).model;
    found.pose = pose;
    found.score = candidate.probability;
    found.rank = candidate.rank;
    found.covariance = covariance_at(model, reported.T_sensor_model, scan_.image, scan_.camera, labelled_.sensor);
    list_supports(reported.T_sensor_model, found);
    found.alternatives = alternatives(candidate);
    take_explained(model, candidate.pose(), fine_, labelled_);
    accepted_.push_back({start_pose(candidate.start).model, candidate.pose()});
    result_.objects.push_back(std::move(found));
  }

  // Faces with the regions that show them: each region once, with the face that most of it shows.
  void list_supports(const Pose& pose, FoundObject& found) {
    const PoolVector<FaceSupport> supports = checker_.check(found.model, pose).supports;
    PoolVector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < supports.size(); ++i) order.push_back({-supports[i].cells, i});
    std::sort(order.begin(), order.end());
    for (const auto& [cells, i] : order) {
      const FaceSupport& support = supports[i];
      if (std::count(found.regions.begin(), found.regions.end(), support.region) > 0) continue;
      found.faces.push_back(support.face);
      found.regions.push_back(support.region);
    }
  }

  // What else would show the same: other poses and objects that fit where this one does.
  PoolVector<FoundAlternative> alternatives(const Candidate& candidate) {
    const Rendering view = drawn(candidate.start, candidate.pose());
    PoolVector<Candidate> found = {candidate};
    int looked_at = 0;
    for (const std::size_t i : rivals(candidate)) {
      const StartPose& rival = start_pose(i);
      if (looked_at == two_way_.most_rivals || out_of_limits()) break;
      if (already_known(found, i, rival.T_sensor_model)) continue;
      ++looked_at;
      if (same_share(view, drawn(i, rival.T_sensor_model), two_way_.same_distance) < kRivalView) continue;
      const Candidate other = refined(i, rival.T_sensor_model);
      if (other.probability < two_way_.accepted || already_known(found, i, other.pose())) continue;
      if (same_share(view, drawn(i, other.pose()), two_way_.same_distance) < two_way_.same_view) continue;
      found.push_back(other);
    }
    PoolVector<FoundAlternative> listed;
    for (std::size_t k = 1; k < found.size(); ++k) {
      const Pose canonical = canonical_pose(model_of(found[k].start), found[k].pose());
      listed.push_back({start_pose(found[k].start).model, canonical, found[k].probability});
    }
    return listed;
  }

  // Whether one of the candidates is this pose of this model, but for a symmetry.
  [[nodiscard]] bool already_known(const PoolVector<Candidate>& found, std::size_t start, const Pose& pose) const {
    const CompiledModel& model = model_of(start);
    const StartSearchOptions same;
    const auto equals = [&](const Pose& a, const Pose& b) {
      return (a * model.centre - b * model.centre).norm() <= 2.0 * same.same_distance &&
             rotation_angle(a.rotation.transpose() * b.rotation) <= 2.0 * same.same_angle;
    };
    return std::any_of(found.begin(), found.end(), [&](const Candidate& other) {
      if (start_pose(other.start).model != start_pose(start).model) return false;
      if (equals(other.pose(), pose)) return true;
      return std::any_of(model.symmetries.begin(), model.symmetries.end(), [&](const Symmetry& symmetry) {
        return symmetry.exact && equals(other.pose() * symmetry.T_model_model, pose);
      });
    });
  }

  // The most probable first. What the others rest on may have been taken since: their evidence is read again.
  void decide_among_candidates() {
    const auto place = [](const Candidate& c) { return std::pair(-c.probability, c.rank); };
    std::sort(candidates_.begin(), candidates_.end(),
              [&](const Candidate& a, const Candidate& b) { return place(a) < place(b); });
    for (Candidate& candidate : candidates_) {
      const auto most = static_cast<std::size_t>(options_.most_detections);
      if (most > 0 && result_.objects.size() >= most) break;
      if (uses_taken(start_pose(candidate.start))) continue;
      candidate.probability =
          probability_right(model_of(candidate.start).acceptance, evidence(candidate.start, candidate.pose()));
      if (candidate.probability >= two_way_.accepted && !penetrates_accepted(candidate)) accept(candidate);
    }
    watch_.lap(result_.milliseconds.verify);
  }

  const ScanContext& scan_;
  const RecognizeOptions& options_;
  const TwoWayOptions two_way_;
  const Deadline& deadline_;
  Recognition& result_;
  LabelledScan labelled_;
  EvidenceOptions fine_;
  PoseChecker checker_;
  PoseChecker settling_;
  PoolVector<Candidate> candidates_;  // before search_, which asks out_of_limits as it is made
  StartSearchCounts counts_;
  StartSearch search_;
  PoolVector<bool> tried_;  // by start
  int order_ = 0;           // starts taken up so far
  PoolVector<AcceptedPose> accepted_;
  PoolMap<PoolVector<int>, int> tries_;  // by regions and model
  Stopwatch watch_;
};

}  // namespace

void search_two_way(const ScanContext& scan, const RecognizeOptions& options, const Deadline& deadline,
                    Recognition& result, const TwoWayOptions& two_way) {
  TwoWaySearch(scan, options, two_way, deadline, result).run();
}

}  // namespace foresight
