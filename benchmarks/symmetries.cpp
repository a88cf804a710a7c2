#include "benchmarks/symmetries.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

namespace foresight {
namespace {

struct Solid {
  std::vector<CadFace>
      faces;  // planes and centroids relative to the surface's centre of gravity, which every symmetry keeps
  std::vector<Eigen::Vector3d> corners;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

Solid centred(const CadModel& model) {
  Solid solid;
  double area = 0.0;
  for (const CadFace& face : model.faces) {
    solid.centre += face.area * face.centroid;
    area += face.area;
  }
  solid.centre /= area;
  solid.faces = model.faces;
  for (CadFace& face : solid.faces) {
    face.centroid -= solid.centre;
    face.offset -= face.normal.dot(solid.centre);
  }
  std::vector<std::set<int>> meeting(model.vertices.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (const int vertex : model.triangles[t])
      meeting[static_cast<std::size_t>(vertex)].insert(model.triangle_face[t]);
  }
  for (std::size_t v = 0; v < model.vertices.size(); ++v) {
    if (meeting[v].size() >= 3) solid.corners.push_back(model.vertices[v] - solid.centre);
  }
  return solid;
}

// What a rotation about the centre cannot change.
bool alike(const CadFace& a, const CadFace& b, const SymmetryOptions& options) {
  return std::abs(a.offset - b.offset) <= options.distance &&
         std::abs(a.centroid.norm() - b.centroid.norm()) <= options.distance &&
         std::abs(a.area - b.area) <= options.area * std::max(a.area, b.area);
}

bool keeps(const Solid& solid, const Eigen::Matrix3d& rotation, const SymmetryOptions& options) {
  const double cosine = std::cos(options.angle);
  const auto face_stays = [&](const CadFace& face) {
    return std::any_of(solid.faces.begin(), solid.faces.end(), [&](const CadFace& other) {
      return alike(face, other, options) && other.normal.dot(rotation * face.normal) >= cosine &&
             (rotation * face.centroid - other.centroid).norm() <= options.distance;
    });
  };
  const auto corner_stays = [&](const Eigen::Vector3d& corner) {
    return std::any_of(solid.corners.begin(), solid.corners.end(), [&](const Eigen::Vector3d& other) {
      return (rotation * corner - other).norm() <= options.distance;
    });
  };
  return std::all_of(solid.faces.begin(), solid.faces.end(), face_stays) &&
         std::all_of(solid.corners.begin(), solid.corners.end(), corner_stays);
}

// Right-handed axes from two directions that are not parallel.
Eigen::Matrix3d axes(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  Eigen::Matrix3d frame;
  frame.col(0) = first;
  frame.col(2) = first.cross(second).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

// Two faces whose images fix a rotation: the two not parallel ones with the fewest look-alikes.
std::pair<std::size_t, std::size_t> rarest_pair(const Solid& solid, const SymmetryOptions& options) {
  std::vector<long> count(solid.faces.size(), 0);
  for (std::size_t i = 0; i < solid.faces.size(); ++i) {
    count[i] = std::count_if(solid.faces.begin(), solid.faces.end(),
                             [&](const CadFace& other) { return alike(solid.faces[i], other, options); });
  }
  std::pair<std::size_t, std::size_t> best{0, 0};
  long fewest = -1;
  for (std::size_t i = 0; i < solid.faces.size(); ++i) {
    for (std::size_t k = 0; k < solid.faces.size(); ++k) {
      if (std::abs(solid.faces[i].normal.dot(solid.faces[k].normal)) > 0.95) continue;
      if (fewest >= 0 && count[i] * count[k] >= fewest) continue;
      fewest = count[i] * count[k];
      best = {i, k};
    }
  }
  return best;
}

Pose about(const Eigen::Vector3d& centre, const Eigen::Matrix3d& rotation) {
  return {rotation, centre - rotation * centre};
}

}  // namespace

std::vector<Pose> find_symmetries(const CadModel& model, const SymmetryOptions& options) {
  const Solid solid = centred(model);
  const auto [first, second] = rarest_pair(solid, options);
  const CadFace& a = solid.faces[first];
  const CadFace& b = solid.faces[second];
  std::vector<Eigen::Matrix3d> rotations = {Eigen::Matrix3d::Identity()};
  const auto is_new = [&](const Eigen::Matrix3d& rotation) {
    return std::none_of(rotations.begin(), rotations.end(), [&](const Eigen::Matrix3d& known) {
      return rotation_angle(known.transpose() * rotation) < 2.0 * options.angle;
    });
  };
  for (const CadFace& image_a : solid.faces) {
    if (!alike(a, image_a, options)) continue;
    for (const CadFace& image_b : solid.faces) {
      const double turn = std::abs(image_a.normal.dot(image_b.normal) - a.normal.dot(b.normal));
      if (!alike(b, image_b, options) || turn > options.angle) continue;
      const Eigen::Matrix3d rotation = axes(image_a.normal, image_b.normal) * axes(a.normal, b.normal).transpose();
      if (is_new(rotation) && keeps(solid, rotation, options)) rotations.push_back(rotation);
    }
  }
  std::stable_sort(rotations.begin(), rotations.end(), [](const auto& left, const auto& right) {
    return rotation_angle(left) < rotation_angle(right) - 1e-6;
  });
  std::vector<Pose> symmetries;
  for (const Eigen::Matrix3d& rotation : rotations) symmetries.push_back(about(solid.centre, rotation));
  return symmetries;
}

}  // namespace foresight
