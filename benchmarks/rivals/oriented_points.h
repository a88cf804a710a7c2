// Points with normals: what the rivals take models and scenes as.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/pose.h"
#include "compiler/cad_model.h"

namespace foresight {

struct OrientedPoints {
  std::vector<Eigen::Vector3f> points;   // Unit: mm.
  std::vector<Eigen::Vector3f> normals;  // unit; as many

  [[nodiscard]] std::size_t size() const { return points.size(); }
  [[nodiscard]] OrientedPoints at(const std::vector<std::size_t>& indices) const;
  void add(const Eigen::Vector3f& point, const Eigen::Vector3f& normal);
};

// One point of each cube of the grid with this side and each of the six main directions of normals: the one nearest to
// the mean of the cube's points. Points are picked, not averaged: a mean across an edge lies on neither face.
[[nodiscard]] OrientedPoints thin_out(const OrientedPoints& points, double side);

// Points all over the surface, outward normals; uniform by area, then thinned out. Same seed, same points.
[[nodiscard]] OrientedPoints sample_surface(const CadModel& model, double spacing, std::uint64_t seed);

// Those that face the sensor when the model is at this pose, in the model frame.
[[nodiscard]] OrientedPoints facing_points(const OrientedPoints& model, const Pose& T_sensor_model);

}  // namespace foresight
