// The bodies of a mesh: its connected parts, oriented, measured and nested.
#pragma once

#include <optional>
#include <vector>

#include "compiler/triangle_mesh.h"

namespace foresight {

// The connected parts of a mesh, after its triangles were turned to agree across every edge.
struct Bodies {
  int count = 0;
  std::vector<int> of_triangle;
  int turned = 0;  // triangles that disagreed with the majority of their body
};

// Nothing when a body cannot be oriented (a Moebius strip). REQUIRES: every edge has exactly two uses.
[[nodiscard]] std::optional<Bodies> orient_bodies(TriangleMesh& mesh);

// Signed volume of each body: positive when its triangles face outward.
[[nodiscard]] std::vector<double> body_volumes(const TriangleMesh& mesh, const Bodies& bodies);

// How many other bodies enclose each body completely: an odd number makes it the wall of a void.
[[nodiscard]] std::vector<int> nesting_depths(const TriangleMesh& mesh, const Bodies& bodies);

// Turns all triangles of one body round.
void turn_body(TriangleMesh& mesh, const Bodies& bodies, int body);

}  // namespace foresight
