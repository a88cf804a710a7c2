#include "benchmarks/perturbed_pose.h"

namespace foresight {

Pose perturbed_pose(const Pose& T_sensor_model, const Eigen::Vector3d& centre, Perturbation kind, Random& random) {
  const auto magnitude = [&](double limit) {
    return kind == Perturbation::exact_magnitude ? limit : random.uniform(0.0, limit);
  };
  const double distance = magnitude(kPerturbedBy);
  const double angle = magnitude(kPerturbedTurn);
  const Eigen::Vector3d move = distance * random.direction();
  const Eigen::Matrix3d turn = rotation_from_vector(angle * random.direction());
  const Eigen::Vector3d pivot = T_sensor_model * centre;
  return {turn * T_sensor_model.rotation, turn * (T_sensor_model.translation - pivot) + pivot + move};
}

}  // namespace foresight
