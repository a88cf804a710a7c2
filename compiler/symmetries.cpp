#include "compiler/symmetries.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "compiler/face_alignments.h"

namespace foresight {
namespace {

constexpr std::size_t kMostFaces = 1000;  // of a solid whose group is sought

struct Solid {
  std::vector<CadFace>
      faces;  // planes and centroids relative to the surface's centre of gravity, which every symmetry keeps
  std::vector<Eigen::Vector3d> corners;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

Solid centred(const CadModel& model) {
  Solid solid;
  solid.centre = surface_centre(model);
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

// The place of each product of two rotations in the list, -1 where it is not there.
std::vector<std::vector<int>> product_table(const std::vector<Eigen::Matrix3d>& rotations, double angle) {
  const double least_trace = 1.0 + 2.0 * std::cos(angle);  // trace(A^T B) = 1 + 2 cos(angle between A and B)
  std::vector<std::vector<int>> table(rotations.size(), std::vector<int>(rotations.size(), -1));
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    for (std::size_t k = 0; k < rotations.size(); ++k) {
      const Eigen::Matrix3d product = rotations[i] * rotations[k];
      const auto found = std::find_if(rotations.begin(), rotations.end(), [&](const Eigen::Matrix3d& rotation) {
        return rotation.cwiseProduct(product).sum() >= least_trace;
      });
      if (found != rotations.end()) table[i][k] = static_cast<int>(found - rotations.begin());
    }
  }
  return table;
}

// Takes away the rotation with the most products missing, the last of equals, until none is missing: a finite set with
// all its products is a group. The identity has none missing and stays.
std::vector<std::vector<int>> make_group(std::vector<Eigen::Matrix3d>& rotations, double angle) {
  for (;;) {
    std::vector<std::vector<int>> table = product_table(rotations, angle);
    std::size_t worst = 0;
    long most = 0;
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      long missing = std::count(table[i].begin(), table[i].end(), -1);
      for (const std::vector<int>& row : table) missing += row[i] < 0 ? 1 : 0;
      if (missing < most || missing == 0) continue;
      most = missing;
      worst = i;
    }
    if (most == 0) return table;
    rotations.erase(rotations.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

// Every rotation i is (i k) times the inverse of k for all k: the mean of them squares the error of what is nearly a
// group, whose rotations come from normals in single precision.
void polish(std::vector<Eigen::Matrix3d>& rotations, const std::vector<std::vector<int>>& table) {
  std::vector<Eigen::Matrix3d> polished;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < rotations.size(); ++k)
      sum += rotations[static_cast<std::size_t>(table[i][k])] * rotations[k].transpose();
    polished.push_back(nearest_rotation(sum));
  }
  polished.front() = Eigen::Matrix3d::Identity();
  rotations = std::move(polished);
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
      const Eigen::Matrix3d rotation =
          axes_from(image_a.normal, image_b.normal) * axes_from(a.normal, b.normal).transpose();
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

std::vector<Pose> symmetry_group(const CadModel& model, int most, const SymmetryOptions& options) {
  if (model.faces.size() > kMostFaces) return {Pose{}};
  const std::vector<Pose> symmetries = find_symmetries(model, options);
  if (symmetries.size() > static_cast<std::size_t>(most)) return {Pose{}};
  std::vector<Eigen::Matrix3d> rotations;
  for (const Pose& symmetry : symmetries) rotations.push_back(symmetry.rotation);
  rotations.front() = Eigen::Matrix3d::Identity();
  const std::vector<std::vector<int>> table = make_group(rotations, 2.0 * options.angle);
  for (int i = 0; i < 2; ++i) polish(rotations, table);
  const Eigen::Vector3d centre = surface_centre(model);
  std::vector<Pose> group;
  for (const Eigen::Matrix3d& rotation : rotations) group.push_back(about(centre, rotation));
  return group;
}

}  // namespace foresight
