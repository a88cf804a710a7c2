// A box and regions of it, as far as matching by CAD geometry looks at them.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/region_attributes.h"
#include "compiler/cad_model.h"
#include "runtime/database.h"

namespace foresight::test {

// `copies` models of the faces of one solid, without statistics.
inline Database database_of_copies(const CadModel& solid, int copies) {
  CompiledDatabase content;
  for (int i = 0; i < copies; ++i) {
    CompiledModel& model = content.models.emplace_back();
    model.name = solid.name + std::to_string(i);
    for (const CadFace& face : solid.faces) {
      ModelFace& compiled = model.faces.emplace_back();
      compiled.normal = face.normal;
      compiled.views_found = 1;
      for (Density& density : compiled.densities) density = {0.0, 1.0, 0, {1.0F}};
    }
  }
  return Database(content);
}

// A region that shows a rectangle in full.
inline DescribedRegion rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  DescribedRegion region;
  region.region.normal = u.cross(v).normalized();
  region.hull = {corner, corner + u, corner + u + v, corner + v};
  region.attributes[kArea] = u.norm() * v.norm();
  region.attributes[kMaxSecondMoment] = std::max(u.norm(), v.norm()) / std::sqrt(12.0);
  region.attributes[kMinSecondMoment] = std::min(u.norm(), v.norm()) / std::sqrt(12.0);
  region.attributes[kMaxDiameter] = std::hypot(u.norm(), v.norm());
  return region;
}

}  // namespace foresight::test
