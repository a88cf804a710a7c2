// Table I: does localization converge from starts near the true pose, under occlusion, with each error distribution?
#include "runtime/localization.h"

#include <array>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include "benchmarks/commands.h"
#include "benchmarks/intervals.h"
#include "benchmarks/overlay.h"
#include "benchmarks/perturbed_pose.h"
#include "benchmarks/plot.h"
#include "benchmarks/series.h"
#include "common/errors.h"
#include "runtime/nearest_data_point.h"
#include "runtime/verification.h"

namespace foresight {
namespace {

constexpr std::array<const char*, 3> kTargets = {"rolodex", "tape_dispenser", "stapler"};
constexpr std::array<const char*, 4> kLossNames = {"lorentzian", "tukey", "huber", "gaussian"};
constexpr std::array<Loss, 4> kLosses = {Loss::lorentzian, Loss::tukey, Loss::huber, Loss::gaussian};
constexpr std::array<const char*, 2> kStartNames = {"uniform", "exact"};
constexpr std::array<Perturbation, 2> kStarts = {Perturbation::uniform_magnitude, Perturbation::exact_magnitude};
constexpr double kLeastVisible = 0.5;  // the targets are hidden by 25 to 50 %
constexpr double kMostVisible = 0.75;
constexpr int kScenesTried = 5000;

struct Target {
  std::size_t model = 0;
  std::uint64_t index = 0;  // of the scene in its series
  Scene scene;
  SceneObject object;
};

// The first scene of the series in which the target is hidden as much as wanted.
Target find_target(const std::vector<CadModel>& models, const SensorModel& sensor, const std::string& name,
                   std::uint64_t seed) {
  SceneOptions options;
  options.fewest_objects = 4;
  options.most_objects = 6;
  options.background = sensor.background;
  for (std::uint64_t index = 0; index < kScenesTried; ++index) {
    Scene scene = generate_scene(models, sensor, options, seed, index);
    for (const SceneObject& object : scene.objects) {
      const auto model = static_cast<std::size_t>(object.model);
      const bool hidden = object.visible_fraction >= kLeastVisible && object.visible_fraction <= kMostVisible;
      if (models[model].name == name && hidden) return {model, index, std::move(scene), object};
    }
  }
  throw UsageError("--seed", "no scene of the series hides the " + name + " by 25 to 50 %", "take another seed");
}

struct Trial {
  double start_error = 0.0;  // MSSD of the start. Unit: mm.
  bool accepted = false;
  bool right = false;
  int energy_evaluations = 0;
  double milliseconds = 0.0;
};

struct LocalizationBench {
  const CompiledModel& compiled;
  const ScoredObject& scored;
  const Target& target;
  const PinholeCamera& camera;
  const NearestDataPoint& data;
  const ViewingSphere& sphere;
};

// Start `index` is the same for every error distribution.
Trial run_trial(const LocalizationBench& bench, Loss loss, Perturbation kind, std::uint64_t seed, int index) {
  Random random(seed, static_cast<std::uint64_t>(index));
  const Pose start = perturbed_pose(bench.target.object.T_sensor_model, bench.compiled.centre, kind, random);
  LocalizationOptions options;
  options.loss = loss;
  const auto before = std::chrono::steady_clock::now();
  const Localization found = localize(bench.compiled, bench.sphere, start, bench.data, options);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - before;
  const Verification verification = verify(bench.compiled, bench.sphere, found.T_sensor_model,
                                           bench.target.scene.scan.image, bench.camera, bench.data, {});
  const bool right =
      mssd(bench.scored, found.T_sensor_model, bench.target.object.T_sensor_model) <= bench.scored.tolerance();
  const double start_error = mssd(bench.scored, start, bench.target.object.T_sensor_model);
  return {start_error, verification.accepted, right, found.energy_evaluations, taken.count()};
}

Table empty_table() {
  Table table;
  table.header = {"object",
                  "starts",
                  "loss",
                  "n",
                  "accepted %",
                  "accepted low",
                  "accepted high",
                  "right pose %",
                  "right low",
                  "right high",
                  "accepted wrong %",
                  "energy ev.",
                  "ms"};
  return table;
}

std::vector<std::string> table_row(const std::vector<Trial>& trials) {
  long accepted = 0, right = 0, accepted_wrong = 0;
  double evaluations = 0.0, milliseconds = 0.0;
  for (const Trial& trial : trials) {
    accepted += trial.accepted ? 1 : 0;
    right += trial.right ? 1 : 0;
    accepted_wrong += trial.accepted && !trial.right ? 1 : 0;
    evaluations += trial.energy_evaluations;
    milliseconds += trial.milliseconds;
  }
  const auto n = static_cast<long>(trials.size());
  const double count = static_cast<double>(n);
  const auto percent = [](double share) { return decimal(100.0 * share, 1); };
  const Interval of_accepted = wilson_interval(accepted, n);
  const Interval of_right = wilson_interval(right, n);
  return {std::to_string(n),
          percent(static_cast<double>(accepted) / count),
          percent(of_accepted.low),
          percent(of_accepted.high),
          percent(static_cast<double>(right) / count),
          percent(of_right.low),
          percent(of_right.high),
          percent(static_cast<double>(accepted_wrong) / count),
          decimal(evaluations / count, 1),
          decimal(milliseconds / count, 2)};
}

void write_target_picture(const ExperimentOptions& options, const std::vector<CadModel>& models, const Target& target,
                          const PinholeCamera& camera) {
  Picture picture = shade(target.scene.scan.image);
  const CadModel& model = models[target.model];
  draw_edges(picture, camera, model_edges(model.vertices, model.triangles), target.object.T_sensor_model,
             {{255, 255, 255}, 1, false});
  write_picture(options.output + "/localization_" + model.name + ".png", picture);
}

// All trials with each error distribution.
using TrialsByLoss = std::array<std::vector<Trial>, kLosses.size()>;

// Right poses and cost against the error of the start, over all targets and both kinds of starts.
void write_convergence_plot(const ExperimentOptions& options, const TrialsByLoss& trials) {
  constexpr double kBinWidth = 8.0;   // Unit: mm.
  constexpr std::size_t kFewest = 5;  // trials that make a point
  Plot right{"Convergence of localization", "largest surface distance of the start, mm", "right pose, %"};
  right.percent_y = true;
  Plot cost{"Cost of localization", right.x_label, "energy evaluations"};
  for (std::size_t l = 0; l < kLosses.size(); ++l) {
    std::map<int, std::vector<const Trial*>> bins;
    for (const Trial& trial : trials[l]) bins[static_cast<int>(trial.start_error / kBinWidth)].push_back(&trial);
    Curve curve;
    curve.label = kLossNames[l];
    curve.style = Curve::Style::line_and_points;
    Curve evaluations = curve;
    for (const auto& [bin, members] : bins) {
      if (members.size() < kFewest) continue;
      long hits = 0;
      double sum = 0.0;
      for (const Trial* trial : members) {
        hits += trial->right ? 1 : 0;
        sum += trial->energy_evaluations;
      }
      const auto count = static_cast<long>(members.size());
      const Interval interval = wilson_interval(hits, count);
      curve.x.push_back(kBinWidth * (bin + 0.5));
      curve.y.push_back(100.0 * static_cast<double>(hits) / static_cast<double>(count));
      curve.low.push_back(100.0 * interval.low);
      curve.high.push_back(100.0 * interval.high);
      evaluations.x.push_back(curve.x.back());
      evaluations.y.push_back(sum / static_cast<double>(count));
    }
    right.curves.push_back(std::move(curve));
    cost.curves.push_back(std::move(evaluations));
  }
  write_plots(options.output + "/localization.svg", {right, cost}, 2);
}

void run_target(const ExperimentOptions& options, const LocalizationBench& bench, const std::string& name, Table& table,
                TrialsByLoss& all_trials) {
  for (std::size_t s = 0; s < kStarts.size(); ++s) {
    for (std::size_t l = 0; l < kLosses.size(); ++l) {
      std::vector<Trial> trials(static_cast<std::size_t>(options.n));
      run_in_parallel(options, name + " " + kLossNames[l], options.n, [&](int i) {
        trials[static_cast<std::size_t>(i)] = run_trial(bench, kLosses[l], kStarts[s], options.seed, i);
      });
      std::vector<std::string> row = {name, kStartNames[s], kLossNames[l]};
      for (std::string& cell : table_row(trials)) row.push_back(std::move(cell));
      table.rows.push_back(std::move(row));
      all_trials[l].insert(all_trials[l].end(), trials.begin(), trials.end());
    }
  }
}

void run_localization(const ExperimentOptions& options) {
  const SensorModel sensor =
      sensor_of(options.sensor_file.empty() ? project_path("models/sensors/scanner.textproto") : options.sensor_file);
  const std::vector<CadModel> models = read_objects(options, sensor);
  const std::vector<ScoredObject> objects = scored_objects(models);
  const Database database = database_of(
      options, models, options.compile_sensor_file.empty() ? sensor : sensor_of(options.compile_sensor_file));
  const ViewingSphere sphere(kAspectCells);
  Table table = empty_table();
  TrialsByLoss trials;
  for (const char* name : kTargets) {
    const Target target = find_target(models, sensor, name, options.seed);
    const NearestDataPoint data(target.scene.scan.image);
    const auto& compiled = database.models();
    const auto found =
        std::find_if(compiled.begin(), compiled.end(), [&](const CompiledModel& model) { return model.name == name; });
    if (found == compiled.end())
      throw InputError(options.database_file, "it holds no object named " + std::string(name), "add it");
    run_target(options, {*found, objects[target.model], target, sensor.camera, data, sphere}, name, table, trials);
    std::cout << name << ": scene " << target.index << ", " << target.scene.objects.size() << " objects, "
              << decimal(100.0 * target.object.visible_fraction, 1) << " % visible\n";
    write_csv(options, "localization", table);
    write_convergence_plot(options, trials);
    write_target_picture(options, models, target, sensor.camera);
  }
  std::cout << "localization, seed " << options.seed << "\n" << to_text(table);
  if (options.jobs > 1)
    std::cout << "ms: of " << options.jobs << " localizations at once; use --jobs 1 for times that mean something\n";
}

}  // namespace

Experiment add_localization(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand(
      "localization", "Table I: starts within 2 cm and 20 degrees of partly hidden objects, four losses");
  add_common_options(*command, *options, 400);
  add_object_options(*command, *options);
  return {command, [options] {
            run_localization(*options);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
