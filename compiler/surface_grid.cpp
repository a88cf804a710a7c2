#include "compiler/surface_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/triangle_mesh.h"

namespace foresight {
namespace {

constexpr int kMostCubes = 64;  // along an edge of the bounding box

}  // namespace

SurfaceGrid::SurfaceGrid(const CadModel& model, double reach) : reach_(reach) {
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const auto corner = [&](std::size_t k) { return model.vertices[static_cast<std::size_t>(model.triangles[t][k])]; };
    const CadFace& face = model.faces[static_cast<std::size_t>(model.triangle_face[t])];
    const Eigen::Vector3d across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    const double doubled = across.norm();
    const Eigen::Vector3d unit = doubled > 0.0 ? Eigen::Vector3d(across / doubled) : Eigen::Vector3d::Zero();
    facets_.push_back({{corner(0), corner(1), corner(2)}, face.normal, unit});
  }
  lowest_ = model.lowest().array() - reach;
  const Eigen::Array3d size = (model.highest() - model.lowest()).array() + 2.0 * reach;
  side_ = std::max(reach, size.maxCoeff() / kMostCubes);
  counts_ = (size / side_).ceil().cast<int>().max(1);
  cubes_.resize(static_cast<std::size_t>(counts_.prod()));
  for (int f = 0; f < static_cast<int>(facets_.size()); ++f) enter(f);
}

double SurfaceGrid::distance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double least_cosine) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Eigen::Array3i cube = cube_of(point);
  if ((cube < 0).any() || (cube >= counts_).any()) return kNone;
  double nearest = kNone;
  for (const int f : cubes_[index(cube.x(), cube.y(), cube.z())]) {
    const Facet& facet = facets_[static_cast<std::size_t>(f)];
    if (facet.normal.dot(normal) < least_cosine) continue;
    const double to_plane = std::abs(facet.across.dot(point - facet.corners[0]));
    if (to_plane >= nearest || to_plane > reach_) continue;
    nearest = std::min(nearest, distance_to_triangle(point, facet.corners[0], facet.corners[1], facet.corners[2]));
  }
  return nearest <= reach_ ? nearest : kNone;
}

// Into the cubes whose middle is near enough that some point of them may be within the reach.
void SurfaceGrid::enter(int f) {
  const auto& [a, b, c] = facets_[static_cast<std::size_t>(f)].corners;
  const Eigen::Vector3d lowest = a.cwiseMin(b).cwiseMin(c).array() - reach_;
  const Eigen::Vector3d highest = a.cwiseMax(b).cwiseMax(c).array() + reach_;
  const Eigen::Array3i from = cube_of(lowest).max(0);
  const Eigen::Array3i to = cube_of(highest).min(counts_ - 1);
  const double near = reach_ + 0.5 * std::sqrt(3.0) * side_;
  for (int x = from.x(); x <= to.x(); ++x) {
    for (int y = from.y(); y <= to.y(); ++y) {
      for (int z = from.z(); z <= to.z(); ++z) {
        const Eigen::Vector3d middle = lowest_ + side_ * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
        if (distance_to_triangle(middle, a, b, c) <= near) cubes_[index(x, y, z)].push_back(f);
      }
    }
  }
}

Eigen::Array3i SurfaceGrid::cube_of(const Eigen::Vector3d& point) const {
  return ((point - lowest_) / side_).array().floor().cast<int>();
}

std::size_t SurfaceGrid::index(int x, int y, int z) const {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(counts_.y()) + static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(counts_.x()) +
         static_cast<std::size_t>(x);
}

}  // namespace foresight
