// Section VI.C.1: each object alone before nothing, in random views, scanned by the very sensor the database was
// compiled for.
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {

Experiment add_synthetic(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command =
      app.add_subcommand("synthetic", "Section VI.C.1: single objects, no background (paper: 92.5 % of 160)");
  add_common_options(*command, *options, 160);
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options] {
            run_single_object_series(*options, "synthetic", "");
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
