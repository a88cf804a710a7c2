// What `foresight recognize --format json` printed, read back.
#pragma once

#include <string>
#include <vector>

#include "common/pose.h"

namespace foresight {

struct ScanResult {
  struct Object {
    std::string object;
    Pose T_sensor_model;
    std::vector<Object> ambiguous_with = {};  // of a detection; empty in results of versions that did not tell
  };
  std::string scan;  // the path recognize was given
  std::vector<Object> detections;
};

// One JSON object a line. Throws InputError: missing, empty, a line that is no result, a pose that is no rigid motion.
[[nodiscard]] std::vector<ScanResult> read_result_file(const std::string& file);

}  // namespace foresight
