// Robust pose refinement by 3D template matching (Section V.A, V.B, eqs. (6)-(10)).
#pragma once

#include <vector>

#include "common/compiled_model.h"
#include "common/pose.h"
#include "common/viewing_sphere.h"
#include "runtime/foresight.h"
#include "runtime/nearest_data_point.h"

namespace foresight {

struct LocalizationOptions {
  Loss loss = Loss::lorentzian;
  double sigma = 2.0;                      // standard deviation of the sensor's error, Section V.B. Unit: mm. Limit: > 0.
  double translation_step = 1.0;           // Section V.B. Unit: mm. Limit: > 0.
  double rotation_step = 0.017453292519943295;  // 1 degree, Section V.B. Unit: rad. Limit: > 0.
  int most_rounds = 50;                    // the paper's UNTIL may cycle when the aspect changes: a cap on its rounds. Limit: >= 1.
};

struct Localization {
  Pose T_sensor_model;
  double energy = 0.0;             // E of eq. (9) at the end
  int energy_evaluations = 0;      // Table I's cost
};

// Indices of the template points visible in a pose: those of the faces in the aspect of the current viewing direction. V(q).
[[nodiscard]] std::vector<int> visible_points(const CompiledModel& model, const ViewingSphere& sphere, const Pose& T_sensor_model);

// E(q) of eq. (9) over fixed visible points.
[[nodiscard]] double localization_energy(const CompiledModel& model, const std::vector<int>& visible, const Pose& T_sensor_model,
                                         const NearestDataPoint& data, const LocalizationOptions& options);

// The paper's pseudo-code: line searches of fixed step in the gradient direction, translation and rotation in turn, the
// aspect fixed within each. sphere: ViewingSphere(80).
[[nodiscard]] Localization localize(const CompiledModel& model, const ViewingSphere& sphere, const Pose& start,
                                    const NearestDataPoint& data, const LocalizationOptions& options);

}  // namespace foresight
