#include "runtime/localization.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <utility>

#include "runtime/robust_loss.h"

namespace foresight {
namespace {

// Cell of the current viewing direction, -1 when there is none.
int aspect_of(const CompiledModel& model, const ViewingSphere& sphere, const Pose& T_sensor_model) {
  assert(sphere.size() == kAspectCells);
  const Eigen::Vector3d direction = -(T_sensor_model.rotation.transpose() * (T_sensor_model * model.centre));
  return direction.norm() > 0.0 ? sphere.cell_of(direction.normalized()) : -1;
}

// Template points are listed face by face: every so many of them lie all over the surface.
PoolVector<int> evenly_chosen(PoolVector<int> points, int most) {
  const auto count = static_cast<std::size_t>(most);
  if (most == 0 || points.size() <= count) return points;
  for (std::size_t k = 0; k < count; ++k) points[k] = points[k * points.size() / count];
  points.resize(count);
  return points;
}

// What one refinement carries along.
class Refinement {
 public:
  Refinement(const CompiledModel& model, const ViewingSphere& sphere, const Pose& start, const NearestData& data,
             const LocalizationOptions& options)
      : model_(model), sphere_(sphere), data_(data), options_(options), pose_(start) {
    aspect_ = aspect_of(model_, sphere_, pose_);
    look(points_in_sight());
  }

  // The two line searches of the pseudo-code. Each says whether it took a step.
  bool translate();
  bool rotate();

  // V(q) of the current pose. E(q) is computed anew only when V(q) is another one: else it is known from the last step.
  void update_aspect() {
    const int aspect = aspect_of(model_, sphere_, pose_);
    if (aspect == aspect_) return;
    aspect_ = aspect;
    PoolVector<int> visible = points_in_sight();
    if (visible != visible_) look(std::move(visible));
  }
  [[nodiscard]] Localization result() const { return {pose_, current_.energy, evaluations_}; }

 private:
  [[nodiscard]] PoolVector<int> points_in_sight() const {
    return evenly_chosen(visible_points(model_, sphere_, pose_), options_.most_points);
  }
  void look(PoolVector<int> visible) {
    visible_ = std::move(visible);
    current_ = evaluate(pose_, nullptr);
  }
  EnergyEvaluation evaluate(const Pose& pose, const EnergyEvaluation* nearby) {
    ++evaluations_;
    return evaluate_energy(model_, visible_, pose, data_, options_, nearby);
  }
  // WHILE E(q + dq) < E(q): q = q + dq. pose_after: the pose after a number of steps.
  template <typename PoseAfter>
  bool search_line(const PoseAfter& pose_after);

