// A series of scans, recognized by every contestant and scored.
#pragma once

#include <functional>
#include <memory>

#include "benchmarks/experiment.h"
#include "compiler/scene_generator.h"

namespace foresight {

// Objects, database and contestants of one series; all its scans share them.
struct SeriesSetup {
  std::vector<CadModel> models;
  std::vector<ScoredObject> objects;
  SensorModel sensor;  // of the scans
  std::unique_ptr<const Database> database;
  std::vector<Contestant> contestants;
};

// sensor_file: of the scans where the options name none; empty: the paper's. The database is compiled for the sensor of
// the scans where the options name no other.
[[nodiscard]] SeriesSetup set_up_series(const ExperimentOptions& options, const std::string& sensor_file = "");

// draw(i) makes scan i, the same whatever was drawn before. Records in the order of the contestants, of each in the
// order of the scans. Every scan is drawn once for all contestants.
[[nodiscard]] std::vector<std::vector<SceneRecord>> recognize_series(const ExperimentOptions& options,
                                                                     const std::string& title, const SeriesSetup& setup,
                                                                     int count,
                                                                     const std::function<TrueScan(int)>& draw);

// Rows of one method's records; all methods' rows one after the other.
using RowsOf = std::function<std::vector<SummaryRow>(const std::vector<SceneRecord>&)>;
[[nodiscard]] std::vector<SummaryRow> rows_of_all(const std::vector<std::vector<SceneRecord>>& records,
                                                  const RowsOf& rows_of);

// All records in one list.
[[nodiscard]] std::vector<SceneRecord> joined(const std::vector<std::vector<SceneRecord>>& records);

// Scene i shows model i mod (number of models) alone: every model in n / models random views, as in Section VI.C.1.
[[nodiscard]] Scene single_object_scene(const std::vector<CadModel>& models, const SensorModel& sensor, bool background,
                                        std::uint64_t seed, int index);

// The truth of a scene for scoring. Its objects index the models the scene was drawn from.
[[nodiscard]] std::vector<TrueObject> truth_of(const Scene& scene);

// n scenes of single objects: recognized, scored, summed up by object and over all, written as NAME. Returns the rows
// over all objects, one a method.
std::vector<SummaryRow> run_single_object_series(const ExperimentOptions& options, const std::string& name,
                                                 const std::string& sensor_file);

// Rows by the object of single-object scenes, and over all.
[[nodiscard]] std::vector<SummaryRow> rows_by_object(const std::vector<CadModel>& models,
                                                     const std::vector<SceneRecord>& records);

}  // namespace foresight
