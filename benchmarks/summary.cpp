#include "benchmarks/summary.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "benchmarks/intervals.h"

namespace foresight {
namespace {

struct Mean {
  double sum = 0.0;
  long count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] double value() const {
    return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(count);
  }
};

template <class Value>
double mean_over(const std::vector<SceneRecord>& scenes, Value value, bool with_failed = true) {
  Mean mean;
  for (const SceneRecord& scene : scenes) {
    if (with_failed || !scene.failed()) mean.add(static_cast<double>(value(scene)));
  }
  return mean.value();
}

void count_objects(const SceneRecord& scene, const VisibleRange& visible, SummaryRow& row) {
  for (std::size_t t = 0; t < scene.truth.size(); ++t) {
    const double fraction = scene.truth[t].visible_fraction;
    if (fraction < visible.from || fraction >= visible.below) continue;
    ++row.objects;
    row.named += scene.verdicts.named[t] ? 1 : 0;
    row.right += scene.verdicts.truth[t] == Verdict::right ? 1 : 0;
    row.declared += scene.verdicts.truth[t] == Verdict::declared ? 1 : 0;
    row.indistinguishable += scene.verdicts.truth[t] == Verdict::indistinguishable ? 1 : 0;
  }
}

void count_reports(const SceneRecord& scene, SummaryRow& row, Mean& rank) {
  row.reported += static_cast<long>(scene.reported.size());
  for (std::size_t r = 0; r < scene.reported.size(); ++r) {
    const Verdict verdict = scene.verdicts.reported[r];
    row.false_positives += verdict == Verdict::false_positive ? 1 : 0;
    row.wrong_poses += verdict == Verdict::wrong_pose ? 1 : 0;
    row.duplicates += verdict == Verdict::duplicate ? 1 : 0;
    if (verdict == Verdict::right || verdict == Verdict::declared || verdict == Verdict::indistinguishable)
      rank.add(scene.ranks[r]);
  }
}

StageTimes mean_times(const std::vector<SceneRecord>& scenes) {
  StageTimes mean;
  for (double StageTimes::*stage : {&StageTimes::extract, &StageTimes::field, &StageTimes::hypotheses,
                                    &StageTimes::localize, &StageTimes::verify, &StageTimes::total}) {
    mean.*stage = mean_over(scenes, [&](const SceneRecord& scene) { return scene.milliseconds.*stage; });
  }
  return mean;
}

std::string percent(long hits, long trials) {
  return decimal(trials == 0 ? std::numeric_limits<double>::quiet_NaN()
                             : 100.0 * static_cast<double>(hits) / static_cast<double>(trials),
                 1);
}

void add_share(std::vector<std::string>& row, long hits, long trials) {
  const Interval interval = wilson_interval(hits, trials);
  row.push_back(percent(hits, trials));
  row.push_back(decimal(100.0 * interval.low, 1));
  row.push_back(decimal(100.0 * interval.high, 1));
}

std::vector<std::string> summary_cells(const SummaryRow& row, std::uint64_t seed) {
  std::vector<std::string> cells = {row.method, row.label, std::to_string(row.scenes), std::to_string(row.objects),
                                    std::to_string(seed)};
  add_share(cells, row.named, row.objects);
  add_share(cells, row.right, row.objects);
  cells.push_back(percent(row.declared, row.objects));
  add_share(cells, row.right + row.declared, row.objects);
  add_share(cells, row.right + row.declared + row.indistinguishable, row.objects);
  for (const long count : {row.reported, row.false_positives, row.wrong_poses, row.duplicates})
    cells.push_back(std::to_string(count));
  for (const double mean :
       {row.regions, row.possible_matches, row.threshold_matches, row.active_matches, row.hypotheses, row.verifications,
        row.verifications_when_found, row.energy_evaluations, row.energy_evaluations_when_found, row.rank}) {
    cells.push_back(decimal(mean, 2));
  }
  const StageTimes& ms = row.milliseconds;
  for (const double mean : {ms.extract, ms.field, ms.hypotheses, ms.localize, ms.verify, ms.total})
    cells.push_back(decimal(mean, 2));
  return cells;
}

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::missed:
      return "missed";
    case Verdict::right:
      return "right";
    case Verdict::declared:
      return "declared";
    case Verdict::indistinguishable:
      return "indistinguishable";
    case Verdict::wrong_pose:
      return "wrong_pose";
    case Verdict::false_positive:
      return "false_positive";
    case Verdict::duplicate:
      return "duplicate";
  }
  return "";
}

}  // namespace

