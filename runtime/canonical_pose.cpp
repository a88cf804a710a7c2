#include "runtime/canonical_pose.h"

#include <cmath>
#include <limits>

namespace foresight {
namespace {

constexpr double kEqual =
    1e-6;  // of a trace or an entry of a rotation; far above rounding, far below what a sensor tells

// Whether a comes before b.
bool comes_first(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const double turn = a.trace() - b.trace();
  if (std::abs(turn) > kEqual) return turn > 0.0;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double difference = a(row, column) - b(row, column);
      if (std::abs(difference) > kEqual) return difference > 0.0;
    }
  }
  return false;
}

}  // namespace

CanonicalPose canonical_choice(const CompiledModel& model, const Pose& T_sensor_model) {
  CanonicalPose best{T_sensor_model, Pose{}};
  for (const Symmetry& symmetry : model.symmetries) {
    if (!symmetry.exact) break;  // they come first
    const Pose pose = T_sensor_model * symmetry.T_model_model;
    if (comes_first(pose.rotation, best.T_sensor_model.rotation)) best = {pose, symmetry.T_model_model};
  }
  return best;
}

Pose canonical_pose(const CompiledModel& model, const Pose& T_sensor_model) {
  return canonical_choice(model, T_sensor_model).T_sensor_model;
}

PoolVector<int> moved_faces(const CompiledModel& model, const PoolVector<int>& faces, const Pose& T_model_model) {
  const Pose inverse = T_model_model.inverse();
  const auto nearest = [&](const ModelFace& face) {
    const Eigen::Vector3d centroid = inverse * face.centroid;
    const Eigen::Vector3d normal = inverse.rotation * face.normal;
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      const ModelFace& other = model.faces[f];
      // A normal the other way round counts as a whole diameter: thin plates have two faces in nearly one place. Areas
      // tell apart a disc and the ring around it, whose centroids are one point.
      const double apart = (other.centroid - centroid).norm() +
                           0.5 * model.diameter * (1.0 - other.normal.dot(normal)) +
                           std::abs(std::sqrt(other.area) - std::sqrt(face.area));
      if (apart >= least) continue;
      least = apart;
      best = static_cast<int>(f);
    }
    return best;
  };
  PoolVector<int> moved;
  for (const int face : faces) moved.push_back(nearest(model.faces[static_cast<std::size_t>(face)]));
  return moved;
}

PoolVector<Pose> near_symmetric_poses(const CompiledModel& model, const Pose& T_sensor_model) {
  PoolVector<Pose> poses;
  for (const Symmetry& symmetry : model.symmetries) {
    if (!symmetry.exact) poses.push_back(T_sensor_model * symmetry.T_model_model);
  }
  return poses;
}

}  // namespace foresight
