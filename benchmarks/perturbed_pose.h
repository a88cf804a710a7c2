// Starts for localization: a known pose, displaced.
#pragma once

#include "common/pose.h"
#include "common/random.h"

namespace foresight {

// Section VI.B: "randomly perturbed ... within 2 centimeters and 20 degrees of the known location". The text leaves the
// distribution open: a magnitude uniform up to these limits, or exactly these limits, each in a uniform direction.
enum class Perturbation { uniform_magnitude, exact_magnitude };

inline constexpr double kPerturbedBy = 20.0;                  // Unit: mm.
inline constexpr double kPerturbedTurn = 0.3490658503988659;  // 20 degrees. Unit: rad.

// The pose turned about the object's centre (model frame) and moved.
[[nodiscard]] Pose perturbed_pose(const Pose& T_sensor_model, const Eigen::Vector3d& centre, Perturbation kind,
                                  Random& random);

}  // namespace foresight
