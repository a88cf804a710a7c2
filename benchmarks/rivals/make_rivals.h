// One source each.
#pragma once

#include <vector>

#include "benchmarks/experiment.h"
#include "common/sensor_model.h"
#include "compiler/cad_model.h"

namespace foresight {

[[nodiscard]] Contestant make_pcl_ppf(const std::vector<CadModel>& models, const SensorModel& sensor);
[[nodiscard]] Contestant make_pcl_fpfh(const std::vector<CadModel>& models, const SensorModel& sensor);
[[nodiscard]] Contestant make_opencv_ppf(const std::vector<CadModel>& models, const SensorModel& sensor);

}  // namespace foresight
