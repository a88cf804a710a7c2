// Sections IV and VI.C: what a growing database costs the default method, in time and right poses, and what pruning its
// hypotheses spares and loses.
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/database_series.h"
#include "benchmarks/intervals.h"
#include "benchmarks/plot.h"
#include "benchmarks/series.h"
#include "benchmarks/summary.h"
#include "benchmarks/table.h"
#include "common/errors.h"
#include "runtime/recognize.h"

namespace foresight {
namespace {

constexpr int kBudget = 100;  // verifications a scan

struct ScaleOptions {
  ExperimentOptions common;
  std::vector<int> models = {8, 32, 100};
};

struct Variant {
  const char* name;
  Pruning pruning;
};
constexpr std::array<Variant, 2> kVariants = {
    {{"pruned by rating", Pruning::highest_confidence_first}, {"all hypotheses", Pruning::none}}};

struct Row {
  int models = 0;
  std::string variant;
  SummaryRow sums;
};

std::vector<Row> rows_of_size(const ScaleOptions& options, const ModelSeries& series, int models) {
  const ExperimentOptions& common = options.common;
  SeriesSetup setup;
  setup.sensor = series.settings.sensor;
  setup.models.assign(series.cads.begin(), series.cads.begin() + series.objects);
  setup.objects = scored_objects(setup.models);
  setup.database = std::make_unique<const Database>(first_models(series, models));
  for (const Variant& variant : kVariants) {
    RecognizeOptions method;
    method.pruning = variant.pruning;
    method.most_verifications = kBudget;
    setup.contestants.push_back(
        {variant.name, [&database = *setup.database, method](const RangeImage& image, const PinholeCamera& camera) {
           return recognize(image, camera, database, method);
         }});
  }
  const auto records = recognize_series(common, std::to_string(models) + " models", setup, common.n, [&](int i) {
    Scene scene = single_object_scene(setup.models, setup.sensor, setup.sensor.background, common.seed, i);
    return TrueScan{std::to_string(i), std::move(scene.scan.image), setup.sensor.camera, truth_of(scene)};
  });
  std::vector<Row> rows;
  for (std::size_t v = 0; v < records.size(); ++v)
    rows.push_back({models, kVariants[v].name, summarize("all", records[v])});
  return rows;
}

// Times last: they alone differ between runs.
Table table_of(const std::vector<Row>& rows, std::uint64_t seed) {
  Table table;
  table.header = {"hypotheses of",   "models",           "n",       "seed",       "right pose %",  "95 %",
                  "false positives", "possible matches", "matches", "hypotheses", "verifications", "search ms",
                  "total ms"};
  for (const Row& row : rows) {
    const SummaryRow& sums = row.sums;
    const Interval interval = wilson_interval(sums.right, sums.objects);
    table.rows.push_back({row.variant, std::to_string(row.models), std::to_string(sums.scenes), std::to_string(seed),
                          decimal(100.0 * static_cast<double>(sums.right) / static_cast<double>(sums.objects), 1),
                          decimal(100.0 * interval.low, 0) + "-" + decimal(100.0 * interval.high, 0),
                          std::to_string(sums.false_positives), decimal(sums.possible_matches, 0),
                          decimal(sums.threshold_matches, 0), decimal(sums.hypotheses, 1),
                          decimal(sums.verifications, 2), decimal(sums.milliseconds.hypotheses, 2),
                          decimal(sums.milliseconds.total, 2)});
  }
  return table;
}

void write_plot(const ScaleOptions& options, const std::vector<Row>& rows) {
  const auto plot = [&](const std::string& title, const std::string& y_label, bool logarithmic, auto value) {
    Plot result{title, "models in the database", y_label, true, logarithmic, {}, {}};
    for (const Variant& variant : kVariants) {
      Curve curve;
      curve.label = variant.name;
      curve.style = Curve::Style::line_and_points;
      for (const Row& row : rows) {
        if (row.variant != variant.name) continue;
        const std::array<double, 3> y = value(row.sums);
        curve.x.push_back(row.models);
        curve.y.push_back(y[0]);
        curve.low.push_back(y[1]);
        curve.high.push_back(y[2]);
      }
      result.curves.push_back(std::move(curve));
    }
    return result;
  };
  const auto alone = [](double value) { return std::array{value, value, value}; };
  write_plots(options.common.output + "/scale.svg",
              {plot("Right poses", "% of scans, 95 %", false,
                    [](const SummaryRow& sums) {
                      const Interval interval = wilson_interval(sums.right, sums.objects);
                      const double share = static_cast<double>(sums.right) / static_cast<double>(sums.objects);
                      return std::array{100.0 * share, 100.0 * interval.low, 100.0 * interval.high};
                    }),
               plot("Hypotheses looked at", "a scan, mean", true,
                    [&](const SummaryRow& sums) { return alone(sums.hypotheses); }),
               plot("Time of a scan", "ms, mean", true,
                    [&](const SummaryRow& sums) { return alone(sums.milliseconds.total); })},
              3);
}

void run_scale(const ScaleOptions& options) {
  const ExperimentOptions& common = options.common;
  const SensorModel sensor = sensor_of(common.sensor_file);
  const int objects = static_cast<int>(read_objects(common, sensor).size());
  if (std::any_of(options.models.begin(), options.models.end(), [&](int models) { return models < objects; })) {
    throw UsageError("--models", "fewer than the " + std::to_string(objects) + " objects shown",
                     "give all objects and more");
  }
  const int most = *std::max_element(options.models.begin(), options.models.end());
  const ModelSeries series = compile_series(common, sensor, most);
  std::vector<Row> rows;
  for (const int models : options.models) {
    for (Row& row : rows_of_size(options, series, models)) rows.push_back(std::move(row));
  }
  write_csv(common, "scale", table_of(rows, common.seed));
  std::cout << "scale, seed " << common.seed << ", at most " << kBudget << " verifications\n"
            << to_text(table_of(rows, common.seed));
  write_plot(options, rows);
  if (common.jobs > 1)
    std::cout << "times: of " << common.jobs << " scenes at once; use --jobs 1 for times that mean something\n";
}

}  // namespace

Experiment add_scale(CLI::App& app) {
  const auto options = std::make_shared<ScaleOptions>();
  CLI::App* command = app.add_subcommand("scale", "The default method by size of the database, pruned and not");
  add_common_options(*command, options->common, 80);
  add_series_options(*command, options->common, options->models);
  return {command, [options] {
            run_scale(*options);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
