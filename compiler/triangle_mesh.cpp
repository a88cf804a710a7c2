#include "compiler/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace foresight {
namespace {

using Eigen::Vector3d;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// The triangle's corners, lowest first, and whether their cyclic order ascends.
std::pair<Triangle, bool> corner_set(const Triangle& triangle) {
  Triangle sorted = triangle;
  std::sort(sorted.begin(), sorted.end());
  const auto lowest = std::min_element(triangle.begin(), triangle.end()) - triangle.begin();
  return {sorted, triangle[static_cast<std::size_t>((lowest + 1) % 3)] == sorted[1]};
}

int keep_triangles(TriangleMesh& mesh, const std::vector<bool>& keep) {
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (keep[t]) kept.push_back(mesh.triangles[t]);
  }
  const int dropped = static_cast<int>(mesh.triangles.size() - kept.size());
  mesh.triangles = std::move(kept);
  return dropped;
}

// Twice the area of (a, b, c), positive when it turns left about the normal.
double turn(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& normal) {
  return normal.dot((b - a).cross(c - a));
}

bool is_ear(std::span<const Vector3d> polygon, const std::vector<int>& ring, std::size_t i, const Vector3d& normal) {
  const std::size_t before = (i + ring.size() - 1) % ring.size();
  const std::size_t after = (i + 1) % ring.size();
  const Vector3d& a = polygon[at(ring[before])];
  const Vector3d& b = polygon[at(ring[i])];
  const Vector3d& c = polygon[at(ring[after])];
  const double area = turn(a, b, c, normal);
  if (area <= 1e-12 * ((b - a).squaredNorm() + (c - b).squaredNorm())) return false;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vector3d& p = polygon[at(ring[k])];
    if (k == before || k == i || k == after || p == a || p == b || p == c) continue;
    const double slack = -1e-12 * area;
    if (turn(a, b, p, normal) >= slack && turn(b, c, p, normal) >= slack && turn(c, a, p, normal) >= slack)
      return false;
  }
  return true;
}

}  // namespace

double distance_to_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c) {
  const auto to_edge = [&p](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d along = to - from;
    const double length2 = along.squaredNorm();
    const double place = length2 > 0.0 ? std::clamp((p - from).dot(along) / length2, 0.0, 1.0) : 0.0;
    return (from + place * along - p).norm();
  };
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const bool above = (b - a).cross(p - a).dot(normal) >= 0.0 && (c - b).cross(p - b).dot(normal) >= 0.0 &&
                     (a - c).cross(p - c).dot(normal) >= 0.0;
  if (above && normal.squaredNorm() > 0.0) return std::abs((p - a).dot(normal)) / normal.norm();
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      uses.push_back({std::min(from, to), std::max(from, to), static_cast<int>(t), from < to});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle, a.forward) < std::tie(b.low, b.high, b.triangle, b.forward);
  });
  return uses;
}

