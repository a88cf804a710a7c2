// Random solids of the size class of models/, to fill a database beyond the eight objects.
#pragma once

#include <cstdint>

#include "compiler/cad_model.h"

namespace foresight {

inline constexpr double kSmallestSolid = 80.0;      // diameter. Unit: mm.
inline constexpr double kLargestSolid = 250.0;      // diameter. Unit: mm.
inline constexpr double kSmallestSolidEdge = 12.0;  // between two faces. Unit: mm.

// Solid `index` of the series `seed`, named "solid_0007": closed, manifold, outward, every face planar. Half of them
// are frusta over star-shaped polygons of 4 to 9 corners, convex and not; half are staircases, height fields of boxes
// over 2 x 2 to 4 x 3 cells, every second one sheared. Symmetric ones may occur. Same seed and index, same solid.
// REQUIRES: index >= 0.
[[nodiscard]] CadModel random_solid(std::uint64_t seed, int index);

}  // namespace foresight
