#include "common/relation_attributes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace foresight {

RelationVector relate(const DescribedRegion& a, const DescribedRegion& b) {
  const Eigen::Vector3d& n = a.region.normal;
  const Eigen::Vector3d& m = b.region.normal;
  // The farthest points of two patches are corners of their hulls.
  double farthest = 0.0;
  for (const Eigen::Vector3d& p : a.hull) {
    for (const Eigen::Vector3d& q : b.hull) farthest = std::max(farthest, (p - q).squaredNorm());
  }
  return {std::atan2(n.cross(m).norm(), n.dot(m)), std::sqrt(farthest)};
}

}  // namespace foresight
