// Vertices of a mesh that shape nothing: amid a planar face or along a straight edge.
#pragma once

#include "compiler/cad_model.h"

namespace foresight {

// Takes out vertices amid planar faces and along straight edges between two of them, and with each of them two
// triangles: a face that a CAD program has cut into thousands of triangles becomes a few. The surface stays closed and
// where it was, to the tolerance within which faces are planar; the other vertices stay in their order. Sets the faces
// anew. Returns how many vertices went. REQUIRES: a closed mesh with its planar faces. Deterministic.
int drop_flat_vertices(CadModel& model, const CadReadOptions& options);

}  // namespace foresight