std::vector<Triangle> triangulate(std::span<const Vector3d> polygon) {
  Vector3d normal = Vector3d::Zero();  // Newell's: exact for planar polygons, a fair mean for others
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    normal += (polygon[i] - polygon[0]).cross(polygon[(i + 1) % polygon.size()] - polygon[0]);
  }
  if (normal.norm() > 0.0) normal.normalize();
  std::vector<int> ring(polygon.size());
  std::iota(ring.begin(), ring.end(), 0);
  std::vector<Triangle> triangles;
  while (ring.size() >= 3) {
    std::size_t ear = 0;
    while (ear < ring.size() && !is_ear(polygon, ring, ear, normal)) ++ear;
    if (ear == ring.size()) ear = 1;  // only needles are left, or the polygon crosses itself: any cut keeps it closed
    triangles.push_back({ring[(ear + ring.size() - 1) % ring.size()], ring[ear], ring[(ear + 1) % ring.size()]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

double weld_tolerance(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  double largest = 0.0;
  for (const Vector3d& v : mesh.vertices) {
    box.extend(v);
    largest = std::max(largest, v.cwiseAbs().maxCoeff());
  }
  return box.isEmpty() ? 0.0 : 1e-6 * std::max(box.diagonal().norm(), largest);
}

int weld_vertices(TriangleMesh& mesh, double tolerance) {
  if (tolerance <= 0.0) return 0;
  Eigen::AlignedBox3d box;
  for (const Vector3d& v : mesh.vertices) box.extend(v);
  const auto key = [](const Eigen::Array<std::int64_t, 3, 1>& cell) {
    return (cell.x() << 42) ^ (cell.y() << 21) ^ cell.z();
  };
  std::unordered_map<std::int64_t, std::vector<int>> cells;  // only looked up, never walked through
  std::vector<int> stands_for(mesh.vertices.size());
  std::vector<Vector3d> kept;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d& v = mesh.vertices[i];
    const Eigen::Array<std::int64_t, 3, 1> cell =
        ((v - box.min()) / tolerance).array().floor().cast<std::int64_t>() + 1;
    int found = -1;
    for (int n = 0; n < 27 && found < 0; ++n) {
      const auto near = cells.find(key(cell + Eigen::Array<std::int64_t, 3, 1>(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (near == cells.end()) continue;
      for (const int k : near->second) {
        if ((kept[at(k)] - v).norm() <= tolerance && (found < 0 || k < found)) found = k;
      }
    }
    if (found < 0) {
      found = static_cast<int>(kept.size());
      kept.push_back(v);
      cells[key(cell)].push_back(found);
    }
    stands_for[i] = found;
  }
  for (Triangle& triangle : mesh.triangles) {
    for (int& corner : triangle) corner = stands_for[at(corner)];
  }
  const int welded = static_cast<int>(mesh.vertices.size() - kept.size());
  mesh.vertices = std::move(kept);
  return welded;
}

int drop_degenerate_triangles(TriangleMesh& mesh) {
  std::vector<bool> keep;
  for (const Triangle& t : mesh.triangles) keep.push_back(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
  return keep_triangles(mesh, keep);
}

int drop_duplicate_triangles(TriangleMesh& mesh) {
  struct Item {
    Triangle corners;
    bool ascending;
    std::size_t triangle;
  };
  std::vector<Item> items;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [corners, ascending] = corner_set(mesh.triangles[t]);
    items.push_back({corners, ascending, t});
  }
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return std::tie(a.corners, a.triangle) < std::tie(b.corners, b.triangle);
  });
  std::vector<bool> keep(mesh.triangles.size(), true);
  std::vector<std::size_t> walls;  // first triangle of each set that is there equally often both ways round
  std::size_t sets = 0;
  for (std::size_t i = 0, end = 0; i < items.size(); i = end, ++sets) {
    int ways = 0;
    for (end = i; end < items.size() && items[end].corners == items[i].corners; ++end) {
      ways += items[end].ascending ? 1 : -1;
      keep[items[end].triangle] = false;
    }
    if (ways == 0) {
      walls.push_back(items[i].triangle);
    } else {
      const auto first = std::find_if(items.begin() + static_cast<std::ptrdiff_t>(i), items.end(),
                                      [ways](const Item& item) { return item.ascending == (ways > 0); });
      keep[first->triangle] = true;
    }
  }
  if (walls.size() == sets) {
    for (const std::size_t triangle : walls) keep[triangle] = true;
  }
  return keep_triangles(mesh, keep);
}

int drop_unused_vertices(TriangleMesh& mesh) {
  std::vector<int> place(mesh.vertices.size(), -1);
  for (const Triangle& triangle : mesh.triangles) {
    for (const int corner : triangle) place[at(corner)] = 0;
  }
  std::vector<Vector3d> used;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] < 0) continue;
    place[i] = static_cast<int>(used.size());
    used.push_back(mesh.vertices[i]);
  }
  for (Triangle& triangle : mesh.triangles) {
    for (int& corner : triangle) corner = place[at(corner)];
  }
  const int dropped = static_cast<int>(mesh.vertices.size() - used.size());
  mesh.vertices = std::move(used);
  return dropped;
}

}  // namespace foresight
