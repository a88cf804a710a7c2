// One pose for all that look the same: which of the equivalent poses of a symmetric object is reported.
#pragma once

#include "common/compiled_model.h"
#include "common/memory_pool.h"
#include "common/pose.h"

namespace foresight {

// A pose with the exact symmetry that led to it.
struct CanonicalPose {
  Pose T_sensor_model;  // the given pose times T_model_model
  Pose T_model_model;   // a symmetry of the model, or the identity
};

// Of all poses T * S, S an exact symmetry of the model or the identity: the one turned least from the sensor's axes
// (largest trace of the rotation). Among turns equal within 1e-6, the one whose matrix is the largest number by number,
// row by row, again within 1e-6: not the place of S in the list, which depends on the pose one came with. So each of
// the equivalent poses gives the same one, and it stays the same under small changes of the pose except where two turns
// are equal, which no rule can avoid.
[[nodiscard]] CanonicalPose canonical_choice(const CompiledModel& model, const Pose& T_sensor_model);
[[nodiscard]] Pose canonical_pose(const CompiledModel& model, const Pose& T_sensor_model);

// The faces that lie, at the pose T * S, where the given ones lie at the pose T: each face moved by the inverse of S,
// as the face whose centroid, normal and area it comes nearest to. T_model_model: S, an exact symmetry.
[[nodiscard]] PoolVector<int> moved_faces(const CompiledModel& model, const PoolVector<int>& faces,
                                          const Pose& T_model_model);

// The poses T * N, N a near symmetry of the model, most overlap first: what else to look at when T fits. Of poses that
// differ by an exact symmetry alone, one is in the list.
[[nodiscard]] PoolVector<Pose> near_symmetric_poses(const CompiledModel& model, const Pose& T_sensor_model);

}  // namespace foresight
