#include "compiler/mesh_bodies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace foresight {
namespace {

using Eigen::Vector3d;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Solid angle of a triangle seen from a point, signed (van Oosterom and Strackee, "The Solid Angle of a Plane
// Triangle", IEEE Trans. Biomedical Engineering 30(2), 1983).
double solid_angle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * std::atan2(a.dot(b.cross(c)), denominator);
}

struct BodyParts {
  std::vector<int> triangles;
  std::vector<int> vertices;  // ascending
  Eigen::AlignedBox3d box;
};

std::vector<BodyParts> parts_of(const TriangleMesh& mesh, const Bodies& bodies) {
  std::vector<BodyParts> parts(at(bodies.count));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    BodyParts& part = parts[at(bodies.of_triangle[t])];
    part.triangles.push_back(static_cast<int>(t));
    part.vertices.insert(part.vertices.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  }
  for (BodyParts& part : parts) {
    std::sort(part.vertices.begin(), part.vertices.end());
    part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
    for (const int v : part.vertices) part.box.extend(mesh.vertices[at(v)]);
  }
  return parts;
}

// True when the whole inner body lies inside the outer one. Points on the outer surface see less than the full sphere,
// so a pin that fills a hole is not taken for a void. At most some 200 corners are asked: bodies that cross are rare.
bool encloses(const TriangleMesh& mesh, const BodyParts& outer, const BodyParts& inner) {
  if (!outer.box.contains(inner.box)) return false;
  const std::size_t step = 1 + inner.vertices.size() / 200;
  for (std::size_t i = 0; i < inner.vertices.size(); i += step) {
    const Vector3d& p = mesh.vertices[at(inner.vertices[i])];
    double seen = 0.0;
    for (const int t : outer.triangles) {
      const Triangle& corners = mesh.triangles[at(t)];
      seen += solid_angle(mesh.vertices[at(corners[0])] - p, mesh.vertices[at(corners[1])] - p,
                          mesh.vertices[at(corners[2])] - p);
    }
    if (std::abs(seen) < 0.9 * 4.0 * std::numbers::pi) return false;
  }
  return true;
}

}  // namespace

std::optional<Bodies> orient_bodies(TriangleMesh& mesh) {
  struct Neighbour {
    int triangle;
    bool agrees;  // both run along the edge in opposite directions
  };
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangles.size());
  const std::vector<EdgeUse> uses = edge_uses(mesh.triangles);
  for (std::size_t i = 0; i + 1 < uses.size(); i += 2) {
    const EdgeUse &a = uses[i], &b = uses[i + 1];
    neighbours[at(a.triangle)].push_back({b.triangle, a.forward != b.forward});
    neighbours[at(b.triangle)].push_back({a.triangle, a.forward != b.forward});
  }
  Bodies bodies;
  bodies.of_triangle.assign(mesh.triangles.size(), -1);
  std::vector<bool> turned(mesh.triangles.size(), false);
  for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (bodies.of_triangle[seed] >= 0) continue;
    std::vector<int> members{static_cast<int>(seed)};
    bodies.of_triangle[seed] = bodies.count;
    int flips = 0;
    for (std::size_t next = 0; next < members.size(); ++next) {
      const int t = members[next];
      for (const auto& [other, agrees] : neighbours[at(t)]) {
        const bool turn_other = turned[at(t)] == agrees;  // as its neighbour when they agree
        if (bodies.of_triangle[at(other)] < 0) {
          bodies.of_triangle[at(other)] = bodies.count;
          turned[at(other)] = turn_other;
          flips += turn_other ? 1 : 0;
          members.push_back(other);
        } else if (turned[at(other)] != turn_other) {
          return std::nullopt;
        }
      }
    }
    const int size = static_cast<int>(members.size());
    const bool majority_turned = 2 * flips > size;
    bodies.turned += majority_turned ? size - flips : flips;
    for (const int t : members) {
      if (turned[at(t)] != majority_turned) std::swap(mesh.triangles[at(t)][1], mesh.triangles[at(t)][2]);
    }
    ++bodies.count;
  }
  return bodies;
}

std::vector<double> body_volumes(const TriangleMesh& mesh, const Bodies& bodies) {
  std::vector<double> volumes(at(bodies.count), 0.0);
  const Vector3d origin = mesh.vertices.empty() ? Vector3d(Vector3d::Zero()) : mesh.vertices.front();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const Vector3d a = mesh.vertices[at(c[0])] - origin;
    const Vector3d b = mesh.vertices[at(c[1])] - origin;
    volumes[at(bodies.of_triangle[t])] += a.dot(b.cross(mesh.vertices[at(c[2])] - origin)) / 6.0;
  }
  return volumes;
}

std::vector<int> nesting_depths(const TriangleMesh& mesh, const Bodies& bodies) {
  std::vector<int> depths(at(bodies.count), 0);
  if (bodies.count < 2) return depths;
  const std::vector<BodyParts> parts = parts_of(mesh, bodies);
  for (std::size_t inner = 0; inner < parts.size(); ++inner) {
    for (std::size_t outer = 0; outer < parts.size(); ++outer) {
      if (inner != outer && encloses(mesh, parts[outer], parts[inner])) ++depths[inner];
    }
  }
  return depths;
}

void turn_body(TriangleMesh& mesh, const Bodies& bodies, int body) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (bodies.of_triangle[t] == body) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
}

}  // namespace foresight
