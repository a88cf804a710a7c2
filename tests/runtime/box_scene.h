// A box as a compiled model, and range images of it by exact intersection of rays: for localization and verification.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "common/camera.h"
#include "common/compiled_model.h"
#include "common/pose.h"
#include "common/range_image.h"
#include "common/viewing_sphere.h"

namespace foresight::test {

inline const Eigen::Vector3i kBoxCells(12, 9, 7);            // the box, in template spacings
inline const Eigen::Vector3d kBoxCentre(40.0, -15.0, 25.0);  // away from the origin of the model's frame
inline constexpr double kBoxSpacing = 5.0;                   // mm

inline Eigen::Vector3d box_half_size() { return 0.5 * kBoxSpacing * kBoxCells.cast<double>(); }

// Face 2 * axis looks along -axis, face 2 * axis + 1 along +axis.
inline Eigen::Vector3d box_normal(int face) { return (face % 2 == 1 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(face / 2); }

// Corner i lies on the positive side of the axes whose bits are set in i.
inline std::vector<Eigen::Vector3f> box_corners() {
  std::vector<Eigen::Vector3f> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d side((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
    corners.emplace_back((kBoxCentre + side.cwiseProduct(box_half_size())).cast<float>());
  }
  return corners;
}

// Two for each face, in the order of the faces, counter-clockwise seen from outside.
inline std::vector<std::array<int, 3>> box_triangles() {
  std::vector<std::array<int, 3>> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << ((axis + 1) % 3);
    const int v = 1 << ((axis + 2) % 3);
    const int w = 1 << axis;
    triangles.insert(triangles.end(), {{0, u | v, u}, {0, v, u | v}});
    triangles.insert(triangles.end(), {{w, w | u, w | u | v}, {w, w | u | v, w | v}});
  }
  return triangles;
}

// Geometry only: no statistics.
inline ModelFace box_face(int f) {
  ModelFace face;
  face.normal = box_normal(f);
  face.centroid = kBoxCentre + box_normal(f).cwiseProduct(box_half_size());
  face.offset = face.normal.dot(face.centroid);
  face.area = 4.0 * box_half_size()[(f / 2 + 1) % 3] * box_half_size()[(f / 2 + 2) % 3];
  return face;
}

// Neighbours of the point at a place in the grid: those one spacing away along an axis.
inline std::vector<int> box_neighbours(const Eigen::Vector3i& at, const std::map<std::array<int, 3>, int>& index) {
  std::vector<int> neighbours;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      std::array<int, 3> place{at.x(), at.y(), at.z()};
      place[static_cast<std::size_t>(axis)] += step;
      const auto found = index.find(place);
      if (found != index.end()) neighbours.push_back(found->second);
    }
  }
  std::sort(neighbours.begin(), neighbours.end());
  return neighbours;
}

// The points of a grid of kBoxSpacing on the surface: points on edges and corners belong to two and three faces.
inline std::vector<TemplatePoint> box_points() {
  std::vector<TemplatePoint> points;
  std::map<std::array<int, 3>, int> index;
  for (int x = 0; x <= kBoxCells.x(); ++x) {
    for (int y = 0; y <= kBoxCells.y(); ++y) {
      for (int z = 0; z <= kBoxCells.z(); ++z) {
        const Eigen::Vector3i at(x, y, z);
        TemplatePoint point;
        for (int axis = 0; axis < 3; ++axis) {
          if (at[axis] == 0) point.faces.push_back(2 * axis);
          if (at[axis] == kBoxCells[axis]) point.faces.push_back(2 * axis + 1);
        }
        if (point.faces.empty()) continue;
        point.position = (kBoxCentre - box_half_size() + kBoxSpacing * at.cast<double>()).cast<float>();
        point.normal = box_normal(point.faces.front()).cast<float>();
        index[{x, y, z}] = static_cast<int>(points.size());
        points.push_back(point);
      }
    }
  }
  for (const auto& [place, i] : index) {
    points[static_cast<std::size_t>(i)].neighbours = box_neighbours({place[0], place[1], place[2]}, index);
  }
  return points;
}

// A face of a box is visible from a cell when it is seen at more than about 6 degrees from the cell's centre.
inline CompiledModel box_model() {
  CompiledModel model;
  model.name = "box";
  model.centre = kBoxCentre;
  model.diameter = 2.0 * box_half_size().norm();
  for (int f = 0; f < 6; ++f) model.faces.push_back(box_face(f));
  model.vertices = box_corners();
  model.triangles = box_triangles();
  model.triangle_faces = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5};
  model.surface.spacing = kBoxSpacing;
  model.surface.points = box_points();
  const ViewingSphere sphere(kAspectCells);
  for (int cell = 0; cell < kAspectCells; ++cell) {
    for (int face = 0; face < 6; ++face) {
      if (sphere.centre(cell).dot(box_normal(face)) > 0.1) {
        model.surface.aspects[static_cast<std::size_t>(cell)].push_back(face);
      }
    }
  }
  return model;
}

// The same box with all faces in every aspect: E is then one function of the pose.
inline CompiledModel box_model_of_one_aspect() {
  CompiledModel model = box_model();
  for (std::vector<int>& aspect : model.surface.aspects) aspect = {0, 1, 2, 3, 4, 5};
  return model;
}

// The box's centre at (0, 0, depth), with three faces well in sight.
inline Pose box_pose(double depth = 900.0) {
  Pose pose;
  pose.rotation = rotation_from_vector({0.65, 0.0, 0.0}) * rotation_from_vector({0.0, 0.7, 0.0}) *
                  rotation_from_vector({0.0, 0.0, 0.3});
  pose.translation = Eigen::Vector3d(0.0, 0.0, depth) - pose.rotation * kBoxCentre;
  return pose;
}

// The pose turned by v about the box's centre, then moved.
inline Pose moved(const Pose& pose, const Eigen::Vector3d& translation, const Eigen::Vector3d& v) {
  const Eigen::Vector3d centre = pose * kBoxCentre;
  const Eigen::Matrix3d rotation = rotation_from_vector(v) * pose.rotation;
  return {rotation, centre + translation - rotation * kBoxCentre};
}

// A plane z = depth over the columns first..last.
struct Screen {
  double depth = 0.0;
  int first_column = 0;
  int last_column = 1 << 20;
};

// Depth of the box along the camera's ray with z = 1, or infinity. Slab test in the box's frame.
inline double box_depth(const Pose& pose, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d from = pose.rotation.transpose() * -pose.translation - kBoxCentre;
  const Eigen::Vector3d along = pose.rotation.transpose() * ray;
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-box_half_size()[axis] - from[axis]) / along[axis];
    const double b = (box_half_size()[axis] - from[axis]) / along[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave ? enter : std::numeric_limits<double>::infinity();
}

inline RangeImage box_image(const Pose& pose, const PinholeCamera& camera, const std::vector<Screen>& screens = {}) {
  RangeImage image(camera.rows, camera.columns);
  for (int row = 0; row < camera.rows; ++row) {
    for (int column = 0; column < camera.columns; ++column) {
      const Eigen::Vector3d ray = camera.ray(row, column);
      double depth = box_depth(pose, ray);
      for (const Screen& screen : screens) {
        if (column >= screen.first_column && column <= screen.last_column) depth = std::min(depth, screen.depth);
      }
      if (std::isfinite(depth)) image[image.cell(row, column)] = (depth * ray).cast<float>();
    }
  }
  return image;
}

}  // namespace foresight::test
