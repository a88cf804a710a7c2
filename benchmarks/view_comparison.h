// Can a view tell two poses of an object apart at all?
#pragma once

#include "common/pose.h"
#include "common/sensor_model.h"
#include "compiler/cad_model.h"

namespace foresight {

struct ViewComparisonOptions {
  double distance = 5.0;         // cells agree when their data points are within this. Unit: mm. Limit: > 0.
  double smallest_share = 0.95;  // of the cells that show the object at either pose. Limit: (0, 1].
};

// Share of the cells showing the object, alone, at either pose that show it at both with the data points near each
// other. The sensor's shadows and blind angles count, its noise and quantization do not. 0 when neither pose is in
// view.
[[nodiscard]] double view_agreement(const CadModel& model, const SensorModel& sensor, const Pose& a, const Pose& b,
                                    double distance);

[[nodiscard]] bool indistinguishable(const CadModel& model, const SensorModel& sensor, const Pose& reported,
                                     const Pose& truth, const ViewComparisonOptions& options = {});

}  // namespace foresight
