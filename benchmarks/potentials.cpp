// Section IV.A chose its clique potentials by experiment and shows none: what survives highest confidence first with
// them and with others, as the database grows?
#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/database_series.h"
#include "benchmarks/mean_interval.h"
#include "benchmarks/plot.h"
#include "benchmarks/series.h"
#include "common/errors.h"
#include "compiler/face_samples.h"
#include "runtime/highest_confidence_first.h"
#include "runtime/hypothesis_cliques.h"
#include "runtime/match_likelihoods.h"
#include "runtime/recognize.h"

namespace foresight {
namespace {

struct Setting {
  const char* name;
  Potentials potentials;
  Pruning pruning = Pruning::highest_confidence_first;
  bool unaries = true;  // whether priors and likelihoods of single matches count
};

std::vector<Setting> settings() {
  Potentials plus_log, contradiction, tenth;
  plus_log.prior_sign = PriorSign::plus_log_as_printed;
  contradiction.contradiction_on_on = 70.0;
  contradiction.contradiction_on_off = 0.0;
  for (double* value :
       {&tenth.support_on_on, &tenth.support_off_off, &tenth.contradiction_on_on, &tenth.contradiction_on_off}) {
    *value /= 10.0;
  }
  return {{"printed, -log P(M)", {}},
          {"printed, +log P(M)", plus_log},
          {"ON/OFF 0, ON/ON 70", contradiction},
          {"all / 10", tenth},
          {"unaries off", {}, Pruning::highest_confidence_first, false},
          {"no HCF", {}, Pruning::none}};
}

struct PotentialsOptions {
  ExperimentOptions common;
  std::vector<int> models = {1, 8, 32, 100};
  int budget = 5;  // verifications a scan of the end-to-end column. Limit: >= 1.
};

// One scene, one database, one setting.
struct Outcome {
  long variables = 0, on = 0, hypotheses = 0;
  long true_matches = 0, true_kept = 0, true_on = 0;  // of them likelihood > 0; of these ON
  double field_ms = 0.0, labels_ms = 0.0, cliques_ms = 0.0;
  bool right = false;  // end to end, where it was run
};

class Lap {
 public:
  // Milliseconds since the last call.
  double operator()() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double, std::milli> taken = now - last_;
    last_ = now;
    return taken.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void count_true_matches(const std::vector<RegionFace>& truth, int model, const Database& database,
                        const HypothesisField& field, const PoolVector<Label>& labels, Outcome& outcome) {
  outcome.true_matches = static_cast<long>(truth.size());
  for (std::size_t i = 0; i < field.matches.size(); ++i) {
    const Match& match = field.matches[i];
    const FaceIndex& face = database.faces()[static_cast<std::size_t>(match.face)];
    const bool is_true = face.model == model && std::any_of(truth.begin(), truth.end(), [&](const RegionFace& pair) {
                           return pair.region == match.region && pair.face == face.face;
                         });
    if (!is_true) continue;
    ++outcome.true_kept;
    outcome.true_on += labels[i] == kOn ? 1 : 0;
  }
}

// model: the true one, in this database.
Outcome run_setting(const Setting& setting, const Database& database, const PoolVector<DescribedRegion>& regions,
                    const std::vector<RegionFace>& truth, int model) {
  const BackgroundOptions background = background_for(database.content().density);
  Outcome outcome;
  Lap lap;
  HypothesisField field = build_hypothesis_field(regions, match_likelihoods(regions, database, background), database,
                                                 background, setting.potentials);
  outcome.field_ms = lap();
  if (!setting.unaries) std::fill(field.unary.begin(), field.unary.end(), std::array<double, 2>{0.0, 0.0});
  lap();
  const PoolVector<Label> labels =
      setting.pruning == Pruning::none ? PoolVector<Label>(field.matches.size(), kOn) : highest_confidence_first(field);
  outcome.labels_ms = lap();
  outcome.hypotheses = static_cast<long>(hypothesis_cliques(field, database, labels).size());
  outcome.cliques_ms = lap();
  outcome.variables = static_cast<long>(labels.size());
  outcome.on = static_cast<long>(std::count(labels.begin(), labels.end(), kOn));
  count_true_matches(truth, model, database, field, labels, outcome);
  return outcome;
}

using ByScene = std::vector<Outcome>;

struct Row {
  int models = 0;
  const char* setting = "";
  long scenes = 0, true_matches = 0, true_kept = 0, true_on = 0, right = 0;
  bool end_to_end = false;
  Mean variables, on, hypotheses, field_ms, labels_ms, cliques_ms;

