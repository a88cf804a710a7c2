// Real structured-light scans of blocks with known poses (SegComp ABW): what the paper's Section VI.C.2 asks, on images
// of its time.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/scene_picture.h"
#include "benchmarks/series.h"
#include "benchmarks/truth_file.h"
#include "common/errors.h"
#include "common/scan_file.h"

namespace foresight {
namespace {

std::string default_folder() {
  const char* set = std::getenv("FORESIGHT_DATA");
  return set != nullptr ? set : project_path("../shared/data");
}

std::vector<std::string> cad_files_in(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".obj") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw InputError(folder, "it holds no .obj file", "give a data folder with abw/models");
  return files;
}

std::vector<TrueObject> truth_of(const ScanTruth& scan, const std::vector<CadModel>& models, const std::string& file) {
  std::vector<TrueObject> truth;
  for (const ScanTruth::Object& object : scan.objects) {
    const auto model =
        std::find_if(models.begin(), models.end(), [&](const CadModel& m) { return m.name == object.object; });
    if (model == models.end())
      throw InputError(file, "it names an object " + object.object + " without a model", "add the model to models/");
    truth.push_back({static_cast<int>(model - models.begin()), object.poses, object.visible_fraction});
  }
  return truth;
}

void run_real(ExperimentOptions options, const std::string& folder) {
  if (options.cad_files.empty()) options.cad_files = cad_files_in(folder + "/models");
  const SeriesSetup setup = set_up_series(options, project_path("models/sensors/abw.textproto"));
  const std::string truth_file = folder + "/truth.json";
  const std::vector<ScanTruth> scans = read_truth_file(truth_file);
  write_csv(options, "real", {});  // makes the folder, and tells now whether it can be written

  const auto draw = [&](int i) {
    const ScanTruth& truth = scans[static_cast<std::size_t>(i)];
    Scan scan =
        read_scan(folder + "/scans/" + truth.scan + ".png", {folder + "/camera_" + truth.camera + ".json", 1.0});
    return TrueScan{truth.scan, std::move(scan.image), *scan.camera, truth_of(truth, setup.models, truth_file)};
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
  const auto folder = std::make_shared<std::string>(default_folder());
  CLI::App* command = app.add_subcommand(
      "real", "Real scans of blocks with known poses, with a picture of each (skipped without the data)");
  add_common_options(*command, *options, 0);
  command->add_option("--data", *folder,
                      "Data folder that holds abw/; FORESIGHT_DATA, or ../shared/data beside the checkout");
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options, folder] {
            if (!std::filesystem::exists(*folder + "/abw/truth.json")) {
              std::cout << "real: skipped, there is no " << *folder
                        << "/abw/truth.json; give the folder with --data or FORESIGHT_DATA\n";
              return static_cast<int>(kExitDone);
            }
            run_real(*options, *folder + "/abw");
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
