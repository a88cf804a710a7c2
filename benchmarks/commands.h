// The experiments, each a subcommand in a file of its own.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>
#include <string>

#include "benchmarks/experiment.h"

namespace foresight {

// A subcommand and what it runs; the options live as long as `run`.
struct Experiment {
  CLI::App* command = nullptr;
  std::function<int()> run;  // the exit code; throws what common/errors.h lists
};

[[nodiscard]] Experiment add_synthetic(CLI::App& app);       // Section VI.C.1
[[nodiscard]] Experiment add_scanner(CLI::App& app);         // Section VI.C.2
[[nodiscard]] Experiment add_clutter(CLI::App& app);         // Section VI.C.2, several objects
[[nodiscard]] Experiment add_single_surface(CLI::App& app);  // Section VI.C.1, views of one face
[[nodiscard]] Experiment add_twins(CLI::App& app);           // Section VI.C.1, castle and holed cube
[[nodiscard]] Experiment add_unknown(CLI::App& app);         // no known object
[[nodiscard]] Experiment add_localization(CLI::App& app);    // Table I
[[nodiscard]] Experiment add_real(CLI::App& app);            // real scans
[[nodiscard]] Experiment add_boxes(CLI::App& app);          // real frames of cartons
[[nodiscard]] Experiment add_search(CLI::App& app);          // Section VI.C, against the interpretation tree
[[nodiscard]] Experiment add_segmentation(CLI::App& app);    // extraction alone, real scans
[[nodiscard]] Experiment add_constraints(CLI::App& app);     // Sections III and VI.A
[[nodiscard]] Experiment add_potentials(CLI::App& app);      // Section IV
[[nodiscard]] Experiment add_deadlines(CLI::App& app);       // how late answers are
[[nodiscard]] Experiment add_scale(CLI::App& app);           // Section IV, by size of the database
[[nodiscard]] Experiment add_sensor_effect(CLI::App& app);   // Section III, what the sensor model takes into account
[[nodiscard]] Experiment add_covariance(CLI::App& app);      // of reported poses
[[nodiscard]] Experiment add_compile_cost(CLI::App& app);    // of the compiler

// Options that several experiments have. n: the default number of scenes, 0 = the experiment has no such option.
void add_common_options(CLI::App& command, ExperimentOptions& options, int n);
void add_object_options(CLI::App& command,
                        ExperimentOptions& options);  // --cad, --unit, --sensor, --compile-sensor, --database
void add_method_options(CLI::App& command, ExperimentOptions& options);  // --methods, --pruning, --prior-sign, --loss
// --cad, --sensor, and --models for database sizes
void add_series_options(CLI::App& command, ExperimentOptions& options, std::vector<int>& models);

}  // namespace foresight