  [[nodiscard]] double kept() const {
    return 100.0 * static_cast<double>(true_kept) / static_cast<double>(true_matches);
  }
  [[nodiscard]] double kept_on() const { return 100.0 * static_cast<double>(true_on) / static_cast<double>(true_kept); }
};

Row row_of(int models, const Setting& setting, const ByScene& scenes, std::uint64_t seed) {
  Row row;
  row.models = models;
  row.setting = setting.name;
  row.scenes = static_cast<long>(scenes.size());
  for (const Outcome& scene : scenes) {
    row.true_matches += scene.true_matches;
    row.true_kept += scene.true_kept;
    row.true_on += scene.true_on;
    row.right += scene.right ? 1 : 0;
  }
  const auto mean = [&](auto value) {
    std::vector<double> values;
    for (const Outcome& scene : scenes) values.push_back(static_cast<double>(scene.*value));
    return mean_of(values, seed);
  };
  row.variables = mean(&Outcome::variables);
  row.on = mean(&Outcome::on);
  row.hypotheses = mean(&Outcome::hypotheses);
  row.field_ms = mean(&Outcome::field_ms);
  row.labels_ms = mean(&Outcome::labels_ms);
  row.cliques_ms = mean(&Outcome::cliques_ms);
  return row;
}

std::string share(long hits, long trials) {
  const Interval interval = wilson_interval(hits, trials);
  const double value = 100.0 * static_cast<double>(hits) / static_cast<double>(trials);
  return decimal(value, 1) + " (" + decimal(100.0 * interval.low, 1) + "-" + decimal(100.0 * interval.high, 1) + ")";
}

// Times last: they alone differ between runs.
Table table_of(const std::vector<Row>& rows, std::uint64_t seed) {
  Table table;
  table.header = {
      "potentials",       "models",       "n",          "seed",         "variables", "ON",     "true matches",
      "likelihood > 0 %", "of them ON %", "hypotheses", "right pose %", "field ms",  "HCF ms", "cliques ms"};
  for (const Row& row : rows) {
    table.rows.push_back({row.setting, std::to_string(row.models), std::to_string(row.scenes), std::to_string(seed),
                          decimal(row.variables.value, 1), decimal(row.on.value, 1), std::to_string(row.true_matches),
                          share(row.true_kept, row.true_matches), share(row.true_on, row.true_kept),
                          decimal(row.hypotheses.value, 1) + " (" + decimal(row.hypotheses.interval.low, 0) + "-" +
                              decimal(row.hypotheses.interval.high, 0) + ")",
                          row.end_to_end ? share(row.right, row.scenes) : "-", decimal(row.field_ms.value, 2),
                          decimal(row.labels_ms.value, 2), decimal(row.cliques_ms.value, 2)});
  }
  return table;
}

void write_plot(const PotentialsOptions& options, const std::vector<Row>& rows) {
  const auto plot = [&](const std::string& title, const std::string& y_label, bool logarithmic, auto point) {
    Plot result{title, "models in the database", y_label, true, logarithmic, {}, {}};
    for (const Setting& setting : settings()) {
      Curve curve;
      curve.label = setting.name;
      curve.style = Curve::Style::line_and_points;
      for (const Row& row : rows) {
        if (row.setting != std::string(setting.name)) continue;
        const Mean mean = point(row);
        curve.x.push_back(row.models);
        curve.y.push_back(mean.value);
        curve.low.push_back(mean.interval.low);
        curve.high.push_back(mean.interval.high);
      }
      result.curves.push_back(std::move(curve));
    }
    return result;
  };
  write_plots(options.common.output + "/potentials.svg",
              {plot("Matches left ON", "matches a scene, mean", true, [](const Row& row) { return row.on; }),
               plot("True matches that stay ON", "% of those with likelihood > 0", false,
                    [](const Row& row) {
                      const Interval interval = wilson_interval(row.true_on, row.true_kept);
                      return Mean{row.kept_on(), {100.0 * interval.low, 100.0 * interval.high}};
                    }),
               plot("Hypotheses", "hypotheses a scene, mean", true, [](const Row& row) { return row.hypotheses; }),
               plot("Time of highest confidence first and cliques", "ms a scene, mean", true,
                    [](const Row& row) {
                      const double value = row.labels_ms.value + row.cliques_ms.value;
                      return Mean{value, {value, value}};
                    })},
              2);
}

// The right pose found within the budget of verifications.
bool recognized(const PotentialsOptions& options, const Setting& setting, const ModelSeries& series,
                const std::vector<CadModel>& objects, const Database& database, const Scene& scene) {
  RecognizeOptions method;
  method.method = Method::paper;  // whose potentials they are
  method.potentials = setting.potentials;
  method.pruning = setting.pruning;
  method.most_verifications = options.budget;
  const Contestant contestant{setting.name, [&](const RangeImage& image, const PinholeCamera& camera) {
                                return recognize(image, camera, database, method);
                              }};
  const SensorModel& sensor = series.settings.sensor;
  const SceneRecord record = recognize_and_score({objects, scored_objects(objects), sensor}, contestant,
                                                 {"", scene.scan.image, sensor.camera, truth_of(scene)});
  return record.verdicts.truth.front() == Verdict::right;
}

void run_potentials(const PotentialsOptions& options) {
  const ExperimentOptions& common = options.common;
  const SensorModel sensor = sensor_of(common.sensor_file);
  const int most = *std::max_element(options.models.begin(), options.models.end());
  check_database_sizes(options.models, static_cast<int>(read_objects(common, sensor).size()));
  const ModelSeries series = compile_series(common, sensor, most);
  const std::vector<CadModel> objects(series.cads.begin(), series.cads.begin() + series.objects);
  const std::vector<Setting> all = settings();
  std::vector<Row> rows;
  for (const int models : options.models) {
    const Database database = first_models(series, models);
    std::vector<ByScene> outcomes(all.size(), ByScene(static_cast<std::size_t>(common.n)));
    run_in_parallel(common, std::to_string(models) + " models", common.n, [&](int i) {
      const Scene scene = single_object_scene(objects, sensor, sensor.background, common.seed, i);
      const int model = scene.objects.front().model;
      const auto regions = extract_regions(scene.scan.image, sensor.camera, series.settings.segmentation);
      // A region's true match is with the face that most of its cells show.
      const std::vector<RegionFace> truth = pair_regions_with_faces(regions, scene.scan.labels);
      for (std::size_t s = 0; s < all.size(); ++s) {
        Outcome& outcome = outcomes[s][static_cast<std::size_t>(i)];
        outcome = models == 1 ? run_setting(all[s], only_model(series, model), regions, truth, 0)
                              : run_setting(all[s], database, regions, truth, model);
        if (models == series.objects && all[s].unaries) {
          outcome.right = recognized(options, all[s], series, objects, database, scene);
        }
      }
    });
    for (std::size_t s = 0; s < all.size(); ++s) {
      rows.push_back(row_of(models, all[s], outcomes[s], common.seed));
      rows.back().end_to_end = models == series.objects && all[s].unaries;
    }
  }
  write_csv(common, "potentials", table_of(rows, common.seed));
  std::cout << "potentials, seed " << common.seed << ", right pose within " << options.budget << " verifications\n"
            << to_text(table_of(rows, common.seed));
  write_plot(options, rows);
  if (common.jobs > 1)
    std::cout << "times: of " << common.jobs << " scenes at once; use --jobs 1 for times that mean something\n";
}

}  // namespace

Experiment add_potentials(CLI::App& app) {
  const auto options = std::make_shared<PotentialsOptions>();
  CLI::App* command =
      app.add_subcommand("potentials", "Section IV.A: what clique potentials keep, by size of the database");
  add_common_options(*command, options->common, 160);
  add_series_options(*command, options->common, options->models);
  command->add_option("--budget", options->budget, "Verifications a scan for the share of right poses")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  return {command, [options] {
            run_potentials(*options);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
