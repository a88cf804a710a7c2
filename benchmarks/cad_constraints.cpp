#include "benchmarks/cad_constraints.h"

#include <cmath>

#include "benchmarks/cad_attributes.h"

namespace foresight {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

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
  const RelationVector& of_faces = model.relations[at(a)][at(b)];
  return std::abs(relation[kOrientation] - of_faces[kOrientation]) <= bounds.orientation &&
         within(relation[kMaxDistance], of_faces[kMaxDistance], bounds);
}

void link(HypothesisField& field, const PoolVector<int>& of_a, const PoolVector<int>& of_b,
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
  const int faces = static_cast<int>(model.faces.size());
  for (int a = 0; a < faces; ++a) {
    geometry.faces.push_back(cad_attributes(model, a));
    std::vector<RelationVector>& row = geometry.relations.emplace_back();
    for (int b = 0; b < faces; ++b) row.push_back(cad_relations(model, a, b));
  }
  return geometry;
}

HypothesisField cad_field(const PoolVector<DescribedRegion>& regions, const Database& database,
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
