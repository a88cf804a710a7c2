// Rough pose from two or three matches of planar regions with planar faces (Section IV.B).
#pragma once

#include <optional>
#include <span>

#include "common/compiled_model.h"
#include "common/pose.h"
#include "common/region_attributes.h"

namespace foresight {

struct RegionFaceMatch {
  const DescribedRegion* region = nullptr;
  const ModelFace* face = nullptr;
};

// Rotation by least squares on the normals, completed by the directions between centroids where all normals are
// parallel; translation from the plane offsets, completed by the centroids ("using center of gravity as an additional
// constraint") in the directions the planes leave free. None when the rotation stays undetermined. REQUIRES: at least
// two matches.
[[nodiscard]] std::optional<Pose> pose_from_matches(std::span<const RegionFaceMatch> matches);

}  // namespace foresight
