#include "benchmarks/fine_solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

namespace foresight {
namespace {

void add_square(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

// Number of the first of its vertices.
int add_ring(TriangleMesh& mesh, int corners, double radius, double z) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return first;
}

// Between two rings; counter-clockwise seen from outside where the second lies above the first.
void join_rings(TriangleMesh& mesh, int corners, int first, int second) {
  for (int i = 0; i < corners; ++i) {
    const int next = (i + 1) % corners;
    add_square(mesh, first + i, first + next, second + next, second + i);
  }
}

}  // namespace

TriangleMesh fine_box(int triangles) {
  constexpr std::array<double, 3> kSize = {120.0, 90.0, 60.0};
  const int steps = std::max(1, static_cast<int>(std::lround(std::sqrt(triangles / 12.0))));
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int> known;
  const auto vertex = [&](const std::array<int, 3>& place) {
    const auto [found, is_new] = known.try_emplace(place, static_cast<int>(mesh.vertices.size()));
    if (is_new) {
      mesh.vertices.emplace_back(kSize[0] * place[0] / steps, kSize[1] * place[1] / steps, kSize[2] * place[2] / steps);
    }
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, steps}) {
      const auto corner = [&](int u, int v) {
        std::array<int, 3> place{};
        place[axis] = side;
        place[(axis + 1) % 3] = u;
        place[(axis + 2) % 3] = v;
        return vertex(place);
      };
      for (int u = 0; u < steps; ++u) {
        for (int v = 0; v < steps; ++v) {
          std::array<int, 4> square = {corner(u, v), corner(u + 1, v), corner(u + 1, v + 1), corner(u, v + 1)};
          if (side == 0) std::swap(square[1], square[3]);
          add_square(mesh, square[0], square[1], square[2], square[3]);
        }
      }
    }
  }
  return mesh;
}

TriangleMesh fine_cylinder(int triangles) {
  constexpr double kRadius = 50.0;
  constexpr double kHeight = 80.0;
  const int corners = std::max(8, 2 * static_cast<int>(std::lround(std::sqrt(triangles / 8.0))));
  const int rows = std::max(1, triangles / (4 * corners));
  const int rings = std::max(1, triangles / (8 * corners));
  TriangleMesh mesh;
  const int bottom = add_ring(mesh, corners, kRadius, 0.0);
  int top = bottom;
  for (int row = 1; row <= rows; ++row) {
    const int above = add_ring(mesh, corners, kRadius, kHeight * row / rows);
    join_rings(mesh, corners, top, above);
    top = above;
  }
  for (const bool upper : {false, true}) {
    int outer = upper ? top : bottom;
    const double z = upper ? kHeight : 0.0;
    for (int ring = rings - 1; ring > 0; --ring) {
      const int inner = add_ring(mesh, corners, kRadius * ring / rings, z);
      upper ? join_rings(mesh, corners, outer, inner) : join_rings(mesh, corners, inner, outer);
      outer = inner;
    }
    const int middle = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(0.0, 0.0, z);
    for (int i = 0; i < corners; ++i) {
      const int a = outer + i;
      const int b = outer + (i + 1) % corners;
      mesh.triangles.push_back(upper ? Triangle{a, b, middle} : Triangle{b, a, middle});
    }
  }
  return mesh;
}

std::string off_text(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(9);
  text << "OFF\n" << mesh.vertices.size() << " " << mesh.triangles.size() << " 0\n";
  for (const Eigen::Vector3d& v : mesh.vertices) text << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const Triangle& t : mesh.triangles) text << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  return text.str();
}

}  // namespace foresight
