// timings: how long each runtime stage takes on fixed simulated scans, with Google Benchmark.
//
// All the objects of the paper are loaded; the scans show one object alone, and six at once. Counters say how much work
// a time stands for: data points, matches, hypotheses, and evaluations of eq. (9) as in Table I.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <thread>

#include "benchmarks/experiment.h"
#include "benchmarks/series.h"
#include "common/program.h"
#include "compiler/database_writer.h"
#include "compiler/scene_generator.h"
#include "runtime/highest_confidence_first.h"
#include "runtime/hypothesis_cliques.h"
#include "runtime/nearest_data_point.h"
#include "runtime/pose_evidence.h"
#include "runtime/pose_from_matches.h"
#include "runtime/recognize.h"

namespace foresight {
namespace {

// One scan with what each stage makes of it, so that every stage can be timed alone.
struct Case {
  std::string name;
  RangeImage image;
  const Database& database;
  NearestDataPoint data;
  PoolVector<DescribedRegion> regions;
  PoolVector<Match> matches;
  HypothesisField field;
  PoolVector<Label> labels;
  PoolVector<ObjectHypothesis> hypotheses;
  ViewingSphere sphere{kAspectCells};

  Case(std::string case_name, const Scene& scene, const Database& objects)
      : name(std::move(case_name)), image(scene.scan.image), database(objects), data(image) {
    regions = extract_regions(image, camera(), objects.content().segmentation);
    matches = match_likelihoods(regions, objects, {});
    field = build_hypothesis_field(regions, matches, objects, {}, {});
    labels = highest_confidence_first(field);
    hypotheses = hypothesis_cliques(field, objects, labels);
  }
  [[nodiscard]] const PinholeCamera& camera() const { return database.content().sensor.camera; }
  [[nodiscard]] const CompiledModel& model(const ObjectHypothesis& hypothesis) const {
    return database.models()[static_cast<std::size_t>(hypothesis.model)];
  }
};

// The first hypotheses with a pose, in the order recognition tries them, and where localization takes them.
struct Trial {
  const CompiledModel* model;
  Pose start, refined;
};

constexpr std::size_t kTrials = 32;

std::vector<Trial> first_trials(const Case& scan) {
  std::vector<Trial> trials;
  for (const ObjectHypothesis& hypothesis : scan.hypotheses) {
    if (trials.size() == kTrials) break;
    PoolVector<RegionFaceMatch> matches;
    for (const int index : hypothesis.matches) {
      const Match& match = scan.field.matches[static_cast<std::size_t>(index)];
      matches.push_back({&scan.regions[static_cast<std::size_t>(match.region)], &scan.database.face(match.face)});
    }
    const CompiledModel& model = scan.model(hypothesis);
    if (const auto start = pose_from_matches(matches)) {
      trials.push_back({&model, *start, localize(model, scan.sphere, *start, scan.data, {}).T_sensor_model});
    }
  }
  return trials;
}

void count(benchmark::State& state, const char* counter, double per_iteration) {
  state.counters[counter] = per_iteration;
}

void count_average(benchmark::State& state, const char* counter, double sum) {
  state.counters[counter] = benchmark::Counter(sum, benchmark::Counter::kAvgIterations);
}

// Calls time_one(trial) for one trial an iteration, in turn.
template <typename TimeOne>
void time_trials(benchmark::State& state, const Case& scan, TimeOne&& time_one) {
  const std::vector<Trial> trials = first_trials(scan);
  if (trials.empty()) {
    state.SkipWithError("no hypothesis has a pose");
    return;
  }
  std::size_t next = 0;
  for (auto step : state) {
    (void)step;
    time_one(trials[next]);
    next = (next + 1) % trials.size();
  }
}

// The whole of Section V for one hypothesis: what the number of hypotheses multiplies.
void time_verification(benchmark::State& state, const Case& scan) {
  double evaluations = 0.0;
  double points = 0.0;
  time_trials(state, scan, [&](const Trial& trial) {
    const Localization found = localize(*trial.model, scan.sphere, trial.start, scan.data, {});
    const Verification verified =
        verify(*trial.model, scan.sphere, found.T_sensor_model, scan.image, scan.camera(), scan.data, {});
    evaluations += found.energy_evaluations;
    points += verified.visible;
  });
  count_average(state, "evaluations", evaluations);
  count_average(state, "points", points);
}

void time_localize(benchmark::State& state, const Case& scan) {
  double evaluations = 0.0;
  time_trials(state, scan, [&](const Trial& trial) {
    evaluations += localize(*trial.model, scan.sphere, trial.start, scan.data, {}).energy_evaluations;
  });
  count_average(state, "evaluations", evaluations);
}

void time_verify(benchmark::State& state, const Case& scan) {
  double points = 0.0;
  time_trials(state, scan, [&](const Trial& trial) {
    points += verify(*trial.model, scan.sphere, trial.refined, scan.image, scan.camera(), scan.data, {}).visible;
  });
  count_average(state, "points", points);
}

void time_extract(benchmark::State& state, const Case& scan) {
  for (auto step : state) {
    (void)step;
    benchmark::DoNotOptimize(extract_regions(scan.image, scan.camera(), scan.database.content().segmentation));
  }
  count(state, "points", count_valid(scan.image));
  count(state, "regions", static_cast<double>(scan.regions.size()));
}

// Extraction alone, where images are large: 512 x 512 cells of a noisy scanner, most of them with data.
void time_extract_large(benchmark::State& state, const Scene& scene, const SensorModel& sensor) {
  const SegmentationOptions options = segmentation_options_for(sensor);
  std::size_t regions = 0;
  for (auto step : state) {
    (void)step;
    regions = extract_regions(scene.scan.image, sensor.camera, options).size();
  }
  count(state, "points", count_valid(scene.scan.image));
  count(state, "regions", static_cast<double>(regions));
}

void time_field(benchmark::State& state, const Case& scan) {
  for (auto step : state) {
    (void)step;
    const auto matches = match_likelihoods(scan.regions, scan.database, {});
    benchmark::DoNotOptimize(build_hypothesis_field(scan.regions, matches, scan.database, {}, {}));
  }
  count(state, "matches", static_cast<double>(scan.matches.size()));
}

void time_highest_confidence_first(benchmark::State& state, const Case& scan) {
  for (auto step : state) {
    (void)step;
    benchmark::DoNotOptimize(highest_confidence_first(scan.field));
  }
  count(state, "matches", static_cast<double>(scan.matches.size()));
}

void time_cliques(benchmark::State& state, const Case& scan) {
  for (auto step : state) {
    (void)step;
    benchmark::DoNotOptimize(hypothesis_cliques(scan.field, scan.database, scan.labels));
  }
  count(state, "matches", static_cast<double>(std::count(scan.labels.begin(), scan.labels.end(), kOn)));
  count(state, "hypotheses", static_cast<double>(scan.hypotheses.size()));
}

void time_data_tree(benchmark::State& state, const Case& scan) {
  for (auto step : state) {
    (void)step;
    benchmark::DoNotOptimize(NearestDataPoint(scan.image));
  }
  count(state, "points", count_valid(scan.image));
}

// What the two-way method looks at before it localizes: the object drawn at a hypothesis's pose.
void time_pose_check(benchmark::State& state, const Case& scan) {
  const LabelledScan labelled = label_scan(scan.image, scan.camera(), scan.database.content().sensor, scan.regions);
  double cells = 0.0;
  time_trials(state, scan,
              [&](const Trial& trial) { cells += gather_evidence(*trial.model, trial.start, labelled).drawn; });
  count_average(state, "cells", cells);
}

// Decoding and checking a database whose bytes are in memory.
void time_load(benchmark::State& state, const Case& scan) {
  const std::string bytes = encode_database(scan.database.content());
  for (auto step : state) {
    (void)step;
    benchmark::DoNotOptimize(Database(decode_database(bytes, "memory")));
  }
  count(state, "bytes", static_cast<double>(bytes.size()));
  count(state, "models", static_cast<double>(scan.database.models().size()));
}

// In clutter the hypotheses that nothing accepts take minutes: a fixed number of verifications makes times compare.
void time_recognition(benchmark::State& state, const Case& scan, Method method) {
  RecognizeOptions options;
  options.method = method;
  options.most_verifications = 10;
  Statistics statistics;
  for (auto step : state) {
    (void)step;
    statistics = recognize(scan.image, scan.camera(), scan.database, options).statistics;
  }
  count(state, "points", count_valid(scan.image));
  count(state, "matches", static_cast<double>(statistics.threshold_matches));
  count(state, "verifications", static_cast<double>(statistics.verifications));
  count(state, "evaluations", static_cast<double>(statistics.energy_evaluations));
}

void time_recognize(benchmark::State& state, const Case& scan) { time_recognition(state, scan, Method::two_way); }
void time_recognize_paper(benchmark::State& state, const Case& scan) { time_recognition(state, scan, Method::paper); }

std::vector<Case> fixed_cases(const std::vector<CadModel>& models, const SensorModel& sensor,
                              const Database& database) {
  constexpr std::uint64_t kSeed = 1;
  const int several = std::min(6, static_cast<int>(models.size()));
  std::vector<Case> cases;
  cases.emplace_back(models[0].name, single_object_scene(models, sensor, false, kSeed, 0), database);
  cases.emplace_back(std::to_string(several) + "_objects",
                     generate_scene(models, sensor, {several, several, false}, kSeed, 0), database);
  return cases;
}

struct Stage {
  const char* name;
  void (*time)(benchmark::State&, const Case&);
  bool by_trial = false;  // an iteration is one trial: as many iterations as go through all of them twice
};

void register_all(const std::vector<Case>& cases) {
  const std::vector<Stage> stages = {{"verification", time_verification, true},
                                     {"recognize", time_recognize},
                                     {"recognize_paper", time_recognize_paper},
                                     {"load", time_load},
                                     {"extract", time_extract},
                                     {"field", time_field},
                                     {"hcf", time_highest_confidence_first},
                                     {"cliques", time_cliques},
                                     {"data_tree", time_data_tree},
                                     {"pose_check", time_pose_check, true},
                                     {"localize", time_localize, true},
                                     {"verify", time_verify, true}};
  for (const Stage& stage : stages) {
    for (const Case& scan : cases) {
      auto* registered =
          benchmark::RegisterBenchmark((std::string(stage.name) + "/" + scan.name).c_str(),
                                       [stage, &scan](benchmark::State& state) { stage.time(state, scan); });
      registered->Unit(benchmark::kMicrosecond);
      if (stage.by_trial) registered->Iterations(2 * kTrials);
    }
  }
}

int run(const ExperimentOptions& options) {
  const SensorModel sensor = sensor_of(options.sensor_file);
  const std::vector<CadModel> models = read_objects(options, sensor);
  const Database database = database_of(options, models, sensor);
  const std::vector<Case> cases = fixed_cases(models, sensor, database);
  register_all(cases);
  const int several = std::min(6, static_cast<int>(models.size()));
  const SensorModel large = sensor_of(project_path("models/sensors/abw.textproto"));
  const Scene scene = generate_scene(models, large, {several, several, true}, 1, 0);
  benchmark::RegisterBenchmark("extract/512x512", [&](benchmark::State& state) {
    time_extract_large(state, scene, large);
  })->Unit(benchmark::kMicrosecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace foresight

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);  // takes its own --benchmark_... out of the arguments
  CLI::App app("Times the stages of recognition; see also --benchmark_filter=REGEX and --benchmark_format=csv.",
               "timings");
  foresight::ExperimentOptions options;
  options.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  app.add_option("--cad", options.cad_files, "CAD files; the eight objects of the paper when not given");
  app.add_option("--sensor", options.sensor_file, "Sensor file; the paper's sensor when not given");
  app.add_option("--database", options.database_file,
                 "Compiled database of these objects; compiled here when not given");
  foresight::add_progress_option(app, options.progress);
  return foresight::run_program("timings", app, argc, argv, [&] { return foresight::run(options); });
}
