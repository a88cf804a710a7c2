// The planar faces of a mesh: connected triangles in one plane.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "compiler/cad_model.h"
#include "compiler/triangle_mesh.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

struct TriangleShape {
  Vector3d area_vector = Vector3d::Zero();  // along the normal, as long as the area
  double area = 0.0;
  bool needle = false;  // so flat that its normal means nothing; it joins the face it lies in
};

std::vector<TriangleShape> triangle_shapes(const CadModel& model, const CadReadOptions& options) {
  // CAD files are trusted to 1e-6 of the object's size: a triangle lower than this could lean by more than the angle.
  const double trusted = 1e-6 * model.diameter();
  const double lowest = std::min(trusted / options.coplanar_angle, options.coplanar_distance);
  std::vector<TriangleShape> shapes;
  for (const Triangle& t : model.triangles) {
    const Vector3d &a = model.vertices[at(t[0])], &b = model.vertices[at(t[1])], &c = model.vertices[at(t[2])];
    TriangleShape shape;
    shape.area_vector = 0.5 * (b - a).cross(c - a);
    shape.area = shape.area_vector.norm();
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    shape.needle = 2.0 * shape.area <= lowest * longest;
    shapes.push_back(shape);
  }
  return shapes;
}

// The triangles across the edges of each triangle.
std::vector<std::vector<int>> triangle_neighbours(const CadModel& model) {
  std::vector<std::vector<int>> neighbours(model.triangles.size());
  const std::vector<EdgeUse> uses = edge_uses(model.triangles);
  for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
    const EdgeUse &a = uses[i], &b = uses[i + 1];
    if (a.low != b.low || a.high != b.high) continue;
    neighbours[at(a.triangle)].push_back(b.triangle);
    neighbours[at(b.triangle)].push_back(a.triangle);
  }
  return neighbours;
}

// Largest triangles first: their planes are the surest. Needles last. File order decides between equals.
std::vector<int> seeds_in_order(const std::vector<TriangleShape>& shapes) {
  std::vector<int> order(shapes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&shapes](int a, int b) {
    if (shapes[at(a)].needle != shapes[at(b)].needle) return shapes[at(b)].needle;
    return shapes[at(a)].area > shapes[at(b)].area;
  });
  return order;
}

// Every triangle is compared with the seed's plane, never with its neighbour: a finely cut cylinder does not creep into
// one face.
std::vector<int> grow_face(const CadModel& model, const CadReadOptions& options,
                           const std::vector<TriangleShape>& shapes, const std::vector<std::vector<int>>& neighbours,
                           int seed, std::vector<int>& face_of, int face) {
  const Vector3d normal = shapes[at(seed)].area_vector.normalized();
  const double offset = normal.dot(model.vertices[at(model.triangles[at(seed)][0])]);
  const double least_cosine = std::cos(options.coplanar_angle);
  const auto belongs = [&](int t) {
    const TriangleShape& shape = shapes[at(t)];
    if (!shape.needle && normal.dot(shape.area_vector) < least_cosine * shape.area) return false;
    return std::all_of(model.triangles[at(t)].begin(), model.triangles[at(t)].end(), [&](int corner) {
      return std::abs(normal.dot(model.vertices[at(corner)]) - offset) <= options.coplanar_distance;
    });
  };
  std::vector<int> members{seed};
  face_of[at(seed)] = face;
  for (std::size_t next = 0; next < members.size(); ++next) {
    for (const int t : neighbours[at(members[next])]) {
      if (face_of[at(t)] >= 0 || !belongs(t)) continue;
      face_of[at(t)] = face;
      members.push_back(t);
    }
  }
  std::sort(members.begin(), members.end());
  return members;
}

CadFace measure_face(const CadModel& model, const std::vector<TriangleShape>& shapes, std::vector<int> triangles) {
  CadFace face;
  Vector3d area_vector = Vector3d::Zero();
  const Vector3d origin = model.vertices[at(model.triangles[at(triangles.front())][0])];  // keeps the sums small
  for (const int t : triangles) {
    const Triangle& corners = model.triangles[at(t)];
    const Vector3d sum =
        model.vertices[at(corners[0])] + model.vertices[at(corners[1])] + model.vertices[at(corners[2])];
    face.area += shapes[at(t)].area;
    face.centroid += shapes[at(t)].area * (sum / 3.0 - origin);
    area_vector += shapes[at(t)].area_vector;
  }
  face.centroid = face.area > 0.0 ? Vector3d(origin + face.centroid / face.area) : origin;
  face.normal = area_vector.norm() > 0.0 ? Vector3d(area_vector.normalized()) : Vector3d::UnitZ();
  face.offset = face.normal.dot(face.centroid);
  face.triangles = std::move(triangles);
  return face;
}

}  // namespace

void find_planar_faces(CadModel& model, const CadReadOptions& options) {
  const std::vector<TriangleShape> shapes = triangle_shapes(model, options);
  const std::vector<std::vector<int>> neighbours = triangle_neighbours(model);
  std::vector<int> face_of(model.triangles.size(), -1);
  std::vector<std::vector<int>> members;
  for (const int seed : seeds_in_order(shapes)) {
    if (face_of[at(seed)] >= 0) continue;
    members.push_back(grow_face(model, options, shapes, neighbours, seed, face_of, static_cast<int>(members.size())));
  }
  std::sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.front() < b.front(); });
  model.faces.clear();
  model.triangle_face.assign(model.triangles.size(), -1);
  for (std::vector<int>& triangles : members) {
    for (const int t : triangles) model.triangle_face[at(t)] = static_cast<int>(model.faces.size());
    model.faces.push_back(measure_face(model, shapes, std::move(triangles)));
  }
}

}  // namespace foresight
