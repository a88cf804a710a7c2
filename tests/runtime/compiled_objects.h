// Castle and stick, compiled once for all tests of a process, and simulated scans of them.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/compiled_model.h"
#include "common/pose.h"
#include "compiler/cad_model.h"
#include "compiler/compile.h"
#include "compiler/scene_generator.h"
#include "compiler/sensor_file.h"
#include "runtime/database.h"
#include "runtime/foresight.h"
#include "tests/support.h"

namespace foresight::test {

inline const std::vector<CadModel>& castle_and_stick() {
  static const std::vector<CadModel> cads = {read_cad_model(project_file("models/castle.off")),
                                             read_cad_model(project_file("models/stick.off"))};
  return cads;
}

// A quarter of the usual views.
inline const Database& compiled_objects() {
  static const Database database = [] {
    CompileOptions options;
    options.samples.views = 80;
    options.acceptance.scenes = 12;
    CompiledDatabase content = new_database(paper_sensor(), options);
    for (const CadModel& cad : castle_and_stick()) {
      content.models.push_back(compile_model(cad, content.sensor, options));
      content.models.back().cad_file = cad.name + ".off";
      content.models.back().cad_sha256 = std::string(64, '0');
    }
    return Database(std::move(content));
  }();
  return database;
}

// A scene of castle and stick, one or both, with at least three faces of each in sight. Equal index: equal scene.
inline Scene visible_scene(int objects, std::uint64_t index) {
  SceneOptions options;
  options.fewest_objects = options.most_objects = objects;
  for (std::uint64_t attempt = 0;; ++attempt) {
    Scene scene = generate_scene(castle_and_stick(), paper_sensor(), options, 42 + attempt, index);
    const bool visible = std::all_of(scene.objects.begin(), scene.objects.end(), [](const SceneObject& object) {
      return object.visible_faces >= 3 && object.visible_fraction > 0.9;
    });
    if (visible) return scene;
  }
}

inline Pose pose_of(const Detection& detection) {
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(detection.T_sensor_model.data());
  return {matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
}

inline double distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

inline double distance_to_triangle(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const bool above = normal.dot((b - a).cross(p - a)) >= 0.0 && normal.dot((c - b).cross(p - b)) >= 0.0 &&
                     normal.dot((a - c).cross(p - c)) >= 0.0;
  if (above) return std::abs(normal.normalized().dot(p - a));
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

// The farthest that a template point at the reported pose lies from the surface at the true pose: small for every pose
// that looks the same, such as the four of the castle. Unit: mm.
inline double surface_distance(const CompiledModel& model, const Pose& reported, const Pose& truth) {
  const Pose T_model_reported = truth.inverse() * reported;
  double farthest = 0.0;
  for (const TemplatePoint& point : model.surface.points) {
    const Eigen::Vector3d p = T_model_reported * point.position.cast<double>();
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::array<int, 3>& triangle : model.triangles) {
      const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
        return model.vertices[static_cast<std::size_t>(triangle[k])].cast<double>();
      };
      nearest = std::min(nearest, distance_to_triangle(p, {corner(0), corner(1), corner(2)}));
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

}  // namespace foresight::test
