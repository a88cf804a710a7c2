// Small solids built in code, faces and all, for tests that need a CadModel but no CAD file.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "compiler/cad_model.h"

namespace foresight::test {

// Appends one planar face; triangles counter-clockwise seen from outside.
inline void add_face(CadModel& model, const std::vector<std::array<int, 3>>& triangles) {
  CadFace face;
  for (const auto& triangle : triangles) {
    const auto corner = [&](std::size_t k) { return model.vertices[static_cast<std::size_t>(triangle[k])]; };
    const Eigen::Vector3d doubled = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    face.normal = doubled.normalized();
    face.offset = face.normal.dot(corner(0));
    face.centroid += 0.5 * doubled.norm() * (corner(0) + corner(1) + corner(2)) / 3.0;
    face.area += 0.5 * doubled.norm();
    face.triangles.push_back(static_cast<int>(model.triangles.size()));
    model.triangles.push_back(triangle);
    model.triangle_face.push_back(static_cast<int>(model.faces.size()));
  }
  face.centroid /= face.area;
  model.faces.push_back(face);
}

// An outline in x, y (counter-clockwise seen from +z) extruded from z = 0 to `height`; `cap` triangulates the outline.
// Faces: bottom, top, then the sides in the outline's order.
inline CadModel prism(const std::string& name, const std::vector<Eigen::Vector2d>& outline,
                      const std::vector<std::array<int, 3>>& cap, double height) {
  CadModel model;
  model.name = name;
  const int n = static_cast<int>(outline.size());
  for (const double z : {0.0, height}) {
    for (const Eigen::Vector2d& point : outline) model.vertices.emplace_back(point.x(), point.y(), z);
  }
  std::vector<std::array<int, 3>> bottom;
  std::vector<std::array<int, 3>> top;
  for (const auto& [a, b, c] : cap) {
    bottom.push_back({a, c, b});
    top.push_back({a + n, b + n, c + n});
  }
  add_face(model, bottom);
  add_face(model, top);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    add_face(model, {{i, j, j + n}, {i, j + n, i + n}});
  }
  return model;
}

// A box with one corner at the origin.
inline CadModel box(double x, double y, double z) {
  return prism("box", {{0, 0}, {x, 0}, {x, y}, {0, y}}, {{0, 1, 2}, {0, 2, 3}}, z);
}

// A block with a quarter cut away: not convex.
inline CadModel angle_block() {
  return prism("angle_block", {{0, 0}, {80, 0}, {80, 30}, {30, 30}, {30, 80}, {0, 80}},
               {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, 40);
}

inline CadModel wedge() { return prism("wedge", {{0, 0}, {70, 0}, {0, 50}}, {{0, 1, 2}}, 60); }

}  // namespace foresight::test
