// The rotation symmetries of a solid, from its geometry alone.
#pragma once

#include <vector>

#include "common/pose.h"
#include "compiler/cad_model.h"

namespace foresight {

struct SymmetryOptions {
  double distance = 0.1;  // planes, face centroids and corners coincide within this. Unit: mm. Limit: > 0.
  double angle = 0.0087;  // normals coincide within this. Unit: rad. Limit: > 0.
  double area = 1e-3;     // areas coincide within this share. Limit: > 0.
};

// Every proper rigid motion T_model_model that takes the planar faces and the corners (vertices where three or more
// faces meet) of the solid to themselves; the identity first, then by angle. At least one element. Mesh vertices inside
// a face or an edge play no part: they belong to the triangulation, not to the solid.
[[nodiscard]] std::vector<Pose> find_symmetries(const CadModel& model, const SymmetryOptions& options = {});

// The same motions as a group: products of any two are among them to rounding, so that a pose has the same equivalent
// poses from whichever of them one starts. Where tolerances leave a product out, what breaks the rule goes. The
// identity alone where there are more than `most` (a cylinder of very many facets: a part of its turns would be no
// group) or more than 1000 faces (whose search would take minutes).
[[nodiscard]] std::vector<Pose> symmetry_group(const CadModel& model, int most, const SymmetryOptions& options = {});

}  // namespace foresight
