// Small solids built in code.
#pragma once

#include <array>
#include <vector>

#include "compiler/cad_model.h"

namespace foresight::test {

inline CadModel solid_of(std::vector<Eigen::Vector3d> vertices, std::vector<std::array<int, 3>> triangles) {
  CadModel model;
  model.name = "solid";
  model.vertices = std::move(vertices);
  model.triangles = std::move(triangles);
  find_planar_faces(model, {});
  return model;
}

// A cuboid about the origin.
inline CadModel cuboid(double x, double y, double z) {
  std::vector<Eigen::Vector3d> vertices;
  for (int i = 0; i < 8; ++i) vertices.emplace_back((i & 1 ? x : -x) / 2, (i & 2 ? y : -y) / 2, (i & 4 ? z : -z) / 2);
  return solid_of(vertices, {{0, 2, 3},
                             {0, 3, 1},
                             {4, 5, 7},
                             {4, 7, 6},
                             {0, 1, 5},
                             {0, 5, 4},
                             {2, 6, 7},
                             {2, 7, 3},
                             {0, 4, 6},
                             {0, 6, 2},
                             {1, 3, 7},
                             {1, 7, 5}});
}

}  // namespace foresight::test
