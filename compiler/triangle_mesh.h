// Triangle meshes as CAD files bring them: corners to share, rubbish to drop. Units are the file's own.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace foresight {

using Triangle = std::array<int, 3>;

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;  // counter-clockwise seen from outside
};

// One side of one triangle; low < high.
struct EdgeUse {
  int low = 0;
  int high = 0;
  int triangle = 0;
  bool forward = false;  // the triangle runs from low to high
};

// All sides of all triangles, ascending by (low, high, triangle): the uses of one edge stand together.
[[nodiscard]] std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles);

// Cuts a simple polygon, convex or not, into triangles of its corner numbers by clipping ears.
[[nodiscard]] std::vector<Triangle> triangulate(std::span<const Eigen::Vector3d> polygon);

// From a point to the triangle of three corners (Ericson, "Real-Time Collision Detection", 5.1.5).
[[nodiscard]] double distance_to_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                          const Eigen::Vector3d& c);

// Corners nearer than this are one corner: 1e-6 of the mesh's size, as far as single precision in files can be trusted.
[[nodiscard]] double weld_tolerance(const TriangleMesh& mesh);

// Each returns how many it took away.
int weld_vertices(TriangleMesh& mesh, double tolerance);
int drop_degenerate_triangles(TriangleMesh& mesh);  // two corners are one
// Triangles with the same three corners: the same way round, one stays; opposite ways round, they are a wall without
// thickness and both go, unless the whole mesh is listed from both sides: then one of each stays.
int drop_duplicate_triangles(TriangleMesh& mesh);
int drop_unused_vertices(TriangleMesh& mesh);

}  // namespace foresight
