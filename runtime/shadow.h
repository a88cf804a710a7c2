// Why a sensor with a projector may have no data where a surface stands.
#pragma once

#include <Eigen/Core>

#include "runtime/pose_evidence.h"

namespace foresight {

// Whether something may keep the projector's light from a point of a surface: the surface itself, something seen, or
// something that nobody can know about, where the way to the projector leads behind what is seen or out of the image.
// Never without a projector. normal: outward. Unit: mm, sensor frame.
[[nodiscard]] bool may_be_in_shadow(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                                    const LabelledScan& scan);

}  // namespace foresight
