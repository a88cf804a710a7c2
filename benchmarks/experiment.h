// What the experiments share: their options, objects, databases, scenes and results.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/summary.h"
#include "common/sensor_model.h"
#include "compiler/cad_model.h"
#include "runtime/database.h"
#include "runtime/foresight.h"

namespace foresight {

struct ExperimentOptions {
  std::vector<std::string> cad_files;  // empty: the eight objects of the paper, in the order of its Fig. 5
  std::string unit = "mm";             // of the CAD files
  std::string sensor_file;             // of the scans; empty: the experiment's own
  std::string compile_sensor_file;     // of the database; empty: as the scans
  std::string database_file;           // empty: compiled in this process
  std::string output = "results";      // folder
  std::string progress = "auto";
  std::uint64_t seed = 1;
  std::vector<std::string> methods = {"two-way", "paper"};  // each a set of rows; see method_names()
  int n = 0;                                                // scenes. Limit: >= 1.
  int jobs = 1;                                             // threads. Limit: >= 1.
  RecognizeOptions method;
};

// A file of the project, from its root.
[[nodiscard]] std::string project_path(const std::string& path);

// Reads and checks the CAD files of the options. Throws what read_cad_model throws.
[[nodiscard]] std::vector<CadModel> read_objects(const ExperimentOptions& options, const SensorModel& sensor);

// The sensor of a file, or the paper's for an empty name.
[[nodiscard]] SensorModel sensor_of(const std::string& file);

// The database of the options' file, or one compiled here for the sensor. Same models in the same order, or InputError.
[[nodiscard]] Database database_of(const ExperimentOptions& options, const std::vector<CadModel>& models,
                                   const SensorModel& sensor);

// Runs body(0) ... body(count - 1) on `jobs` threads, with progress. What they compute must not depend on the order.
void run_in_parallel(const ExperimentOptions& options, const std::string& title, int count,
                     const std::function<void(int)>& body);

// The objects to score, in the models' order.
[[nodiscard]] std::vector<ScoredObject> scored_objects(const std::vector<CadModel>& models);

// Something that recognizes objects in one scan: a method of this project, or a rival's chain in the same table.
struct Contestant {
  std::string name;  // of its rows
  std::function<RecognitionResult(const RangeImage&, const PinholeCamera&)> recognize;
};

// What options.methods may name: "two-way" (the default method), "paper", and the rivals where they are built in
// (FORESIGHT_RIVALS).
[[nodiscard]] std::vector<std::string> method_names();

// The contestants of the options, in their order. The database must outlive them. Throws UsageError for a name that is
// not one of method_names().
[[nodiscard]] std::vector<Contestant> contestants(const ExperimentOptions& options, const std::vector<CadModel>& models,
                                                  const SensorModel& sensor, const Database& database);

// What a result is scored against.
struct Bench {
  const std::vector<CadModel>& models;
  const std::vector<ScoredObject>& objects;
  const SensorModel& sensor;  // of the scans, but for the camera, which is the scan's own
};

// One scan with what it shows; the truth's objects index Bench::models.
struct TrueScan {
  std::string name;
  RangeImage image;
  PinholeCamera camera;
  std::vector<TrueObject> truth;
};

// Recognizes one scan and scores the result.
[[nodiscard]] SceneRecord recognize_and_score(const Bench& bench, const Contestant& contestant, const TrueScan& scan);

// Writes NAME.csv (summary), NAME_scenes.csv, NAME_calibration.csv and NAME.svg (right poses by set, a curve a method)
// into the output folder and prints the short table with what it holds for. The scenes of all methods.
void write_results(const ExperimentOptions& options, const std::string& name, const std::vector<SummaryRow>& rows,
                   const std::vector<SceneRecord>& scenes, const std::vector<CadModel>& models);

// Makes a folder where there is none. Throws InputError when that fails.
void make_folder(const std::string& folder);

// Writes one CSV into the output folder, which is made when missing.
void write_csv(const ExperimentOptions& options, const std::string& name, const Table& table);

}  // namespace foresight
