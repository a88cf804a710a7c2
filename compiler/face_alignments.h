// Rigid motions that lay large faces of an object on others: where near symmetries are looked for.
#pragma once

#include <vector>

#include "common/pose.h"
#include "compiler/cad_model.h"

namespace foresight {

struct FaceAlignmentOptions {
  double distance = 4.0;     // offsets of faces this near are one. Unit: mm. Limit: > 0.
  double least_share = 0.5;  // of the large faces' area that a rotation lays on area of the same normal. Limit: [0, 1].
};

// Motions T_model_model that lay two of the eight largest faces, not parallel, in the directions of two of the 32
// largest with the same angle between them (5 degrees); of these, the 128 rotations, 5 degrees apart, that bring most
// area together. Each with up to 64 translations: along three axes, the three offsets that bring most area together and
// that of the surface's centres. Deterministic, at most 8192.
[[nodiscard]] std::vector<Pose> face_alignments(const CadModel& model, const FaceAlignmentOptions& options);

// Centre of gravity of the surface. Unit: mm.
[[nodiscard]] Eigen::Vector3d surface_centre(const CadModel& model);

// Right-handed axes from two directions that are not parallel: the first, one in their plane, their cross product.
[[nodiscard]] Eigen::Matrix3d axes_from(const Eigen::Vector3d& first, const Eigen::Vector3d& second);

}  // namespace foresight
