// Convex solids with statistics learned from drawn views: databases for tests of matching and of start poses, without
// the compiler.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/random.h"
#include "common/region_attributes.h"
#include "common/relation_attributes.h"
#include "common/viewing_sphere.h"
#include "runtime/database.h"
#include "runtime/pose_evidence.h"
#include "runtime/rendering.h"
#include "tests/runtime/box_scene.h"

namespace foresight::test {

struct PlacedModel {
  const CompiledModel* model;
  Pose T_sensor_model;
};

// What a sensor without noise sees of them.
inline RangeImage image_of(const std::vector<PlacedModel>& objects, const PinholeCamera& camera = {}) {
  RangeImage image(camera.rows, camera.columns);
  for (const PlacedModel& object : objects) {
    const Rendering drawn = render(*object.model, object.T_sensor_model, camera);
    for (int row = 0; row < drawn.rows; ++row) {
      for (int column = 0; column < drawn.columns; ++column) {
        const double depth = drawn.depth[static_cast<std::size_t>(drawn.cell(row, column))];
        if (!(depth > 0.0)) continue;
        const int cell = image.cell(row + drawn.first_row, column + drawn.first_column);
        if (image.valid(cell) && image[cell].z() < static_cast<float>(depth)) continue;
        image[cell] = (depth * camera.ray(row + drawn.first_row, column + drawn.first_column)).cast<float>();
      }
    }
  }
  return image;
}

// Template points of one face: a grid over each of its triangles, corners left out.
inline void add_template_points(CompiledModel& model, std::size_t triangle) {
  const auto corner = [&](std::size_t k) {
    return model.vertices[static_cast<std::size_t>(model.triangles[triangle][k])];
  };
  const Eigen::Vector3f u = corner(1) - corner(0);
  const Eigen::Vector3f v = corner(2) - corner(0);
  const int face = model.triangle_faces[triangle];
  const int steps = std::max(2, static_cast<int>(std::max(u.norm(), v.norm()) / 4.0F));
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; i + j < steps; ++j) {
      const auto at = [&](int n) { return (static_cast<float>(n) + 0.33F) / static_cast<float>(steps); };
      TemplatePoint point;
      point.position = corner(0) + at(i) * u + at(j) * v;
      point.normal = model.faces[static_cast<std::size_t>(face)].normal.cast<float>();
      point.faces = {face};
      model.surface.points.push_back(point);
    }
  }
}

// From the corners of its faces, counter-clockwise seen from outside. No statistics yet.
inline CompiledModel convex_solid(const std::string& name, const std::vector<Eigen::Vector3d>& vertices,
                                  const std::vector<std::vector<int>>& faces) {
  CompiledModel model;
  model.name = name;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : vertices) {
    model.vertices.push_back(vertex.cast<float>());
    box.extend(vertex);
    for (const Eigen::Vector3d& other : vertices) model.diameter = std::max(model.diameter, (vertex - other).norm());
  }
  model.centre = box.center();
  for (std::size_t f = 0; f < faces.size(); ++f) {
    ModelFace face;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 2; k < faces[f].size(); ++k) {
      const std::array<int, 3> triangle = {faces[f][0], faces[f][k - 1], faces[f][k]};
      const auto corner = [&](std::size_t i) { return vertices[static_cast<std::size_t>(triangle[i])]; };
      const Eigen::Vector3d twice = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      face.area += 0.5 * twice.norm();
      face.normal = twice.normalized();
      sum += 0.5 * twice.norm() * (corner(0) + corner(1) + corner(2)) / 3.0;
      model.triangles.push_back(triangle);
      model.triangle_faces.push_back(static_cast<int>(f));
    }
    face.centroid = sum / face.area;
    face.offset = face.normal.dot(face.centroid);
    model.faces.push_back(face);
  }
  for (std::size_t t = 0; t < model.triangles.size(); ++t) add_template_points(model, t);
  const ViewingSphere sphere(kAspectCells);
  for (int cell = 0; cell < kAspectCells; ++cell) {
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      if (sphere.centre(cell).dot(model.faces[f].normal) > -0.3) {
        model.surface.aspects[static_cast<std::size_t>(cell)].push_back(static_cast<int>(f));
      }
    }
  }
  return model;
}

// A block of 70 x 50 x 40 mm about the origin without one corner, of which the cut takes 35, 25 and 20 mm: no symmetry,
// and not its own mirror image. Face 6 is the cut, faces 2 * axis and 2 * axis + 1 look along -axis and +axis.
inline CompiledModel cut_block() {
  const std::vector<Eigen::Vector3d> vertices = {{-35, -25, -20}, {35, -25, -20}, {-35, 25, -20}, {35, 25, -20},
                                                 {-35, -25, 20},  {35, -25, 20},  {-35, 25, 20},  {0, 25, 20},
                                                 {35, 0, 20},     {35, 25, 0}};
  return convex_solid(
      "cut_block", vertices,
      {{0, 4, 6, 2}, {1, 3, 9, 8, 5}, {0, 1, 5, 4}, {2, 6, 7, 9, 3}, {0, 2, 3, 1}, {4, 5, 8, 7, 6}, {7, 8, 9}});
}

