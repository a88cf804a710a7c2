// Two objects that the paper took for one another (Sections VI.C.1 and VI.C.2): is either reported where the other is?
#include <iostream>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {
namespace {

int model_named(const std::vector<CadModel>& models, const std::string& name) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (models[i].name == name) return static_cast<int>(i);
  }
  throw UsageError("--twins", "no CAD file describes an object " + name, "name two objects of the CAD files");
}

void run_twins(const ExperimentOptions& options, const std::vector<std::string>& names) {
  const SeriesSetup setup = set_up_series(options);
  const std::vector<int> twins = {model_named(setup.models, names[0]), model_named(setup.models, names[1])};
  const std::vector<CadModel> shown = {setup.models[static_cast<std::size_t>(twins[0])],
                                       setup.models[static_cast<std::size_t>(twins[1])]};
  const auto records = recognize_series(options, "twins", setup, options.n, [&](int i) {
    Scene scene = single_object_scene(shown, setup.sensor, setup.sensor.background, options.seed, i);
    std::vector<TrueObject> truth = truth_of(scene);
    for (TrueObject& object : truth) object.object = twins[static_cast<std::size_t>(object.object)];
    return TrueScan{std::to_string(i), std::move(scene.scan.image), setup.sensor.camera, std::move(truth)};
  });
  const auto by_object = [&](const auto& of_method) { return rows_by_object(setup.models, of_method); };
  write_results(options, "twins", rows_of_all(records, by_object), joined(records), setup.models);

  std::vector<CountedShare> swaps;
  for (const auto& of_method : records) {
    CountedShare share{of_method.front().method, "scans with the twin reported", 0,
                       static_cast<long>(of_method.size())};
    for (const SceneRecord& record : of_method) {
      const int other = record.truth.front().object == twins[0] ? twins[1] : twins[0];
      const auto is_other = [&](const ReportedObject& report) { return report.object == other; };
      share.hits += std::any_of(record.reported.begin(), record.reported.end(), is_other) ? 1 : 0;
    }
    swaps.push_back(std::move(share));
  }
  write_csv(options, "twins_swaps", share_table(swaps, options.seed));
  std::cout << to_text(share_table(swaps, options.seed));
}

}  // namespace

Experiment add_twins(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  const auto names = std::make_shared<std::vector<std::string>>(std::vector<std::string>{"castle", "holed_cube"});
  CLI::App* command = app.add_subcommand("twins", "Two similar objects, one a scan: how often the other is reported");
  add_common_options(*command, *options, 320);
  command->add_option("--twins", *names, "The two objects")->expected(2)->capture_default_str();
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options, names] {
            run_twins(*options, *names);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
