// What a series of recognized scenes comes to.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/pose_scoring.h"
#include "benchmarks/table.h"
#include "runtime/foresight.h"

namespace foresight {

// One scan, recognized and scored.
struct SceneRecord {
  std::string method;  // of the contestant
  std::string name;
  std::vector<TrueObject> truth;
  std::vector<ReportedObject> reported;
  std::vector<int> ranks;      // of the reports' hypotheses, from 1
  std::vector<double> scores;  // of the reports
  SceneVerdicts verdicts;
  Statistics statistics;
  StageTimes milliseconds;

  // No object of the scene was named: the paper's recognition failure.
  [[nodiscard]] bool failed() const;
};

struct SummaryRow {
  std::string method;  // of the scenes, empty over none
  std::string label;
  long scenes = 0;
  long objects = 0;            // true objects counted
  long named = 0;              // of them reported, whatever the pose: what the paper counts
  long right = 0;              // of them reported with the right pose
  long declared = 0;           // of them reported with a right alternative only
  long indistinguishable = 0;  // of them reported with a pose that the view cannot tell from the true one
  long reported = 0;
  long false_positives = 0;
  long wrong_poses = 0;
  long duplicates = 0;
  double regions = 0.0;  // means over the scenes from here; NaN over none
  double possible_matches = 0.0;
  double threshold_matches = 0.0;
  double active_matches = 0.0;
  double hypotheses = 0.0;
  double verifications = 0.0;
  double verifications_when_found = 0.0;  // without the failed scenes
  double energy_evaluations = 0.0;
  double energy_evaluations_when_found = 0.0;
  double rank = 0.0;  // of the hypotheses of reports that are right, declared or indistinguishable
  StageTimes milliseconds;
};

// Means and reports are those of all scenes; the true objects counted are those with a visible fraction in [from,
// below).
struct VisibleRange {
  double from = 0.0;
  double below = 2.0;
};
[[nodiscard]] SummaryRow summarize(const std::string& label, const std::vector<SceneRecord>& scenes,
                                   const VisibleRange& visible = {});

// A share that a table shows with its interval: scenes with a false report, for instance.
struct CountedShare {
  std::string method;
  std::string label;
  long hits = 0;
  long trials = 0;
};
// One row a share: method, set, n, seed, hits, percent, 95 % interval.
[[nodiscard]] Table share_table(const std::vector<CountedShare>& shares, std::uint64_t seed);

// Three shares a row: right, declared, and either of them.
[[nodiscard]] Table declared_table(const std::vector<SummaryRow>& rows, std::uint64_t seed);

// All columns, with 95 % intervals, n and the seed; times last, because they alone differ between runs.
[[nodiscard]] Table summary_table(const std::vector<SummaryRow>& rows, std::uint64_t seed);

// The columns one looks at first.
[[nodiscard]] Table short_table(const std::vector<SummaryRow>& rows);

// One row a true object and a report, for looking into a result: scene, kind, object, verdict, visible fraction.
// Is a score a probability? Reports by method and score, in bins: how many, mean score, share that is right or
// indistinguishable with its interval.
[[nodiscard]] Table calibration_table(const std::vector<SceneRecord>& scenes);

[[nodiscard]] Table scene_table(const std::vector<SceneRecord>& scenes, const std::vector<std::string>& object_names);

}  // namespace foresight
