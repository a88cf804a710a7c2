#include "benchmarks/cad_attributes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace foresight {
namespace {

using Eigen::Vector3d;

const CadFace& face_of(const CadModel& model, int face) { return model.faces[static_cast<std::size_t>(face)]; }

// All corners of the face's triangles.
std::vector<Vector3d> corners_of(const CadModel& model, int face) {
  std::set<int> indices;
  for (const int triangle : face_of(model, face).triangles) {
    for (const int corner : model.triangles[static_cast<std::size_t>(triangle)]) indices.insert(corner);
  }
  std::vector<Vector3d> corners;
  for (const int index : indices) corners.push_back(model.vertices[static_cast<std::size_t>(index)]);
  return corners;
}

double largest_distance(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double largest = 0.0;
  for (const Vector3d& p : a) {
    for (const Vector3d& q : b) largest = std::max(largest, (p - q).norm());
  }
  return largest;
}

// Length of the edges that only one of the face's triangles has, holes included.
double perimeter(const CadModel& model, int face) {
  std::map<std::pair<int, int>, int> uses;
  for (const int triangle : face_of(model, face).triangles) {
    const auto& corners = model.triangles[static_cast<std::size_t>(triangle)];
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax({corners[k], corners[(k + 1) % 3]})];
  }
  double length = 0.0;
  for (const auto& [edge, count] : uses) {
    if (count != 1) continue;
    length +=
        (model.vertices[static_cast<std::size_t>(edge.first)] - model.vertices[static_cast<std::size_t>(edge.second)])
            .norm();
  }
  return length;
}

}  // namespace

AttributeVector cad_attributes(const CadModel& model, int face) {
  const CadFace& cad = face_of(model, face);
  double area = 0.0;
  Vector3d moment = Vector3d::Zero();
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
  for (const int triangle : cad.triangles) {
    const auto& corners = model.triangles[static_cast<std::size_t>(triangle)];
    std::array<Vector3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = model.vertices[static_cast<std::size_t>(corners[k])] - cad.centroid;
    const double part = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
    const Vector3d sum = p[0] + p[1] + p[2];
    area += part;
    moment += part / 3.0 * sum;
    // The integral of x x^T over a triangle: area / 12 (sum of p p^T over its corners + (sum of p)(sum of p)^T).
    outer += part / 12.0 * (sum * sum.transpose());
    for (const Vector3d& corner : p) outer += part / 12.0 * (corner * corner.transpose());
  }
  const Vector3d mean = moment / area;
  const Eigen::Matrix3d covariance = outer / area - mean * mean.transpose();
  // The least of the three eigenvalues is that across the plane, 0.
  const Vector3d eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues();
  const std::vector<Vector3d> corners = corners_of(model, face);
  return {area, std::sqrt(std::max(0.0, eigenvalues[2])), std::sqrt(std::max(0.0, eigenvalues[1])),
          largest_distance(corners, corners)};
}

RelationVector cad_relations(const CadModel& model, int a, int b) {
  const Vector3d& n = face_of(model, a).normal;
  const Vector3d& m = face_of(model, b).normal;
  return {std::atan2(n.cross(m).norm(), n.dot(m)), largest_distance(corners_of(model, a), corners_of(model, b))};
}

AttributeVector cad_attribute_sigmas(const CadModel& model, int face, double cell) {
  return {0.5 * cell * perimeter(model, face), cell / std::sqrt(12.0), cell / std::sqrt(12.0), cell};
}

RelationVector cad_relation_sigmas(const CadModel& model, int a, int b, double cell, double depth_sigma) {
  double variance = 0.0;
  for (const int face : {a, b}) {
    const AttributeVector attributes = cad_attributes(model, face);
    const double cells = std::max(1.0, attributes[kArea] / (cell * cell));
    const double tilt = depth_sigma / (attributes[kMinSecondMoment] * std::sqrt(cells));
    variance += tilt * tilt;
  }
  return {std::sqrt(variance), cell};
}

}  // namespace foresight
