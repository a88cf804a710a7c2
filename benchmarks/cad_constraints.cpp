#include "benchmarks/cad_constraints.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

#include "common/relation_attributes.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::vector<Vector3d> corners_of(const CadModel& model, const CadFace& face) {
  std::set<int> used;
  for (const int t : face.triangles) used.insert(model.triangles[at(t)].begin(), model.triangles[at(t)].end());
  std::vector<Vector3d> corners;
  for (const int v : used) corners.push_back(model.vertices[at(v)]);
  return corners;
}

double largest_distance(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double largest = 0.0;
  for (const Vector3d& p : a) {
    for (const Vector3d& q : b) largest = std::max(largest, (p - q).norm());
  }
  return largest;
}

// Covariance of the area of the face about its centroid. A triangle has A/12 (sum of its corners' products + 9 times
// its centre's).
AttributeVector attributes_of(const CadModel& model, const CadFace& face, const std::vector<Vector3d>& corners) {
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  double area = 0.0;
  for (const int t : face.triangles) {
    std::array<Vector3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = model.vertices[at(model.triangles[at(t)][k])] - face.centroid;
    const double of_triangle = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
    const Vector3d sum = p[0] + p[1] + p[2];
    Eigen::Matrix3d products = sum * sum.transpose();
    for (const Vector3d& corner : p) products += corner * corner.transpose();
    moment += of_triangle / 12.0 * products;
    area += of_triangle;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment / area, Eigen::EigenvaluesOnly);
  const Vector3d values = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();  // ascending; the first is along the normal
  AttributeVector attributes{};
  attributes[kArea] = area;
  attributes[kMaxSecondMoment] = values[2];
  attributes[kMinSecondMoment] = values[1];
  attributes[kMaxDiameter] = largest_distance(corners, corners);
  return attributes;
}

bool within(double value, double of_face, const CadBounds& bounds) {
  return value >= bounds.lower * of_face && value <= bounds.upper * of_face;
}

bool may_be(const AttributeVector& region, const AttributeVector& face, const CadBounds& bounds) {
  for (std::size_t k = 0; k < region.size(); ++k) {
    if (!within(region[k], face[k], bounds)) return false;
  }
  return true;
}

bool may_be_pair(const RelationVector& relation, const CadGeometry& model, int a, int b, const CadBounds& bounds) {
  const double angle = std::acos(std::clamp(model.normals[at(a)].dot(model.normals[at(b)]), -1.0, 1.0));
  return std::abs(relation[kOrientation] - angle) <= bounds.orientation &&
         within(relation[kMaxDistance], model.distances[at(a)][at(b)], bounds);
}

void link(HypothesisField& field, const std::vector<int>& of_a, const std::vector<int>& of_b,
          const RelationVector& relation, const Database& database, const std::vector<const CadGeometry*>& geometry,
          const CadBounds& bounds) {
  const auto face_of = [&](int match) { return database.faces()[at(field.matches[at(match)].face)]; };
  std::size_t first = 0;  // of of_b with a model not below that of a: both lists ascend
  for (const int a : of_a) {
    const FaceIndex face_a = face_of(a);
    while (first < of_b.size() && face_of(of_b[first]).model < face_a.model) ++first;
    for (std::size_t i = first; i < of_b.size() && face_of(of_b[i]).model == face_a.model; ++i) {
      const FaceIndex face_b = face_of(of_b[i]);
      if (face_a.face == face_b.face) continue;
      if (!may_be_pair(relation, *geometry[at(face_a.model)], face_a.face, face_b.face, bounds)) continue;
      field.supports[at(a)].push_back(of_b[i]);
      field.supports[at(of_b[i])].push_back(a);
    }
  }
}

}  // namespace

CadGeometry cad_geometry(const CadModel& model) {
  CadGeometry geometry;
  std::vector<std::vector<Vector3d>> corners;
  for (const CadFace& face : model.faces) {
    corners.push_back(corners_of(model, face));
    geometry.faces.push_back(attributes_of(model, face, corners.back()));
    geometry.normals.push_back(face.normal);
  }
  for (const auto& a : corners) {
    std::vector<double>& row = geometry.distances.emplace_back();
    for (const auto& b : corners) row.push_back(largest_distance(a, b));
  }
  return geometry;
}

HypothesisField cad_field(const std::vector<DescribedRegion>& regions, const Database& database,
                          const std::vector<const CadGeometry*>& geometry, const CadBounds& bounds) {
  HypothesisField field;
  field.by_region.resize(regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (std::size_t f = 0; f < database.faces().size(); ++f) {
      const FaceIndex& face = database.faces()[f];
      if (!may_be(regions[r].attributes, geometry[at(face.model)]->faces[at(face.face)], bounds)) continue;
      field.by_region[r].push_back(static_cast<int>(field.matches.size()));
      field.matches.push_back({static_cast<int>(r), static_cast<int>(f), 0.0, 0.0});
    }
  }
  field.supports.resize(field.matches.size());
  field.unary.assign(field.matches.size(), {0.0, 0.0});
  for (std::size_t a = 0; a < regions.size(); ++a) {
    for (std::size_t b = a + 1; b < regions.size(); ++b) {
      link(field, field.by_region[a], field.by_region[b], relate(regions[a], regions[b]), database, geometry, bounds);
    }
  }
  return field;
}

}  // namespace foresight
