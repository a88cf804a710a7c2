// How far a reported pose is off, whichever of the poses at which the object looks the same it is.
//
// Right pose: MSSD (BOP's maximum symmetry-aware surface distance: the largest distance of a vertex between reported
// and true pose, minimised over the symmetries) of at most 5 mm or 5 % of the object's diameter, whichever is larger.
#pragma once

#include <vector>

#include "common/compiled_model.h"
#include "common/pose.h"

namespace foresight {

inline constexpr double kRightDistance = 5.0;  // Unit: mm.
inline constexpr double kRightShare = 0.05;    // of the diameter

// What scoring needs to know about an object.
struct ScoredObject {
  std::vector<Eigen::Vector3d> vertices;  // Unit: mm.
  std::vector<Pose> symmetries;           // T_model_model, the identity first
  double diameter = 0.0;                  // Unit: mm.

  [[nodiscard]] double tolerance() const;  // Unit: mm.
};
// With the exact symmetries.
[[nodiscard]] ScoredObject scored_object(const CompiledModel& model);

// Unit: mm.
[[nodiscard]] double mssd(const ScoredObject& object, const Pose& reported, const Pose& truth);

// Of the poses at which the object looks as at the true one, the one whose mssd is the least.
[[nodiscard]] Pose nearest_equal(const ScoredObject& object, const Pose& reported, const Pose& truth);

}  // namespace foresight
