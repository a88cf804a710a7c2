// Databases of growing size: the eight objects first, then random solids.
#pragma once

#include <vector>

#include "benchmarks/experiment.h"
#include "common/compiled_model.h"
#include "compiler/compile.h"

namespace foresight {

// Models as CAD and compiled, in the same order.
struct ModelSeries {
  std::vector<CadModel> cads;  // the objects of the options first, then random_solid(options.seed, 0), ...
  std::vector<CompiledModel> models;
  CompiledDatabase settings;  // without models
  int objects = 0;            // how many of them are no random solids
};

// The objects of the options and random solids up to `count` models. Each model is compiled once and kept as a database
// in the folder OUTPUT/databases, in a file named after its geometry, the sensor and all settings; a file that is there
// is read instead. It is not named after the compiler's code: remove the folder when that has changed.
// Throws what read_cad_model, load_database and write_file_atomically throw.
[[nodiscard]] ModelSeries compile_series(const ExperimentOptions& options, const SensorModel& sensor, int count,
                                         const CompileOptions& compile = {});

// The first `count` models. REQUIRES: count <= models of the series.
[[nodiscard]] Database first_models(const ModelSeries& series, int count);

// Throws UsageError when a size asked for is neither 1 nor at least the number of objects shown: the true object must
// be among the models.
void check_database_sizes(const std::vector<int>& sizes, int objects);

// One model alone.
[[nodiscard]] Database only_model(const ModelSeries& series, int model);

}  // namespace foresight
