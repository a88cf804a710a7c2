// What a folder of scans shows: the truth.json that `foresightc simulate` writes beside its scans, and that of real
// scans, which has cameras and equally good poses besides.
#pragma once

#include <string>
#include <vector>

#include "common/pose.h"

namespace foresight {

struct ScanTruth {
  struct Object {
    std::string object;
    std::vector<Pose> poses;  // T_sensor_model, then equally good ones
    double visible_fraction = 0.0;
  };
  std::string scan;    // name without folder; of real scans without ending, too
  std::string camera;  // the camera file is camera_NAME.json; empty where the file names none
  std::vector<Object> objects;
};

// Throws InputError: missing, not JSON, an entry missing or of the wrong kind, a pose that is no rigid motion.
[[nodiscard]] std::vector<ScanTruth> read_truth_file(const std::string& file);

}  // namespace foresight
