// Real structured-light scans of blocks with known poses (SegComp ABW): what the paper's Section VI.C.2 asks, on images
// of its time.
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/real_scans.h"
#include "benchmarks/scene_picture.h"
#include "common/errors.h"

namespace foresight {
namespace {

void run_real(ExperimentOptions options, const std::string& folder) {
  if (options.cad_files.empty()) options.cad_files = cad_files_in(folder + "/models");
  const SensorModel sensor =
      sensor_of(options.sensor_file.empty() ? project_path("models/sensors/abw.textproto") : options.sensor_file);
  const std::vector<CadModel> models = read_objects(options, sensor);
  const std::vector<ScoredObject> objects = scored_objects(models);
  const std::string truth_file = folder + "/truth.json";
  const std::vector<ScanTruth> scans = read_truth_file(truth_file);
  const Database database = database_of(
      options, models, options.compile_sensor_file.empty() ? sensor : sensor_of(options.compile_sensor_file));
  write_csv(options, "real", {});  // makes the folder, and tells now whether it can be written

  std::vector<SceneRecord> records(scans.size());
  run_in_parallel(options, "real", static_cast<int>(scans.size()), [&](int i) {
    const ScanTruth& truth = scans[static_cast<std::size_t>(i)];
    const Scan scan = read_abw_scan(folder, truth);
    SensorModel used = sensor;
    used.camera = *scan.camera;
    records[static_cast<std::size_t>(i)] =
        recognize_and_score({models, objects, database, used, options.method}, truth.scan, scan.image,
                            check_truth(truth, models, truth_file));
    const SceneRecord& record = records[static_cast<std::size_t>(i)];
    write_picture(options.output + "/" + truth.scan + ".png",
                  draw_scene(scan.image, used.camera, models, record.truth, record.reported));
  });
  std::vector<SummaryRow> rows = {summarize("visible >= 50 %", records, {0.5, 2.0}), summarize("all", records)};
  write_results(options, "real", rows, records, models);
}

}  // namespace

Experiment add_real(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  const auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "real", "Real scans of blocks with known poses, with a picture of each (skipped without the data)");
  add_common_options(*command, *options, 0);
  add_data_option(*command, *folder);
  add_object_options(*command, *options);
  add_method_options(*command, options->method);
  return {command, [options, folder] {
            if (has_abw_scans(*folder, "real")) run_real(*options, *folder + "/abw");
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
