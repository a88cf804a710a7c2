// Whether a mesh from a CAD file is the surface of a solid, and the repairs that are safe.
#pragma once

#include <string>
#include <vector>

#include "compiler/triangle_mesh.h"

namespace foresight {

// Welds, drops and turns what can be mended without changing the surface and returns, in words, what it did. Afterwards
// every edge has two triangles, which face outward, or into the void where a body is the wall of one.
// Throws InputError that names the fault of the file: flat, open or non-manifold edges (how many, where the first is),
// one-sided, without volume.
std::vector<std::string> check_solid(const std::string& file, TriangleMesh& mesh);

}  // namespace foresight
