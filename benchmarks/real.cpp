// Real structured-light scans of blocks with known poses (SegComp ABW): what the paper's Section VI.C.2 asks, on images
// of its time.
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/real_scans.h"
#include "benchmarks/scene_picture.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {
namespace {

void run_real(ExperimentOptions options, const std::string& folder) {
  if (options.cad_files.empty()) options.cad_files = cad_files_in(folder + "/models");
  const SeriesSetup setup = set_up_series(options, project_path("models/sensors/abw.textproto"));
  const std::string truth_file = folder + "/truth.json";
  const std::vector<ScanTruth> scans = read_truth_file(truth_file);
  write_csv(options, "real", {});  // makes the folder, and tells now whether it can be written

  const auto draw = [&](int i) {
    const ScanTruth& truth = scans[static_cast<std::size_t>(i)];
    Scan scan = read_abw_scan(folder, truth);
    return TrueScan{truth.scan, std::move(scan.image), *scan.camera, check_truth(truth, setup.models, truth_file)};
  };
  const auto records = recognize_series(options, "real", setup, static_cast<int>(scans.size()), draw);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const TrueScan scan = draw(static_cast<int>(i));
    for (const auto& of_method : records) {
      write_picture(options.output + "/" + of_method[i].method + "_" + scan.name + ".png",
                    draw_scene(scan.image, scan.camera, setup.models, scan.truth, of_method[i].reported));
    }
  }
  const auto by_visibility = [](const std::vector<SceneRecord>& of_method) {
    return std::vector{summarize("visible >= 50 %", of_method, {0.5, 2.0}), summarize("all", of_method)};
  };
  write_results(options, "real", rows_of_all(records, by_visibility), joined(records), setup.models);
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
  add_method_options(*command, *options);
  return {command, [options, folder] {
            if (has_abw_scans(*folder, "real")) run_real(*options, *folder + "/abw");
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
