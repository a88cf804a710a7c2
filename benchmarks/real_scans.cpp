#include "benchmarks/real_scans.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "benchmarks/experiment.h"
#include "common/errors.h"

namespace foresight {

std::string default_data_folder() {
  const char* set = std::getenv("FORESIGHT_DATA");
  return set != nullptr ? set : project_path("../shared/data");
}

void add_data_option(CLI::App& command, std::string& folder) {
  folder = default_data_folder();
  command.add_option("--data", folder,
                     "Data folder that holds abw/ and boxes/; FORESIGHT_DATA, or ../shared/data beside the checkout");
}

bool has_data_file(const std::string& folder, const std::string& file, const std::string& experiment) {
  if (std::filesystem::exists(folder + "/" + file)) return true;
  std::cout << experiment << ": skipped, there is no " << folder << "/" << file
            << "; give the folder with --data or FORESIGHT_DATA\n";
  return false;
}

bool has_abw_scans(const std::string& folder, const std::string& experiment) {
  return has_data_file(folder, "abw/truth.json", experiment);
}

std::vector<std::string> cad_files_in(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    if (entry.path().extension() == ".obj") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw InputError(folder, "it holds no .obj file", "give a data folder with models");
  return files;
}

Scan read_abw_scan(const std::string& abw, const ScanTruth& truth) {
  return read_scan(abw + "/scans/" + truth.scan + ".png", {abw + "/camera_" + truth.camera + ".json", 1.0});
}

std::vector<TrueObject> check_truth(const ScanTruth& scan, const std::vector<CadModel>& models,
                                    const std::string& file) {
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

}  // namespace foresight