  const CompiledModel& model_;
  const ViewingSphere& sphere_;
  const NearestData& data_;
  const LocalizationOptions& options_;
  Pose pose_;
  int aspect_ = -1;           // of the pose that V was last taken from
  PoolVector<int> visible_;   // V, fixed during a line search
  EnergyEvaluation current_;  // E at pose_ over visible_
  int evaluations_ = 0;
};

template <typename PoseAfter>
bool Refinement::search_line(const PoseAfter& pose_after) {
  int steps = 0;
  while (true) {
    const Pose trial = pose_after(steps + 1);
    EnergyEvaluation evaluation = evaluate(trial, &current_);
    if (!(evaluation.energy < current_.energy)) return steps > 0;
    pose_ = trial;
    current_ = std::move(evaluation);
    ++steps;
  }
}

bool Refinement::translate() {
  const Eigen::Vector3d gradient = energy_gradient(current_, pose_ * model_.centre, options_).translation;
  if (!(gradient.norm() > 0.0)) return false;
  const Eigen::Vector3d step = -options_.translation_step * gradient.normalized();
  return search_line([start = pose_, step](int steps) -> Pose {
    return {start.rotation, start.translation + steps * step};
  });
}

// The paper descends the gradient by the quaternion's components. Restricted to unit quaternions it is proportional to
// the gradient by a rotation vector (q -> exp(w / 2) q moves q by |w| / 2), so both turn about the same axis, and a
// step is a turn of rotation_step about it. Paper: q_theta turns about the origin of the model's frame, wherever the
// CAD file has it. Here: about the model's centre, so that turning moves the object as little as possible and does not
// undo the translation just found.
bool Refinement::rotate() {
  const Eigen::Vector3d centre = pose_ * model_.centre;
  const Eigen::Vector3d gradient = energy_gradient(current_, centre, options_).rotation;
  if (!(gradient.norm() > 0.0)) return false;
  const Eigen::Vector3d step = -options_.rotation_step * gradient.normalized();
  return search_line([this, start = pose_.rotation, centre, step](int steps) -> Pose {
    const Eigen::Matrix3d rotation = nearest_rotation(rotation_from_vector(steps * step) * start);
    return {rotation, centre - rotation * model_.centre};
  });
}

constexpr double kAhead = 3.0;  // searches in vain look this much farther, to spare the next ones. Unit: mm.

using Residual = EnergyEvaluation::Residual;

// Of a template point with no data within reach.
Residual pulled_nowhere(const Eigen::Vector3d& point, double reach, double clearance) {
  return {point, point, reach, -1, clearance};
}

// nearby: the same template point at a pose not far away, or null.
Residual residual_at(const Eigen::Vector3d& point, const Residual* nearby, const NearestData& data, double reach) {
  const Eigen::Vector3f query = point.cast<float>();
  const int guess = nearby == nullptr ? -1 : nearby->data_index;
  NearestData::Answer answer;
  if (reach > 0.0) {
    const double clearance = guess >= 0 || nearby == nullptr ? 0.0 : nearby->clearance - (point - nearby->point).norm();
    if (clearance > reach) return pulled_nowhere(point, reach, clearance);
    const double farther = guess >= 0 ? reach : reach + kAhead;
    answer = data.find_within(query, static_cast<float>(farther), guess);
    if (answer.index < 0 || !(answer.distance < static_cast<float>(reach)))
      return pulled_nowhere(point, reach, static_cast<double>(answer.distance));
  } else {
    answer = guess < 0 ? data.find(query) : data.find(query, guess);
  }
  const Eigen::Vector3d nearest = answer.point.cast<double>();
  return {point, nearest, (point - nearest).norm(), answer.index, 0.0};  // Equation (10)
}

}  // namespace

PoolVector<int> visible_points(const CompiledModel& model, const ViewingSphere& sphere, const Pose& T_sensor_model) {
  const int cell = aspect_of(model, sphere, T_sensor_model);
  if (cell < 0) return {};
  const std::vector<int>& aspect = model.surface.aspects[static_cast<std::size_t>(cell)];
  const auto shown = [&aspect](int face) { return std::binary_search(aspect.begin(), aspect.end(), face); };
  PoolVector<int> visible;
  for (std::size_t i = 0; i < model.surface.points.size(); ++i) {
    const std::vector<int>& faces = model.surface.points[i].faces;
    if (std::any_of(faces.begin(), faces.end(), shown)) visible.push_back(static_cast<int>(i));
  }
  return visible;
}

EnergyEvaluation evaluate_energy(const CompiledModel& model, const PoolVector<int>& visible, const Pose& T_sensor_model,
                                 const NearestData& data, const LocalizationOptions& options,
                                 const EnergyEvaluation* nearby) {
  assert(nearby == nullptr || nearby->residuals.size() == visible.size());
  EnergyEvaluation evaluation;
  evaluation.residuals.reserve(visible.size());
  for (std::size_t k = 0; k < visible.size(); ++k) {
    const TemplatePoint& point = model.surface.points[static_cast<std::size_t>(visible[k])];
    const Eigen::Vector3d x = T_sensor_model * point.position.cast<double>();
    const Residual* before = nearby == nullptr ? nullptr : &nearby->residuals[k];
    evaluation.residuals.push_back(residual_at(x, before, data, options.reach));
    const double z = evaluation.residuals.back().distance;
    evaluation.energy += rho(options.loss, z / options.sigma);  // Equation (9)
  }
  return evaluation;
}

double localization_energy(const CompiledModel& model, const PoolVector<int>& visible, const Pose& T_sensor_model,
                           const NearestData& data, const LocalizationOptions& options) {
  return evaluate_energy(model, visible, T_sensor_model, data, options).energy;
}

EnergyGradient energy_gradient(const EnergyEvaluation& evaluation, const Eigen::Vector3d& centre,
                               const LocalizationOptions& options) {
  EnergyGradient gradient;
  for (const EnergyEvaluation::Residual& residual : evaluation.residuals) {
    // d rho(z / sigma) / dx = psi(z / sigma) / sigma * (x - a) / z; written with the weight, it needs no division by z
    // and is 0 at z = 0.
    const double w = weight(options.loss, residual.distance / options.sigma) / (options.sigma * options.sigma);
    const Eigen::Vector3d pull = w * (residual.point - residual.nearest);
    gradient.translation += pull;
    gradient.rotation += (residual.point - centre).cross(pull);
  }
  return gradient;
}

Localization localize(const CompiledModel& model, const ViewingSphere& sphere, const Pose& start,
                      const NearestData& data, const LocalizationOptions& options, const Stop& stop) {
  assert(options.sigma > 0.0 && options.translation_step > 0.0 && options.rotation_step > 0.0 &&
         options.most_rounds >= 1);
  Refinement refinement(model, sphere, start, data, options);
  for (int round = 0; round < options.most_rounds; ++round) {
    if (stop && stop()) break;
    const bool translated = refinement.translate();
    refinement.update_aspect();
    if (stop && stop()) break;
    const bool rotated = refinement.rotate();
    refinement.update_aspect();
    // Paper: until E(q) = E_0. The two energies may sum over different aspects; that no step was taken says the same
    // within one aspect, and holds across them. Steps may still go in circles when the aspect alternates: hence the
    // cap.
    if (!translated && !rotated) break;
  }
  return refinement.result();
}

}  // namespace foresight