bool SceneRecord::failed() const {
  return std::none_of(verdicts.named.begin(), verdicts.named.end(), [](bool b) { return b; });
}

SummaryRow summarize(const std::string& label, const std::vector<SceneRecord>& scenes, const VisibleRange& visible) {
  SummaryRow row;
  row.method = scenes.empty() ? std::string() : scenes.front().method;
  row.label = label;
  row.scenes = static_cast<long>(scenes.size());
  Mean rank;
  for (const SceneRecord& scene : scenes) {
    count_objects(scene, visible, row);
    count_reports(scene, row, rank);
  }
  const auto statistic = [&](auto member, bool with_failed = true) {
    return mean_over(
        scenes, [&](const SceneRecord& scene) { return scene.statistics.*member; }, with_failed);
  };
  row.regions = statistic(&Statistics::regions);
  row.possible_matches = statistic(&Statistics::possible_matches);
  row.threshold_matches = statistic(&Statistics::threshold_matches);
  row.active_matches = statistic(&Statistics::active_matches);
  row.hypotheses = statistic(&Statistics::hypotheses);
  row.verifications = statistic(&Statistics::verifications);
  row.verifications_when_found = statistic(&Statistics::verifications, false);
  row.energy_evaluations = statistic(&Statistics::energy_evaluations);
  row.energy_evaluations_when_found = statistic(&Statistics::energy_evaluations, false);
  row.rank = rank.value();
  row.milliseconds = mean_times(scenes);
  return row;
}

