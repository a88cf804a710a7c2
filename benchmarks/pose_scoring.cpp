#include "benchmarks/pose_scoring.h"

#include <algorithm>
#include <limits>

namespace foresight {
namespace {

struct Pairing {
  std::size_t report = 0;
  std::size_t truth = 0;
  double distance = 0.0;  // MSSD to the nearest equally good pose
};

double nearest_distance(const ScoredObject& object, const Pose& reported, const TrueObject& truth) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Pose& pose : truth.poses) nearest = std::min(nearest, mssd(object, reported, pose));
  return nearest;
}

// What a report may be taken for.
using Readings = std::function<std::vector<PosedObject>(const ReportedObject&)>;

// All pairs of one object's reports, read in the same way, and instances, nearest first.
std::vector<Pairing> pairings(const std::vector<ScoredObject>& objects, const std::vector<TrueObject>& truth,
                              const std::vector<ReportedObject>& reported, const Readings& readings) {
  std::vector<Pairing> pairs;
  for (std::size_t r = 0; r < reported.size(); ++r) {
    for (const PosedObject& reading : readings(reported[r])) {
      for (std::size_t t = 0; t < truth.size(); ++t) {
        if (reading.object != truth[t].object) continue;
        const ScoredObject& object = objects[static_cast<std::size_t>(truth[t].object)];
        pairs.push_back({r, t, nearest_distance(object, reading.T_sensor_model, truth[t])});
      }
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pairing& a, const Pairing& b) { return a.distance < b.distance; });
  return pairs;
}

std::vector<PosedObject> itself(const ReportedObject& report) { return {{report.object, report.T_sensor_model}}; }
std::vector<PosedObject> its_alternatives(const ReportedObject& report) { return report.alternatives; }

// Whether each true object is reported whatever its pose: the paper's acceptance. Any report of its object will do,
// once.
std::vector<bool> named_objects(const std::vector<TrueObject>& truth, const std::vector<ReportedObject>& reported,
                                const std::vector<Pairing>& pairs) {
  std::vector<bool> named(truth.size(), false);
  std::vector<bool> used(reported.size(), false);
  for (const Pairing& pair : pairs) {
    if (named[pair.truth] || used[pair.report]) continue;
    named[pair.truth] = true;
    used[pair.report] = true;
  }
  return named;
}

// The verdict on a report that no instance took. declared: pairs with a right alternative.
Verdict verdict_alone(const std::vector<ScoredObject>& objects, const std::vector<ReportedObject>& reported,
                      std::size_t report, const std::vector<Pairing>& pairs, const std::vector<Pairing>& declared) {
  const bool declares =
      std::any_of(declared.begin(), declared.end(), [&](const Pairing& pair) { return pair.report == report; });
  if (declares) return Verdict::duplicate;
  const auto nearest =
      std::find_if(pairs.begin(), pairs.end(), [&](const Pairing& pair) { return pair.report == report; });
  if (nearest == pairs.end()) return Verdict::false_positive;
  const ScoredObject& object = objects[static_cast<std::size_t>(reported[report].object)];
  if (nearest->distance <= object.tolerance()) return Verdict::duplicate;
  return nearest->distance > kPresentShare * object.diameter ? Verdict::false_positive : Verdict::wrong_pose;
}

}  // namespace

ScoredObject scored_object(const CadModel& model) { return {model.vertices, find_symmetries(model), model.diameter()}; }

SceneVerdicts score_scene(const std::vector<ScoredObject>& objects, const std::vector<TrueObject>& truth,
                          const std::vector<ReportedObject>& reported, const CannotTell& cannot_tell) {
  const std::vector<Pairing> pairs = pairings(objects, truth, reported, itself);
  std::vector<Pairing> declared = pairings(objects, truth, reported, its_alternatives);
  const auto is_right = [&](const Pairing& pair) {
    return pair.distance <= objects[static_cast<std::size_t>(truth[pair.truth].object)].tolerance();
  };
  std::erase_if(declared, [&](const Pairing& pair) { return !is_right(pair); });
  SceneVerdicts verdicts;
  verdicts.reported.assign(reported.size(), Verdict::missed);
  verdicts.truth.assign(truth.size(), Verdict::missed);
  verdicts.named = named_objects(truth, reported, pairs);
  const auto take = [&](Verdict verdict, const std::vector<Pairing>& of,
                        const std::function<bool(const Pairing&)>& holds) {
    for (const Pairing& pair : of) {
      if (verdicts.reported[pair.report] != Verdict::missed || verdicts.truth[pair.truth] != Verdict::missed) continue;
      if (!holds(pair)) continue;
      verdicts.reported[pair.report] = verdict;
      verdicts.truth[pair.truth] = verdict;
    }
  };
  take(Verdict::right, pairs, is_right);
  take(Verdict::declared, declared, [](const Pairing&) { return true; });
  take(Verdict::indistinguishable, pairs, [&](const Pairing& pair) {
    const TrueObject& instance = truth[pair.truth];
    return !is_right(pair) && cannot_tell &&
           cannot_tell(instance.object, reported[pair.report].T_sensor_model, instance.poses.front());
  });
  for (std::size_t r = 0; r < reported.size(); ++r) {
    if (verdicts.reported[r] == Verdict::missed)
      verdicts.reported[r] = verdict_alone(objects, reported, r, pairs, declared);
  }
  return verdicts;
}

}  // namespace foresight
