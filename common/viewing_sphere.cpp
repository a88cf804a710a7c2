#include "common/viewing_sphere.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "common/errors.h"

namespace foresight {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;  // corners
using Sides = std::array<Eigen::Vector3d, 3>;     // planes

// The regular icosahedron, outward counter-clockwise.
PoolVector<Triangle> icosahedron() {
  const double g = (1.0 + std::sqrt(5.0)) / 2.0;
  const std::array<Eigen::Vector3d, 12> v = {Eigen::Vector3d(-1, g, 0),
                                             {1, g, 0},
                                             {-1, -g, 0},
                                             {1, -g, 0},
                                             {0, -1, g},
                                             {0, 1, g},
                                             {0, -1, -g},
                                             {0, 1, -g},
                                             {g, 0, -1},
                                             {g, 0, 1},
                                             {-g, 0, -1},
                                             {-g, 0, 1}};
  constexpr int corners[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                  {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                  {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  PoolVector<Triangle> triangles;
  for (const auto& c : corners) {
    triangles.push_back({v[static_cast<std::size_t>(c[0])].normalized(), v[static_cast<std::size_t>(c[1])].normalized(),
                         v[static_cast<std::size_t>(c[2])].normalized()});
  }
  return triangles;
}

PoolVector<Triangle> subdivide(const PoolVector<Triangle>& coarse) {
  PoolVector<Triangle> fine;
  fine.reserve(coarse.size() * 4);
  for (const auto& [a, b, c] : coarse) {
    const Eigen::Vector3d ab = (a + b).normalized();
    const Eigen::Vector3d bc = (b + c).normalized();
    const Eigen::Vector3d ca = (c + a).normalized();
    fine.push_back({a, ab, ca});
    fine.push_back({ab, b, bc});
    fine.push_back({ca, bc, c});
    fine.push_back({ab, bc, ca});
  }
  return fine;
}

// How far inside the spherical triangle a direction lies: negative outside its nearest edge.
double inside(const Sides& sides, const Eigen::Vector3d& direction) {
  return std::min({sides[0].dot(direction), sides[1].dot(direction), sides[2].dot(direction)});
}

PoolVector<Sides> sides_of(const PoolVector<Triangle>& triangles) {
  PoolVector<Sides> sides;
  for (const Triangle& t : triangles) sides.push_back({t[0].cross(t[1]), t[1].cross(t[2]), t[2].cross(t[0])});
  return sides;
}

// The best of `count` triangles from `first` on; the lower index on a tie.
int most_inside(const PoolVector<Sides>& level, int first, int count, const Eigen::Vector3d& direction) {
  int best = first;
  double best_inside = -2.0;
  for (int i = first; i < first + count; ++i) {
    const double value = inside(level[static_cast<std::size_t>(i)], direction);
    if (value > best_inside + 1e-12) {
      best = i;
      best_inside = value;
    }
  }
  return best;
}

}  // namespace

ViewingSphere::ViewingSphere(int cells) {
  int size = 20;
  while (size < cells && size < 20480) size *= 4;
  if (size != cells) {
    throw UsageError("--views", std::to_string(cells) + " is not 20 * 4^k", "give 20, 80, 320, 1280, 5120 or 20480");
  }
  PoolVector<Triangle> triangles = icosahedron();
  levels_.push_back(sides_of(triangles));
  while (static_cast<int>(triangles.size()) < cells) {
    triangles = subdivide(triangles);
    levels_.push_back(sides_of(triangles));
  }
  for (const Triangle& t : triangles) centres_.push_back((t[0] + t[1] + t[2]).normalized());
}

int ViewingSphere::cell_of(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d unit = direction.normalized();
  int cell = most_inside(levels_.front(), 0, static_cast<int>(levels_.front().size()), unit);
  for (std::size_t level = 1; level < levels_.size(); ++level) cell = most_inside(levels_[level], 4 * cell, 4, unit);
  return cell;
}

}  // namespace foresight
