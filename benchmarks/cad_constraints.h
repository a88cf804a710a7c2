// Matches by the CAD geometry alone, without a sensor model: the unary and binary constraints of an interpretation tree
// (Grimson and Lozano-Perez, "Localizing Overlapping Parts by Searching the Interpretation Tree", PAMI 9(4), 1987),
// which Section VI.C compares the method with.
#pragma once

#include <vector>

#include "common/relation_attributes.h"
#include "compiler/cad_model.h"
#include "runtime/hypothesis_field.h"

namespace foresight {

// Attributes of the whole faces of one solid, as an undisturbed view of each would give them.
struct CadGeometry {
  std::vector<AttributeVector> faces;
  std::vector<std::vector<RelationVector>> relations;  // [face][face]
};
[[nodiscard]] CadGeometry cad_geometry(const CadModel& model);

// A region may be a face when each attribute lies within these shares of the face's; two regions may be two faces when
// their largest distance does, too, and their normals meet at the angle of the faces' normals.
struct CadBounds {
  double lower = 0.0;                       // 0: hidden parts may take away anything. Limit: >= 0.
  double upper = 1.1;                       // Limit: > lower.
  double orientation = 0.1745329251994330;  // Unit: rad. Limit: >= 0.
};

// The field of all matches and supporting pairs within the bounds, without unary energies and likelihoods: every match
// is as good as every other. Faces that the compiler never found in any view take no part, as in the method itself.
// geometry: of each model of the database.
[[nodiscard]] HypothesisField cad_field(const PoolVector<DescribedRegion>& regions, const Database& database,
                                        const std::vector<const CadGeometry*>& geometry, const CadBounds& bounds);

}  // namespace foresight
