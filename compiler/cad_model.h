// CAD files as solids of planar faces. The only place that knows OpenMesh.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace foresight {

struct CadReadOptions {
  double unit_mm = 1.0;                 // length of one unit of the file. Unit: mm. Limit: > 0.
  double coplanar_angle = 0.0087266;    // triangles within this angle and distance of a face's plane belong to it. Unit: rad. DEFAULT: 0.5 degree.
  double coplanar_distance = 0.02;      // Unit: mm.
};

// A maximal connected set of coplanar triangles.
struct CadFace {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    // unit, outward
  double offset = 0.0;                                 // normal . p = offset. Unit: mm.
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // area-weighted. Unit: mm.
  double area = 0.0;                                   // Unit: mm^2.
  std::vector<int> triangles;                          // ascending
};

// A closed, consistently outward-oriented triangle mesh with its planar faces.
struct CadModel {
  std::string name;                                    // file stem
  std::vector<Eigen::Vector3d> vertices;               // model frame. Unit: mm.
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> triangle_face;                      // face of each triangle
  std::vector<CadFace> faces;                          // ordered by lowest triangle index
  std::vector<std::string> repairs;                    // what was repaired while reading, for the user to see

  [[nodiscard]] Eigen::Vector3d lowest() const;        // corners of the bounding box
  [[nodiscard]] Eigen::Vector3d highest() const;
  [[nodiscard]] double diameter() const;               // largest distance between two vertices
};

// OBJ, STL, PLY or OFF. Duplicate vertices are welded, degenerate triangles dropped, an inside-out solid turned: safe
// repairs, each listed in `repairs`. Vertices that shape nothing (compiler/flat_vertices.h) are taken out. Throws InputError that names the fault: missing, empty, unreadable, no triangles,
// open edges (how many, where the first is), non-manifold edges, inconsistent orientation that cannot be mended, zero volume.
[[nodiscard]] CadModel read_cad_model(const std::string& file, const CadReadOptions& options = {});

// Faces of a mesh by merging connected coplanar triangles; sets faces and triangle_face. Deterministic.
void find_planar_faces(CadModel& model, const CadReadOptions& options);

// Throws InputError that proposes the likely unit when the object's diameter is outside 2 % to 100 % of the field of view.
void check_size(const CadModel& model, const std::string& file, double unit_mm, double field_of_view);

}  // namespace foresight
