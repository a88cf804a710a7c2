// The commands of foresightc, with the options they take from the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/compile.h"

namespace foresight {

struct CompileCommand {
  std::vector<std::string> cad_files;
  std::vector<std::string> names;     // none, or one a CAD file
  std::string output;
  std::string sensor_file;            // empty: the paper's sensor
  std::string unit = "mm";
  std::string depfile;                // empty: none
  std::string depfile_target;         // what it says is made; empty: the output
  std::string progress = "auto";
  int jobs = 0;                       // 0: all cores
  CompileOptions options;
};

struct LinkCommand {
  std::vector<std::string> databases;
  std::string output;
};

struct InspectCommand {
  std::string database;
  bool json = false;
};

struct SimulateCommand {
  std::vector<std::string> cad_files;
  std::string output;
  std::string sensor_file;
  std::string unit = "mm";
  std::string objects = "1";          // "3" or "3-6"
  std::string format = "pcd";
  std::string progress = "auto";
  int scenes = 10;
  bool background = false;
  std::optional<double> noise;        // mm; replaces the sensor's
  std::uint64_t seed = 1;
  int jobs = 0;
};

// Each returns the exit code and throws what common/errors.h lists; nothing is half-written.
int run_compile(const CompileCommand& command);
int run_link(const LinkCommand& command);
int run_inspect(const InspectCommand& command);
int run_simulate(const SimulateCommand& command);

}  // namespace foresight
