#include "runtime/pose_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace foresight {
namespace {

struct Nearest {
  double squared_distance = std::numeric_limits<double>::infinity();
  Pose pose;
};

Nearest nearest(const ScoredObject& object, const Pose& reported, const Pose& truth) {
  Nearest least;
  for (const Pose& symmetry : object.symmetries) {
    const Pose symmetric = truth * symmetry;
    double largest = 0.0;
    for (const Eigen::Vector3d& vertex : object.vertices) {
      largest = std::max(largest, (reported * vertex - symmetric * vertex).squaredNorm());
      if (largest >= least.squared_distance) break;
    }
    if (largest < least.squared_distance) least = {largest, symmetric};
  }
  return least;
}

}  // namespace

double ScoredObject::tolerance() const { return std::max(kRightDistance, kRightShare * diameter); }

ScoredObject scored_object(const CompiledModel& model) {
  ScoredObject object;
  for (const Eigen::Vector3f& vertex : model.vertices) object.vertices.push_back(vertex.cast<double>());
  object.symmetries.push_back({});
  for (const Symmetry& symmetry : model.symmetries) {
    if (symmetry.exact) object.symmetries.push_back(symmetry.T_model_model);
  }
  object.diameter = model.diameter;
  return object;
}

double mssd(const ScoredObject& object, const Pose& reported, const Pose& truth) {
  return std::sqrt(nearest(object, reported, truth).squared_distance);
}

Pose nearest_equal(const ScoredObject& object, const Pose& reported, const Pose& truth) {
  return nearest(object, reported, truth).pose;
}

}  // namespace foresight
