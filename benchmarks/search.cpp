// Section VI.C, "constrained Alignment/Interpretation Tree search": how many hypotheses does each search test before
// the first right one, and how many until it ends, as the database grows?
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/database_series.h"
#include "benchmarks/hypothesis_search.h"
#include "benchmarks/mean_interval.h"
#include "benchmarks/plot.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {
namespace {

constexpr int kBatch = 8;  // tests at once in random orders, see first_hits_in_random_order()
constexpr std::size_t kSearches = kSearchNames.size();
constexpr CadBounds kLoose{};
constexpr CadBounds kTwoSided{0.8, 1.1};

struct SearchOptions {
  ExperimentOptions common;
  std::vector<int> models = {1, 8, 32, 100};
  int most_tests = 300;  // of one search in one scene. Limit: >= 1.
};

struct SearchResult {
  FirstHits first;
  FullSearch full;
  std::size_t hypotheses = 0;
};
using SearchResults = std::array<SearchResult, kSearches>;  // by Search

// What one scene needs; the database varies.
struct SceneBench {
  const ModelSeries& series;
  const std::vector<CadGeometry>& geometry;  // of the series
  const PoolVector<DescribedRegion>& regions;
  HypothesisTester& tester;
  std::uint64_t seed = 0;  // of the random orders of this scene
  int most_tests = 0;
};

SearchResult in_order(const SceneBench& bench, const HypothesisList& list, const Database& database, int first_model) {
  const auto test = [&](std::size_t i) -> const HypothesisTest& {
    return bench.tester.test(list.clique(i, database, first_model));
  };
  std::vector<std::size_t> order(list.hypotheses.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  return {first_hits_in_order(order.size(), bench.most_tests, test),
          full_search(order, bench.most_tests, test, [&](std::size_t i) { return list.regions(i); }), order.size()};
}

SearchResult in_random_order(const SceneBench& bench, const HypothesisList& list, const Database& database,
                             int first_model) {
  const auto test = [&](std::size_t i) -> const HypothesisTest& {
    return bench.tester.test(list.clique(i, database, first_model));
  };
  const std::vector<std::size_t> order = random_order(list.hypotheses.size(), Random(bench.seed, 1));
  return {first_hits_in_random_order(order, bench.most_tests, kBatch, test),
          full_search(order, bench.most_tests, test, [&](std::size_t i) { return list.regions(i); }), order.size()};
}

// first_model: place of the database's first model in the series.
SearchResults run_searches(const SceneBench& bench, const Database& database, int first_model) {
  SearchResults results;
  const auto result = [&](Search search) -> SearchResult& { return results[static_cast<std::size_t>(search)]; };
  HypothesisList likely = likely_hypotheses(bench.regions, database, Pruning::highest_confidence_first);
  result(Search::likely) = in_order(bench, likely, database, first_model);
  result(Search::likely_random) = in_random_order(bench, likely, database, first_model);
  sort_by_region_size(likely, bench.regions);
  result(Search::likely_size) = in_order(bench, likely, database, first_model);
  result(Search::unpruned) =
      in_order(bench, likely_hypotheses(bench.regions, database, Pruning::none), database, first_model);

  std::vector<const CadGeometry*> geometry;
  for (std::size_t m = 0; m < database.models().size(); ++m) {
    geometry.push_back(&bench.geometry[static_cast<std::size_t>(first_model) + m]);
  }
  const auto run_tree = [&](const CadBounds& bounds, Search search, Search random_search) {
    const HypothesisList tree = tree_hypotheses(bench.regions, database, geometry, bounds, Random(bench.seed, 2));
    result(search) = in_order(bench, tree, database, first_model);
    result(random_search) = in_random_order(bench, tree, database, first_model);
  };
  run_tree(kLoose, Search::tree_loose, Search::tree_loose_random);
  run_tree(kTwoSided, Search::tree_two_sided, Search::tree_two_sided_random);
  return results;
}

// One scene, by database size.
std::vector<SearchResults> run_scene(const SearchOptions& options, const ModelSeries& series,
                                     const std::vector<CadGeometry>& geometry, const std::vector<Database>& databases,
                                     const Scene& scene, int index) {
  const int model = scene.objects.front().model;
  const SensorModel& sensor = series.settings.sensor;
  const PoolVector<DescribedRegion> regions =
      extract_regions(scene.scan.image, sensor.camera, series.settings.segmentation);
  const ScoredObject object = scored_object(series.cads[static_cast<std::size_t>(model)]);
  HypothesisTester tester(scene.scan.image, sensor.camera, regions, series.models,
                          {model, scene.objects.front().T_sensor_model, &object});
  const std::uint64_t seed = Random(options.common.seed, static_cast<std::uint64_t>(index)).next();
  const SceneBench bench{series, geometry, regions, tester, seed, options.most_tests};
  std::vector<SearchResults> results;
  for (std::size_t d = 0; d < databases.size(); ++d) {
    results.push_back(options.models[d] == 1 ? run_searches(bench, only_model(series, model), model)
                                             : run_searches(bench, databases[d], 0));
  }
  return results;
}

struct Row {
  int models = 0;
  std::size_t search = 0;
  long found = 0, exhausted = 0, censored = 0, full_censored = 0;
  Mean to_right;     // over the scenes found or censored; a censored one counts the tests spent
  Mean to_accepted;  // over all scenes
  Mean hypotheses;
  Mean full;
};

Row row_of(const SearchOptions& options, const std::vector<std::vector<SearchResults>>& scenes, std::size_t database,
           std::size_t search) {
  Row row;
  row.models = options.models[database];
  row.search = search;
  std::vector<double> to_right, to_accepted, hypotheses, full;
  for (const std::vector<SearchResults>& scene : scenes) {
    const SearchResult& result = scene[database][search];
    row.found += result.first.end == SearchEnd::found ? 1 : 0;
    row.exhausted += result.first.end == SearchEnd::exhausted ? 1 : 0;
    row.censored += result.first.end == SearchEnd::censored ? 1 : 0;
    row.full_censored += result.full.censored ? 1 : 0;
    if (result.first.end != SearchEnd::exhausted) to_right.push_back(result.first.to_right);
    to_accepted.push_back(result.first.to_accepted);
    hypotheses.push_back(static_cast<double>(result.hypotheses));
    full.push_back(result.full.tests);
  }
  row.to_right = mean_of(to_right, options.common.seed);
  row.to_accepted = mean_of(to_accepted, options.common.seed);
  row.hypotheses = mean_of(hypotheses, options.common.seed);
  row.full = mean_of(full, options.common.seed);
  return row;
}

Table full_table(const std::vector<Row>& rows, const SearchOptions& options) {
  Table table;
  table.header = {"models", "search", "n", "seed", "found %", "found low", "found high", "exhausted", "censored"};
  for (const char* mean : {"tests to right", "tests to accepted", "hypotheses", "tests with rivals dropped"}) {
    for (const char* part : {"", " low", " high"}) table.header.push_back(std::string(mean) + part);
  }
  table.header.emplace_back("ends censored");
  for (const Row& row : rows) {
    const long n = row.found + row.exhausted + row.censored;
    const Interval found = wilson_interval(row.found, n);
    std::vector<std::string> cells = {std::to_string(row.models),
                                      kSearchNames[row.search],
                                      std::to_string(n),
                                      std::to_string(options.common.seed),
                                      decimal(100.0 * static_cast<double>(row.found) / static_cast<double>(n), 1),
                                      decimal(100.0 * found.low, 1),
                                      decimal(100.0 * found.high, 1),
                                      std::to_string(row.exhausted),
                                      std::to_string(row.censored)};
    for (const Mean& mean : {row.to_right, row.to_accepted, row.hypotheses, row.full}) {
      for (const double value : {mean.value, mean.interval.low, mean.interval.high}) cells.push_back(decimal(value, 2));
    }
    cells.push_back(std::to_string(row.full_censored));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

std::string with_interval(const Mean& mean, int decimals) {
  return decimal(mean.value, decimals) + " (" + decimal(mean.interval.low, decimals) + "-" +
         decimal(mean.interval.high, decimals) + ")";
}

Table table_for_eyes(const std::vector<Row>& rows) {
  Table table;
  table.header = {"search",      "models",     "n",
                  "found",       "censored",   "tests to right",
                  "to accepted", "hypotheses", "with rivals dropped"};
  for (const Row& row : rows) {
    table.rows.push_back({kSearchNames[row.search], std::to_string(row.models),
                          std::to_string(row.found + row.exhausted + row.censored), std::to_string(row.found),
                          std::to_string(row.censored), with_interval(row.to_right, 2),
                          decimal(row.to_accepted.value, 2), with_interval(row.hypotheses, 0),
                          decimal(row.full.value, 1) + (row.full_censored > 0 ? " +" : "")});
  }
  return table;
}

Table scene_rows(const SearchOptions& options, const std::vector<std::vector<SearchResults>>& scenes) {
  constexpr std::array<const char*, 3> kEnds = {"found", "exhausted", "censored"};
  Table table;
  table.header = {"scene",          "models",
                  "search",         "end",
                  "tests to right", "tests to accepted",
                  "hypotheses",     "tests with rivals dropped"};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (std::size_t d = 0; d < scenes[i].size(); ++d) {
      for (std::size_t s = 0; s < kSearches; ++s) {
        const SearchResult& result = scenes[i][d][s];
        table.rows.push_back({std::to_string(i), std::to_string(options.models[d]), kSearchNames[s],
                              kEnds[static_cast<std::size_t>(result.first.end)], decimal(result.first.to_right, 3),
                              decimal(result.first.to_accepted, 3), std::to_string(result.hypotheses),
                              std::to_string(result.full.tests)});
      }
    }
  }
  return table;
}

// Searches that share a list of hypotheses share its curve in the plot of numbers.
bool has_own_list(std::size_t search) {
  const auto kind = static_cast<Search>(search);
  return kind == Search::likely || kind == Search::unpruned || kind == Search::tree_loose ||
         kind == Search::tree_two_sided;
}

Curve curve_of(const std::vector<Row>& rows, std::size_t search, Mean Row::*what) {
  Curve curve;
  curve.label = kSearchNames[search];
  curve.style = Curve::Style::line_and_points;
  for (const Row& row : rows) {
    if (row.search != search) continue;
    curve.x.push_back(row.models);
    curve.y.push_back((row.*what).value);
    curve.low.push_back((row.*what).interval.low);
    curve.high.push_back((row.*what).interval.high);
  }
  return curve;
}

bool uses_sensor_model(std::size_t search) { return static_cast<Search>(search) <= Search::unpruned; }

void write_plot(const SearchOptions& options, const std::vector<Row>& rows) {
  const auto tests = [](const std::string& title) {
    return Plot{title, "models in the database", "tests, mean over scenes", true, true, {}, {}};
  };
  Plot sensor = tests("Tests to the first right hypothesis: with the sensor model");
  Plot cad = tests("Tests to the first right hypothesis: CAD values alone");
  Plot hypotheses{"Hypotheses", "models in the database", "hypotheses a scene, mean", true, true, {}, {}};
  for (std::size_t s = 0; s < kSearches; ++s) {
    (uses_sensor_model(s) ? sensor : cad).curves.push_back(curve_of(rows, s, &Row::to_right));
    if (has_own_list(s)) hypotheses.curves.push_back(curve_of(rows, s, &Row::hypotheses));
  }
  hypotheses.curves.front().label = "HCF";
  write_plots(options.common.output + "/search.svg", {sensor, cad, hypotheses}, 2);
}

void run_search(SearchOptions& options) {
  const SensorModel sensor = sensor_of(options.common.sensor_file);
  check_database_sizes(options.models, static_cast<int>(read_objects(options.common, sensor).size()));
  const int most = *std::max_element(options.models.begin(), options.models.end());
  const ModelSeries series = compile_series(options.common, sensor, most);
  const std::vector<CadModel> objects(series.cads.begin(), series.cads.begin() + series.objects);
  std::vector<CadGeometry> geometry;
  for (const CadModel& cad : series.cads) geometry.push_back(cad_geometry(cad));
  std::vector<Database> databases;
  for (const int models : options.models) databases.push_back(first_models(series, models));

  std::vector<std::vector<SearchResults>> scenes(static_cast<std::size_t>(options.common.n));
  run_in_parallel(options.common, "search", options.common.n, [&](int i) {
    const Scene scene = single_object_scene(objects, sensor, sensor.background, options.common.seed, i);
    scenes[static_cast<std::size_t>(i)] = run_scene(options, series, geometry, databases, scene, i);
  });
  std::vector<Row> rows;
  for (std::size_t s = 0; s < kSearches; ++s) {
    for (std::size_t d = 0; d < options.models.size(); ++d) rows.push_back(row_of(options, scenes, d, s));
  }
  write_csv(options.common, "search", full_table(rows, options));
  write_csv(options.common, "search_scenes", scene_rows(options, scenes));
  std::cout << "search, seed " << options.common.seed << ", at most " << options.most_tests
            << " tests a search and scene\n"
            << to_text(table_for_eyes(rows));
  write_plot(options, rows);
}

}  // namespace

Experiment add_search(CLI::App& app) {
  const auto options = std::make_shared<SearchOptions>();
  CLI::App* command =
      app.add_subcommand("search", "Section VI.C: tests to the first right hypothesis, by search and database size");
  add_common_options(*command, options->common, 80);
  add_series_options(*command, options->common, options->models);
  command->add_option("--most-tests", options->most_tests, "Tests of one search in one scene")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  return {command, [options] {
            run_search(*options);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
