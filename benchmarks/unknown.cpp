// No known object in the scan, but one that resembles them: what is reported is invented.
#include <iostream>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/random_solids.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {
namespace {

void run_unknown(const ExperimentOptions& options) {
  const SeriesSetup setup = set_up_series(options);
  const auto records = recognize_series(options, "unknown", setup, options.n, [&](int i) {
    Scene scene = generate_scene({random_solid(options.seed, i)}, setup.sensor, {1, 1, setup.sensor.background},
                                 options.seed, static_cast<std::uint64_t>(i));
    return TrueScan{std::to_string(i), std::move(scene.scan.image), setup.sensor.camera, {}};
  });
  const auto all = [](const auto& of_method) { return std::vector{summarize("all", of_method)}; };
  write_results(options, "unknown", rows_of_all(records, all), joined(records), setup.models);

  std::vector<CountedShare> accepted;
  for (const auto& of_method : records) {
    CountedShare share{of_method.front().method, "scans with a report", 0, static_cast<long>(of_method.size())};
    for (const SceneRecord& record : of_method) share.hits += record.reported.empty() ? 0 : 1;
    accepted.push_back(std::move(share));
  }
  write_csv(options, "unknown_accepted", share_table(accepted, options.seed));
  std::cout << to_text(share_table(accepted, options.seed));
}

}  // namespace

Experiment add_unknown(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand("unknown", "One random solid a scan that no database holds: what is invented");
  add_common_options(*command, *options, 320);
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options] {
            run_unknown(*options);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
