// Section VI.C.2, as far as a simulator goes: the paper's real images had noise, shadows, other distances and a rotary
// table.
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {

Experiment add_scanner(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand(
      "scanner", "Section VI.C.2, simulated: noise, shadow, varied distance, table (paper: 77.5 % of 80 real images)");
  add_common_options(*command, *options, 160);
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options] {
            run_single_object_series(*options, "scanner", project_path("models/sensors/scanner.textproto"));
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
