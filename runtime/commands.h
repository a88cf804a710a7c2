// The commands of foresight, with the options they take from the command line.
#pragma once

#include <string>
#include <vector>

#include "runtime/foresight.h"

namespace foresight {

// How to read scans.
struct ScanSource {
  std::string camera_file;  // of depth PNGs
  std::string unit = "mm";  // of PCD and PLY
};

struct RecognizeCommand {
  std::string database;
  std::vector<std::string> scans;
  std::string format = "text";
  ScanSource source;
  int deadline_ms = 0;  // 0: none
  std::string progress = "auto";
  RecognizeOptions options;
};

struct LocalizeCommand {
  std::string database;
  std::string scan;
  std::string object;
  std::string pose_file;
  ScanSource source;
  RecognizeOptions options;
};

struct SegmentCommand {
  std::string scan;
  std::string database;  // empty: default settings
  std::string output;
  bool color = false;
  ScanSource source;
};

struct SelftestCommand {
  std::string database;
  std::string format = "text";
};

// Each prints to stdout, returns the exit code and throws what common/errors.h lists.
int run_recognize(const RecognizeCommand& command);
int run_localize(const LocalizeCommand& command);
int run_segment(const SegmentCommand& command);
int run_selftest(const SelftestCommand& command);

}  // namespace foresight
