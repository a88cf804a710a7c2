// Sensor files: foresight.v1.SensorModel as protobuf text (models/sensors/*.textproto).
#pragma once

#include <string>

#include "common/sensor_model.h"

namespace foresight {

// Throws InputError with line and column for text that does not parse, and for values outside their limits.
[[nodiscard]] SensorModel read_sensor_file(const std::string& file);

// The sensor of the paper: 240x256 cells, no noise, no shadow, one distance (Section III). Used when no file is given.
[[nodiscard]] SensorModel paper_sensor();

}  // namespace foresight
