// Solids that are cut into any number of triangles, as CAD programs export them: what size costs the compiler.
#pragma once

#include <string>

#include "compiler/triangle_mesh.h"

namespace foresight {

// A box of 120 x 90 x 60 mm, each of its six faces a grid of squares cut in two: about so many triangles, all of them
// in planar faces.
[[nodiscard]] TriangleMesh fine_box(int triangles);

// A cylinder of 50 mm radius, 80 mm high, the axis along z: half the triangles in the round side, half in rings of the
// two ends.
[[nodiscard]] TriangleMesh fine_cylinder(int triangles);

// As OFF.
[[nodiscard]] std::string off_text(const TriangleMesh& mesh);

}  // namespace foresight
