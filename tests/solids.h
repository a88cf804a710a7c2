// Small CAD models built in code, for tests: millimetres, outward, with their planar faces.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <iomanip>
#include <numbers>
#include <string>
#include <vector>

#include "common/pose.h"
#include "compiler/cad_model.h"
#include "compiler/triangle_mesh.h"

namespace foresight::test {

// A polygon of the x-y plane, counter-clockwise seen from +z, pulled up to the height. Faces: 0 bottom (normal -z),
// 1 top, then one for each side of the polygon in order (unless two sides lie in one line).
inline CadModel make_extrusion(const std::vector<Eigen::Vector2d>& polygon, double height) {
  CadModel model;
  model.name = "extrusion";
  const int n = static_cast<int>(polygon.size());
  std::vector<Eigen::Vector3d> bottom;
  for (const Eigen::Vector2d& p : polygon) bottom.emplace_back(p.x(), p.y(), 0.0);
  model.vertices = bottom;
  for (const Eigen::Vector3d& p : bottom) model.vertices.emplace_back(p.x(), p.y(), height);
  const std::vector<Triangle> cap = triangulate(bottom);
  for (const Triangle& t : cap) model.triangles.push_back({t[0], t[2], t[1]});
  for (const Triangle& t : cap) model.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    model.triangles.push_back({i, j, j + n});
    model.triangles.push_back({i, j + n, i + n});
  }
  find_planar_faces(model, {});
  return model;
}

// A box with one corner at the origin. Faces: bottom, top, front (-y), right (+x), back (+y), left (-x).
inline CadModel make_box(double x, double y, double z) {
  CadModel model = make_extrusion({{0, 0}, {x, 0}, {x, y}, {0, y}}, z);
  model.name = "box";
  return model;
}

// A step, 60 x 40 mm in outline and 30 mm high: 8 faces, no symmetry but one mirror plane. Faces 4 and 5 meet in the
// inner corner.
inline CadModel make_step() {
  CadModel model = make_extrusion({{0, 0}, {60, 0}, {60, 15}, {25, 15}, {25, 40}, {0, 40}}, 30.0);
  model.name = "step";
  return model;
}

// A block 60 x 50 x 40 mm with a slot 10 mm wide and 40 mm deep, open towards +y; its floor is face kSlotFloor (normal
// +y).
inline CadModel make_slotted_block() {
  CadModel model = make_extrusion({{0, 0}, {60, 0}, {60, 50}, {35, 50}, {35, 10}, {25, 10}, {25, 50}, {0, 50}}, 40.0);
  model.name = "slotted_block";
  return model;
}
inline constexpr int kSlotFloor = 6;

// A regular prism about the z axis: sides + 2 faces.
inline CadModel make_prism(int sides, double radius, double height) {
  std::vector<Eigen::Vector2d> polygon;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  CadModel model = make_extrusion(polygon, height);
  model.name = "prism";
  return model;
}

// The same solid elsewhere.
inline CadModel moved(CadModel model, const Pose& T_new_old) {
  for (Eigen::Vector3d& v : model.vertices) v = T_new_old * v;
  find_planar_faces(model, {});
  return model;
}

inline void write_obj(const std::string& file, const CadModel& model) {
  std::ofstream out(file);
  out << std::setprecision(9);
  for (const Eigen::Vector3d& v : model.vertices) out << "v " << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const Triangle& t : model.triangles) out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
}

// Every triangle with corners of its own, as STL has them.
inline void write_stl(const std::string& file, const CadModel& model) {
  std::ofstream out(file);
  out << std::setprecision(9) << "solid " << model.name << "\n";
  for (const Triangle& t : model.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const int corner : t) {
      const Eigen::Vector3d& v = model.vertices[static_cast<std::size_t>(corner)];
      out << "vertex " << v.x() << " " << v.y() << " " << v.z() << "\n";
    }
    out << "endloop\nendfacet\n";
  }
  out << "endsolid\n";
}

}  // namespace foresight::test
