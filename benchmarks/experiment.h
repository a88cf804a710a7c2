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
  int n = 0;     // scenes. Limit: >= 1.
  int jobs = 1;  // threads. Limit: >= 1.
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

// What one experiment recognizes with and scores against.
struct Bench {
  const std::vector<CadModel>& models;
  const std::vector<ScoredObject>& objects;
  const Database& database;
  const SensorModel& sensor;  // of the scan
  const RecognizeOptions& method;
};

// Recognizes one scan and scores the result. The truth's objects index bench.models.
[[nodiscard]] SceneRecord recognize_and_score(const Bench& bench, const std::string& name, const RangeImage& image,
                                              std::vector<TrueObject> truth);

// Writes NAME.csv (summary) and NAME_scenes.csv into the output folder and prints the short table with what it holds
// for.
void write_results(const ExperimentOptions& options, const std::string& name, const std::vector<SummaryRow>& rows,
                   const std::vector<SceneRecord>& scenes, const std::vector<CadModel>& models);

// Makes a folder where there is none. Throws InputError when that fails.
void make_folder(const std::string& folder);

// Writes one CSV into the output folder, which is made when missing.
void write_csv(const ExperimentOptions& options, const std::string& name, const Table& table);

}  // namespace foresight