// The same seen in a mirror: x to -x.
inline CompiledModel mirrored(const CompiledModel& model) {
  CompiledModel mirror = model;
  mirror.name = "mirrored_" + model.name;
  const auto turn = [](auto& v) { v.x() = -v.x(); };
  turn(mirror.centre);
  for (auto& vertex : mirror.vertices) turn(vertex);
  for (auto& triangle : mirror.triangles) std::swap(triangle[1], triangle[2]);
  for (ModelFace& face : mirror.faces) {
    turn(face.normal);
    turn(face.centroid);
  }
  for (TemplatePoint& point : mirror.surface.points) {
    turn(point.position);
    turn(point.normal);
  }
  const ViewingSphere sphere(kAspectCells);
  for (int cell = 0; cell < kAspectCells; ++cell) {
    std::vector<int>& aspect = mirror.surface.aspects[static_cast<std::size_t>(cell)];
    aspect.clear();
    for (std::size_t f = 0; f < mirror.faces.size(); ++f) {
      if (sphere.centre(cell).dot(mirror.faces[f].normal) > -0.3) aspect.push_back(static_cast<int>(f));
    }
  }
  return mirror;
}

// The face a region shows at a pose, if it shows one: by plane, and by lying within its reach.
inline std::optional<int> face_shown(const CompiledModel& model, const Pose& pose, const DescribedRegion& region) {
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const Eigen::Vector3d normal = pose.rotation * model.faces[f].normal;
    if (normal.dot(region.region.normal) < 0.99) continue;
    const double off = normal.dot(region.centroid - pose * model.faces[f].centroid);
    if (std::abs(off) < 2.0) return static_cast<int>(f);
  }
  return std::nullopt;
}

// A pose with the model's centre before the camera.
inline Pose random_pose(const CompiledModel& model, Random& random, double depth = 900.0) {
  Pose pose;
  pose.rotation = random.rotation();
  pose.translation = Eigen::Vector3d(0.0, 0.0, depth) - pose.rotation * model.centre;
  return pose;
}

// Fills in the statistics of faces and pairs, from random views.
inline void learn(CompiledModel& model, int views = 100) {
  Random random(11);
  const PinholeCamera camera;
  model.views = views;
  std::vector<std::array<std::vector<double>, kAttributeCount>> of_face(model.faces.size());
  std::map<std::pair<int, int>, std::array<std::vector<double>, kRelationCount>> of_pair;
  AttributeVector largest{};
  for (int view = 0; view < views; ++view) {
    const Pose pose = random_pose(model, random);
    const auto regions = extract_regions(image_of({{&model, pose}}, camera), camera, {});
    std::vector<std::pair<int, const DescribedRegion*>> found;
    for (const DescribedRegion& region : regions) {
      const std::optional<int> face = face_shown(model, pose, region);
      if (!face) continue;
      for (std::size_t k = 0; k < kAttributeCount; ++k) {
        of_face[static_cast<std::size_t>(*face)][k].push_back(region.attributes[k]);
        largest[k] = std::max(largest[k], region.attributes[k]);
      }
      for (const auto& [other, other_region] : found) {
        if (other == *face) continue;
        const RelationVector relation = relate(region, *other_region);
        auto& samples = of_pair[std::minmax(other, *face)];
        for (std::size_t k = 0; k < kRelationCount; ++k) samples[k].push_back(relation[k]);
      }
      found.emplace_back(*face, &region);
    }
  }
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    model.faces[f].views_found = static_cast<int>(of_face[f][0].size());
    for (std::size_t k = 0; k < kAttributeCount && model.faces[f].views_found > 0; ++k) {
      model.faces[f].densities[k] = estimate_density(of_face[f][k], 0.0, 1.02 * largest[k], {});
    }
  }
  model.pairs.clear();
  for (const auto& [faces, samples] : of_pair) {
    FacePair pair{faces.first, faces.second, static_cast<int>(samples[0].size()), {}};
    pair.densities[kOrientation] = estimate_density(samples[kOrientation], 0.0, std::numbers::pi + 1e-6, {});
    pair.densities[kMaxDistance] = estimate_density(samples[kMaxDistance], 0.0, 1.02 * model.diameter, {});
    model.pairs.push_back(pair);
  }
}

inline Database database_of(const std::vector<CompiledModel>& models) {
  CompiledDatabase content;
  content.models = models;
  return Database(std::move(content));
}

inline const CompiledModel& learned_block() {
  static const CompiledModel model = [] {
    CompiledModel block = cut_block();
    learn(block);
    return block;
  }();
  return model;
}

// Of box_scene.h, with statistics.
inline const CompiledModel& learned_box() {
  static const CompiledModel model = [] {
    CompiledModel box = box_model();
    learn(box);
    return box;
  }();
  return model;
}

// A scan with all that refers to it kept alive.
struct SeenScan {
  SensorModel sensor;
  RangeImage image;
  PoolVector<DescribedRegion> regions;

  explicit SeenScan(RangeImage seen) : image(std::move(seen)), regions(extract_regions(image, sensor.camera, {})) {}
  SeenScan(const SeenScan&) = delete;
  SeenScan& operator=(const SeenScan&) = delete;

  [[nodiscard]] LabelledScan labelled() const { return label_scan(image, sensor.camera, sensor, regions); }
};

}  // namespace foresight::test
