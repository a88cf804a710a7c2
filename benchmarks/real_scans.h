// The real scans of a data folder that may stand beside the checkout; experiments on them are skipped without it.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <string>
#include <vector>

#include "benchmarks/pose_scoring.h"
#include "benchmarks/truth_file.h"
#include "common/scan_file.h"
#include "compiler/cad_model.h"

namespace foresight {

// FORESIGHT_DATA, or ../shared/data beside the checkout.
[[nodiscard]] std::string default_data_folder();

// --data, with that default.
void add_data_option(CLI::App& command, std::string& folder);

// Whether the folder holds a file; says on the terminal that `experiment` is skipped where it does not.
[[nodiscard]] bool has_data_file(const std::string& folder, const std::string& file, const std::string& experiment);

// Whether the folder holds the ABW scans; says on the terminal that `experiment` is skipped where it does not.
[[nodiscard]] bool has_abw_scans(const std::string& folder, const std::string& experiment);

// The OBJ files of a folder, by name. Throws InputError when there are none.
[[nodiscard]] std::vector<std::string> cad_files_in(const std::string& folder);

// A scan that the truth file of `abw` names, with its own camera. Throws what read_scan throws.
[[nodiscard]] Scan read_abw_scan(const std::string& abw, const ScanTruth& truth);

// The true objects of a scan. Throws InputError naming the truth file when one is not among the models.
[[nodiscard]] std::vector<TrueObject> check_truth(const ScanTruth& scan, const std::vector<CadModel>& models,
                                                  const std::string& file);

}  // namespace foresight
