// Second-order attributes of two regions seen in one image (Section III). Simultaneous visibility is the existence of the pair.
#pragma once

#include <array>

#include "common/region_attributes.h"

namespace foresight {

enum Relation : int { kOrientation = 0, kMaxDistance = 1 };
inline constexpr int kRelationCount = 2;
inline constexpr std::array<const char*, kRelationCount> kRelationNames = {"relative_orientation", "max_distance"};
using RelationVector = std::array<double, kRelationCount>;  // rad in [0, pi], mm

// Angle between the normals, and the largest distance between a point of one patch and a point of the other. Symmetric.
[[nodiscard]] RelationVector relate(const DescribedRegion& a, const DescribedRegion& b);

}  // namespace foresight
