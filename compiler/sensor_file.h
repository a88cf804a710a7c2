// Sensor files: foresight.v1.SensorModel as protobuf text (models/sensors/*.textproto).
#pragma once

#include <string>
#include <string_view>

#include "common/sensor_model.h"

namespace foresight {

// `file` names the source in errors. Throws InputError with line and column for text that does not parse or has fields
// the schema does not know, and with the field for values that are missing or outside their limits.
[[nodiscard]] SensorModel parse_sensor(std::string_view text, const std::string& file);

// The same from a file. Throws InputError also when it cannot be read.
[[nodiscard]] SensorModel read_sensor_file(const std::string& file);

// The sensor of the paper: 240x256 cells, no noise, no shadow, one distance (Section III). Used when no file is given;
// models/sensors/paper.textproto says the same.
[[nodiscard]] SensorModel paper_sensor();

}  // namespace foresight
