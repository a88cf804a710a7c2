// show_results: draws what `foresight recognize` found into pictures and, where the truth is known, says what is right.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "benchmarks/experiment.h"
#include "benchmarks/result_file.h"
#include "benchmarks/scene_picture.h"
#include "benchmarks/table.h"
#include "benchmarks/truth_file.h"
#include "benchmarks/view_comparison.h"
#include "common/errors.h"
#include "common/program.h"
#include "common/scan_file.h"

namespace foresight {
namespace {

namespace fs = std::filesystem;

struct ShowCommand {
  std::string results;
  std::string camera_file;
  std::string scan_unit = "mm";
  ExperimentOptions options;  // CAD files, their unit, sensor file, output folder
};

struct Tally {
  int objects = 0;
  int right = 0;
  int declared = 0;
  int indistinguishable = 0;
  int false_reports = 0;
};

int object_named(const std::vector<CadModel>& models, const std::string& name) {
  const auto found =
      std::find_if(models.begin(), models.end(), [&](const CadModel& model) { return model.name == name; });
  return found == models.end() ? -1 : static_cast<int>(found - models.begin());
}

// Folder and name of a scan: enough to tell scans of several folders apart.
fs::path short_name(const fs::path& scan) { return scan.parent_path().filename() / scan.filename(); }

// The truth.json beside a scan, or nothing where none of them speaks of it.
std::optional<std::vector<TrueObject>> truth_of(const fs::path& scan, const std::vector<CadModel>& models) {
  const fs::path file = scan.parent_path() / "truth.json";
  if (!fs::exists(file)) return std::nullopt;
  for (const ScanTruth& entry : read_truth_file(file.string())) {
    if (entry.scan != scan.filename() && entry.scan != scan.stem()) continue;
    std::vector<TrueObject> truth;
    for (const ScanTruth::Object& object : entry.objects) {
      const int index = object_named(models, object.object);
      if (index < 0)
        throw InputError(file.string(), "it names an object " + object.object, "give its CAD file with --cad");
      truth.push_back({index, object.poses, object.visible_fraction});
    }
    return truth;
  }
  return std::nullopt;
}

const char* words(Verdict verdict) {
  switch (verdict) {
    case Verdict::missed:
      return "MISSED";
    case Verdict::right:
      return "right";
    case Verdict::declared:
      return "named among its alternatives";
    case Verdict::indistinguishable:
      return "right as far as the view can tell";
    case Verdict::wrong_pose:
      return "WRONG POSE";
    case Verdict::false_positive:
      return "NOT THERE";
    case Verdict::duplicate:
      return "found twice";
  }
  return "";
}

// A row for each true object, and one for each report that is not right.
void add_rows(Table& table, Tally& tally, const std::string& scan, const std::vector<CadModel>& models,
              const std::vector<TrueObject>& truth, const std::vector<ReportedObject>& reported,
              const SceneVerdicts& verdicts) {
  const auto name = [&](int object) {
    return object < 0 ? "no object of --cad" : models[static_cast<std::size_t>(object)].name;
  };
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Verdict verdict = verdicts.truth[i];
    const std::string found = verdict == Verdict::missed ? "-" : name(truth[i].object);
    table.rows.push_back(
        {scan, name(truth[i].object), decimal(100.0 * truth[i].visible_fraction, 0) + " %", found, words(verdict)});
    ++tally.objects;
    tally.right += verdict == Verdict::right ? 1 : 0;
    tally.declared += verdict == Verdict::declared ? 1 : 0;
    tally.indistinguishable += verdict == Verdict::indistinguishable ? 1 : 0;
  }
  for (std::size_t i = 0; i < reported.size(); ++i) {
    const Verdict verdict = verdicts.reported[i];
    if (verdict == Verdict::right || verdict == Verdict::declared || verdict == Verdict::indistinguishable) continue;
    table.rows.push_back({scan, "-", "", name(reported[i].object), words(verdict)});
    ++tally.false_reports;
  }
}

std::vector<ReportedObject> reported_objects(const ScanResult& result, const std::vector<CadModel>& models) {
  std::vector<ReportedObject> reported;
  for (const ScanResult::Object& detection : result.detections) {
    ReportedObject report{object_named(models, detection.object), detection.T_sensor_model};
    for (const ScanResult::Object& other : detection.ambiguous_with)
      report.alternatives.push_back({object_named(models, other.object), other.T_sensor_model});
    reported.push_back(std::move(report));
  }
  return reported;
}

void write_scene_picture(const std::string& file, const RangeImage& image, const PinholeCamera& camera,
                         const std::vector<CadModel>& models, const std::vector<TrueObject>& truth,
                         const std::vector<ReportedObject>& reported) {
  constexpr int kColumns = 768;  // small scans are enlarged towards this width
  const int pixels = std::max(1, kColumns / image.columns);
  write_picture(file, draw_scene(image, camera, models, truth, reported, pixels));
}

std::string picture_name(const fs::path& scan) {
  return scan.parent_path().filename().string() + "_" + scan.stem().string() + ".png";
}

int run_show(const ShowCommand& command) {
  SensorModel sensor = sensor_of(command.options.sensor_file);
  const std::vector<CadModel> models = read_objects(command.options, sensor);
  const std::vector<ScoredObject> objects = scored_objects(models);
  make_folder(command.options.output);
  Table table{{"scan", "true object", "visible", "recognized", "verdict"}, {}};
  Tally tally;
  for (const ScanResult& result : read_result_file(command.results)) {
    const Scan scan = read_scan(result.scan, {command.camera_file, command.scan_unit == "m" ? 1000.0 : 1.0});
    const std::optional<PinholeCamera> camera = scan.camera ? scan.camera : fit_camera(scan.image);
    if (!camera)
      throw InputError(result.scan, "its grid is not that of a pinhole camera", "give a scan that recognize took");
    sensor.camera = *camera;
    const std::optional<std::vector<TrueObject>> truth = truth_of(result.scan, models);
    const std::vector<ReportedObject> reported = reported_objects(result, models);
    write_scene_picture(command.options.output + "/" + picture_name(result.scan), scan.image, *camera, models,
                        truth.value_or(std::vector<TrueObject>()), reported);
    if (!truth) continue;
    const SceneVerdicts verdicts =
        score_scene(objects, *truth, reported, [&](int object, const Pose& a, const Pose& b) {
          return indistinguishable(models[static_cast<std::size_t>(object)], sensor, a, b);
        });
    add_rows(table, tally, short_name(result.scan).string(), models, *truth, reported, verdicts);
  }
  if (!table.rows.empty()) {
    std::cout << to_text(table) << tally.objects << " true objects: " << tally.right
              << " recognized with the right pose, " << tally.indistinguishable
              << " right as far as the view can tell, " << tally.declared
              << " named among the alternatives of a report, "
              << tally.objects - tally.right - tally.declared - tally.indistinguishable << " missed; "
              << tally.false_reports << " wrong reports\n";
  }
  return kExitDone;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Draws what `foresight recognize --format json` found; compares it with the truth.json beside each scan.",
      "show_results");
  ShowCommand command;
  command.options.output = "pictures";
  app.add_option("RESULTS", command.results, "File of JSON lines that `foresight recognize --format json` printed")
      ->required();
  app.add_option("--cad", command.options.cad_files,
                 "CAD files the database was compiled from; the eight of models/ when not given");
  app.add_option("--unit", command.options.unit, "Unit of the CAD files")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}))
      ->capture_default_str();
  app.add_option("--sensor", command.options.sensor_file,
                 "Sensor file of the scans; the paper's sensor when not given");
  app.add_option("--camera", command.camera_file, "Camera JSON of depth PNGs");
  app.add_option("--scan-unit", command.scan_unit, "Unit of PCD and PLY scans")
      ->check(CLI::IsMember({"mm", "m"}))
      ->capture_default_str();
  app.add_option("-o,--output", command.options.output, "Folder for the pictures, made when missing")
      ->capture_default_str();
  return run_program("show_results", app, argc, argv, [&] { return run_show(command); });
}

}  // namespace
}  // namespace foresight

int main(int argc, char** argv) { return foresight::run(argc, argv); }