Table share_table(const std::vector<CountedShare>& shares, std::uint64_t seed) {
  Table table;
  table.header = {"method", "set", "n", "seed", "hits", "percent", "low", "high"};
  for (const CountedShare& share : shares) {
    std::vector<std::string> row = {share.method, share.label, std::to_string(share.trials), std::to_string(seed),
                                    std::to_string(share.hits)};
    add_share(row, share.hits, share.trials);
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table summary_table(const std::vector<SummaryRow>& rows, std::uint64_t seed) {
  Table table;
  table.header = {"method",
                  "set",
                  "scenes",
                  "objects",
                  "seed",
                  "object_percent",
                  "object_low",
                  "object_high",
                  "right_pose_percent",
                  "right_pose_low",
                  "right_pose_high",
                  "declared_percent",
                  "right_or_declared_percent",
                  "right_or_declared_low",
                  "right_or_declared_high",
                  "right_declared_or_indistinguishable_percent",
                  "right_declared_or_indistinguishable_low",
                  "right_declared_or_indistinguishable_high",
                  "reported",
                  "false_positives",
                  "wrong_poses",
                  "duplicates",
                  "regions",
                  "possible_matches",
                  "threshold_matches",
                  "active_matches",
                  "hypotheses",
                  "verifications",
                  "verifications_when_found",
                  "energy_evaluations",
                  "energy_evaluations_when_found",
                  "rank_when_right",
                  "extract_ms",
                  "field_ms",
                  "hypotheses_ms",
                  "localize_ms",
                  "verify_ms",
                  "total_ms"};
  for (const SummaryRow& row : rows) table.rows.push_back(summary_cells(row, seed));
  return table;
}

Table short_table(const std::vector<SummaryRow>& rows) {
  Table table;
  table.header = {"method",     "set",        "n",          "object %",   "right %",
                  "95 %",       "declared %", "+indist %",  "false pos",  "wrong pose",
                  "hypotheses", "verif.",     "when found", "energy ev.", "total ms"};
  for (const SummaryRow& row : rows) {
    const Interval interval = wilson_interval(row.right, row.objects);
    table.rows.push_back(
        {row.method, row.label, std::to_string(row.objects), percent(row.named, row.objects),
         percent(row.right, row.objects), decimal(100.0 * interval.low, 0) + "-" + decimal(100.0 * interval.high, 0),
         percent(row.declared, row.objects), percent(row.right + row.declared + row.indistinguishable, row.objects),
         std::to_string(row.false_positives), std::to_string(row.wrong_poses), decimal(row.hypotheses, 1),
         decimal(row.verifications, 2), decimal(row.verifications_when_found, 2), decimal(row.energy_evaluations, 0),
         decimal(row.milliseconds.total, 1)});
  }
  return table;
}

Table declared_table(const std::vector<SummaryRow>& rows, std::uint64_t seed) {
  std::vector<CountedShare> shares;
  for (const SummaryRow& row : rows) {
    shares.push_back({row.method, row.label + ": right", row.right, row.objects});
    shares.push_back({row.method, row.label + ": declared", row.declared, row.objects});
    shares.push_back({row.method, row.label + ": right or declared", row.right + row.declared, row.objects});
  }
  return share_table(shares, seed);
}

Table calibration_table(const std::vector<SceneRecord>& scenes) {
  constexpr std::array<double, 6> kEdges = {0.0, 0.5, 0.7, 0.9, 0.97, 1.0};
  struct Bin {
    long reports = 0;
    long right = 0;
    double sum = 0.0;
  };
  std::map<std::string, std::array<Bin, kEdges.size() - 1>> of_method;
  for (const SceneRecord& scene : scenes) {
    for (std::size_t r = 0; r < scene.reported.size(); ++r) {
      const auto above = std::upper_bound(kEdges.begin() + 1, kEdges.end() - 1, scene.scores[r]);
      Bin& bin = of_method[scene.method][static_cast<std::size_t>(above - kEdges.begin()) - 1];
      const Verdict verdict = scene.verdicts.reported[r];
      ++bin.reports;
      bin.right += verdict == Verdict::right || verdict == Verdict::indistinguishable ? 1 : 0;
      bin.sum += scene.scores[r];
    }
  }
  Table table;
  table.header = {"method", "score_from", "score_to", "reports", "mean_score", "right_percent", "low", "high"};
  for (const auto& [method, bins] : of_method) {
    for (std::size_t b = 0; b < bins.size(); ++b) {
      if (bins[b].reports == 0) continue;
      std::vector<std::string> row = {method, decimal(kEdges[b], 2), decimal(kEdges[b + 1], 2),
                                      std::to_string(bins[b].reports),
                                      decimal(bins[b].sum / static_cast<double>(bins[b].reports), 3)};
      add_share(row, bins[b].right, bins[b].reports);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

Table scene_table(const std::vector<SceneRecord>& scenes, const std::vector<std::string>& object_names) {
  Table table;
  table.header = {"method", "scene", "kind", "object", "verdict", "visible_fraction", "rank", "score"};
  const auto name = [&](int object) {
    return object < 0 ? std::string("unknown") : object_names[static_cast<std::size_t>(object)];
  };
  for (const SceneRecord& scene : scenes) {
    for (std::size_t t = 0; t < scene.truth.size(); ++t) {
      table.rows.push_back({scene.method, scene.name, "truth", name(scene.truth[t].object),
                            verdict_name(scene.verdicts.truth[t]), decimal(scene.truth[t].visible_fraction, 3), "",
                            ""});
    }
    for (std::size_t r = 0; r < scene.reported.size(); ++r) {
      table.rows.push_back({scene.method, scene.name, "report", name(scene.reported[r].object),
                            verdict_name(scene.verdicts.reported[r]), "", std::to_string(scene.ranks[r]),
                            decimal(scene.scores[r], 4)});
    }
  }
  return table;
}

}  // namespace foresight
