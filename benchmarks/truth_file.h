// The truth of a folder of real scans: truth.json beside scans/, models/ and the camera files.
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
  std::string scan;    // name without folder and ending
  std::string camera;  // the camera file is camera_NAME.json
  std::vector<Object> objects;
};

// Throws InputError: missing, not JSON, an entry missing or of the wrong kind, a pose that is no rigid motion.
[[nodiscard]] std::vector<ScanTruth> read_truth_file(const std::string& file);

}  // namespace foresight
