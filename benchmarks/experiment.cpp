#include "benchmarks/experiment.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>

#include "benchmarks/result_plots.h"
#include "benchmarks/view_comparison.h"
#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/memory_pool.h"
#include "common/program.h"
#include "compiler/compile.h"
#include "compiler/sensor_file.h"
#include "runtime/recognize.h"
#ifdef FORESIGHT_RIVALS
#include "benchmarks/rivals/rivals.h"
#endif

namespace foresight {
namespace {

double unit_in_mm(const std::string& unit) {
  if (unit == "cm") return 10.0;
  if (unit == "m") return 1000.0;
  if (unit == "in") return 25.4;
  return 1.0;
}

std::vector<std::string> paper_objects() {
  std::vector<std::string> files;
  for (const char* name :
       {"stapler", "holed_cube", "castle", "stick", "note_dispenser", "pencil_box", "rolodex", "tape_dispenser"}) {
    files.push_back(project_path("models/" + std::string(name) + ".off"));
  }
  return files;
}

int object_named(const std::vector<CadModel>& models, const std::string& name) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (models[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

std::string project_path(const std::string& path) { return std::string(FORESIGHT_SOURCE_DIR) + "/" + path; }

std::vector<CadModel> read_objects(const ExperimentOptions& options, const SensorModel& sensor) {
  CadReadOptions read;
  read.unit_mm = unit_in_mm(options.unit);
  std::vector<CadModel> models;
  for (const std::string& file : options.cad_files.empty() ? paper_objects() : options.cad_files) {
    models.push_back(read_cad_model(file, read));
    check_size(models.back(), file, read.unit_mm, sensor.field_of_view());
  }
  return models;
}

SensorModel sensor_of(const std::string& file) { return file.empty() ? paper_sensor() : read_sensor_file(file); }

Database database_of(const ExperimentOptions& options, const std::vector<CadModel>& models, const SensorModel& sensor) {
  if (!options.database_file.empty()) {
    Database database = load_database(options.database_file);
    for (const CompiledModel& model : database.models()) {
      if (object_named(models, model.name) >= 0) continue;
      throw InputError(options.database_file, "it holds an object named " + model.name + " that no CAD file describes",
                       "give the CAD files the database was compiled from with --cad");
    }
    for (const std::string& name : options.methods) {
      if (name == "two-way") check_method({}, database, options.database_file);
    }
    return database;
  }
  const CompileOptions compile;
  CompiledDatabase content = new_database(sensor, compile);
  content.models.resize(models.size());
  run_in_parallel(options, "compile", static_cast<int>(models.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    content.models[index] = compile_model(models[index], sensor, compile);
  });
  return Database(std::move(content));
}

void run_in_parallel(const ExperimentOptions& options, const std::string& title, int count,
                     const std::function<void(int)>& body) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(options.jobs));
  Progress progress(options.progress, title, count);
  tbb::parallel_for(0, count, [&](int i) {
    body(i);
    progress.advance();
  });
}

std::vector<ScoredObject> scored_objects(const std::vector<CadModel>& models) {
  std::vector<ScoredObject> objects;
  for (const CadModel& model : models) objects.push_back(scored_object(model));
  return objects;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names = {"two-way", "paper"};
#ifdef FORESIGHT_RIVALS
  for (const std::string& name : rival_names()) names.push_back(name);
#endif
  return names;
}

std::vector<Contestant> contestants(const ExperimentOptions& options, const std::vector<CadModel>& models,
                                    const SensorModel& sensor, const Database& database) {
  std::vector<Contestant> result;
  for (const std::string& name : options.methods) {
    if (name == "paper" || name == "two-way") {
      RecognizeOptions method = options.method;
      method.method = name == "paper" ? Method::paper : Method::two_way;
      result.push_back({name, [&database, method](const RangeImage& image, const PinholeCamera& camera) {
                          static thread_local MemoryPool pool;  // as each thread's Recognizer has one
                          const PoolScope scope(pool);
                          return recognize(image, camera, database, method);
                        }});
      continue;
    }
#ifdef FORESIGHT_RIVALS
    const std::vector<std::string> rivals = rival_names();
    if (std::find(rivals.begin(), rivals.end(), name) != rivals.end()) {
      result.push_back(make_rival(name, models, sensor));
      continue;
    }
#else
    (void)models;
    (void)sensor;
#endif
    std::string known;
    for (const std::string& other : method_names()) known.append(known.empty() ? "" : ", ").append(other);
    throw UsageError("--methods", "there is no method " + name + " in this build, only " + known,
                     "name those; rivals are built in with -DFORESIGHT_RIVALS=ON");
  }
  return result;
}

SceneRecord recognize_and_score(const Bench& bench, const Contestant& contestant, const TrueScan& scan) {
  const RecognitionResult result = contestant.recognize(scan.image, scan.camera);
  SensorModel sensor = bench.sensor;
  sensor.camera = scan.camera;
  SceneRecord record;
  record.method = contestant.name;
  record.name = scan.name;
  record.truth = scan.truth;
  for (const Detection& detection : result.detections) {
    ReportedObject report{object_named(bench.models, detection.object), pose_of(detection.T_sensor_model)};
    for (const Alternative& other : detection.ambiguous_with)
      report.alternatives.push_back({object_named(bench.models, other.object), pose_of(other.T_sensor_model)});
    record.reported.push_back(std::move(report));
    record.ranks.push_back(detection.rank);
    record.scores.push_back(detection.score);
  }
  record.verdicts = score_scene(
      bench.objects, record.truth, record.reported, [&](int object, const Pose& reported, const Pose& pose) {
        return indistinguishable(bench.models[static_cast<std::size_t>(object)], sensor, reported, pose);
      });
  record.statistics = result.statistics;
  record.milliseconds = result.milliseconds;
  return record;
}

void make_folder(const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw InputError(folder, "the folder cannot be made: " + failed.message(), "give another folder with -o");
}

void write_csv(const ExperimentOptions& options, const std::string& name, const Table& table) {
  make_folder(options.output);
  write_file_atomically(options.output + "/" + name + ".csv", to_csv(table));
}

void write_results(const ExperimentOptions& options, const std::string& name, const std::vector<SummaryRow>& rows,
                   const std::vector<SceneRecord>& scenes, const std::vector<CadModel>& models) {
  std::vector<std::string> names;
  for (const CadModel& model : models) names.push_back(model.name);
  write_csv(options, name, summary_table(rows, options.seed));
  write_csv(options, name + "_scenes", scene_table(scenes, names));
  write_csv(options, name + "_calibration", calibration_table(scenes));
  write_plots(options.output + "/" + name + ".svg", {right_pose_plot(name, rows)});
  std::cout << name << ", seed " << options.seed << "\n" << to_text(short_table(rows));
  if (options.jobs > 1)
    std::cout << "times: of " << options.jobs << " scans at once; use --jobs 1 for times that mean something\n";
}

}  // namespace foresight
