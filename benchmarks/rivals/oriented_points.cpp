#include "benchmarks/rivals/oriented_points.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "common/random.h"

namespace foresight {
namespace {

constexpr double kDensity = 16.0;        // random points per square of the spacing before thinning out
constexpr float kSmallestFacing = 0.2F;  // cosine of normal and line of sight; flatter is hardly measured

using Cube = std::array<int, 4>;  // three of the grid, one of the normal

Cube cube_of(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, double side) {
  Cube cube{};
  for (int axis = 0; axis < 3; ++axis) {
    cube[static_cast<std::size_t>(axis)] = static_cast<int>(std::floor(static_cast<double>(point[axis]) / side));
  }
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  cube[3] = 2 * axis + (normal[axis] < 0.0F ? 1 : 0);
  return cube;
}

}  // namespace

void OrientedPoints::add(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  points.push_back(point);
  normals.push_back(normal);
}

OrientedPoints OrientedPoints::at(const std::vector<std::size_t>& indices) const {
  OrientedPoints chosen;
  for (const std::size_t i : indices) chosen.add(points[i], normals[i]);
  return chosen;
}

OrientedPoints thin_out(const OrientedPoints& points, double side) {
  std::map<Cube, std::vector<std::size_t>> cubes;
  for (std::size_t i = 0; i < points.size(); ++i) {
    cubes[cube_of(points.points[i], points.normals[i], side)].push_back(i);
  }
  OrientedPoints thinned;
  for (const auto& [cube, members] : cubes) {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const std::size_t i : members) mean += points.points[i];
    mean /= static_cast<float>(members.size());
    std::size_t nearest = members.front();
    for (const std::size_t i : members) {
      if ((points.points[i] - mean).squaredNorm() < (points.points[nearest] - mean).squaredNorm()) nearest = i;
    }
    thinned.add(points.points[nearest], points.normals[nearest]);
  }
  return thinned;
}

OrientedPoints sample_surface(const CadModel& model, double spacing, std::uint64_t seed) {
  OrientedPoints samples;
  Random random(seed);
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const auto corner = [&](std::size_t k) { return model.vertices[static_cast<std::size_t>(model.triangles[t][k])]; };
    const Eigen::Vector3d a = corner(0);
    const Eigen::Vector3d ab = corner(1) - a;
    const Eigen::Vector3d ac = corner(2) - a;
    const double wanted = 0.5 * ab.cross(ac).norm() * kDensity / (spacing * spacing);
    const auto count = static_cast<int>(std::floor(wanted + random.uniform()));
    const Eigen::Vector3f normal =
        model.faces[static_cast<std::size_t>(model.triangle_face[t])].normal.normalized().cast<float>();
    for (int i = 0; i < count; ++i) {
      double u = random.uniform();
      double v = random.uniform();
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      samples.add((a + u * ab + v * ac).cast<float>(), normal);
    }
  }
  return thin_out(samples, spacing);
}

OrientedPoints facing_points(const OrientedPoints& model, const Pose& T_sensor_model) {
  const Eigen::Vector3f sensor = T_sensor_model.inverse().translation.cast<float>();
  OrientedPoints facing;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Eigen::Vector3f sight = (sensor - model.points[i]).normalized();
    if (model.normals[i].dot(sight) > kSmallestFacing) facing.add(model.points[i], model.normals[i]);
  }
  return facing;
}

}  // namespace foresight
