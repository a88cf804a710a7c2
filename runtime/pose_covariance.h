// How far a reported pose may be off, as a 6x6 covariance: what the data on the object's planes and its outline leave
// undetermined, given the sensor's noise.
//
// Beyond the paper, which reports poses without their uncertainty.
#pragma once

#include <Eigen/Core>

#include "common/camera.h"
#include "common/compiled_model.h"
#include "common/memory_pool.h"
#include "common/pose.h"
#include "common/range_image.h"
#include "common/sensor_model.h"

namespace foresight {

// Symmetric, positive definite. Rows and columns: d = x, y, z (mm), then w = rotation vector (rad), both along the
// sensor's axes. The reported pose R, t and the error (d, w) give the true pose exp(w) R, t + d: the rotation is
// disturbed on the left and about the model's origin, whose place t is. So has ROS's PoseWithCovariance it.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

// What a data cell says about the pose: at `point`, the object is to be moved by `offset` along `direction`.
struct PoseConstraint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();      // sensor frame. Unit: mm.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // unit, sensor frame
  double offset = 0.0;                                  // Unit: mm.
  double sigma = 0.0;                                   // standard deviation of its own error. Unit: mm. Limit: > 0.
  double shared = 0.0;  // standard deviation of the error that all constraints of the group have. Unit: mm.
  int group = 0;        // a plane of the object; the constraints of a group stand together. -1: none, outline
};

// Planes: each cell in which the object is drawn and whose data are nearer to it than agreeing_distance(), edges left
// out, says where the plane (the face, or the triangle where faces are unknown) is, across it. The noise of cells is
// independent; quantization that no noise dithers is shared by the plane. Outline: where data on the object end at its
// drawn border before something farther or nothing, they say where the border is, to a cell: all of the border together
// counts as one such cell, since its errors are not independent.
[[nodiscard]] PoolVector<PoseConstraint> pose_constraints(const CompiledModel& model, const Pose& T_sensor_model,
                                                          const RangeImage& image, const PinholeCamera& camera,
                                                          const SensorModel& sensor);

// Before any data: any place within `distance` and any turn are as likely. Uniform errors of these limits.
struct PosePrior {
  Eigen::Vector3d about = Eigen::Vector3d::Zero();  // centre of the turn, sensor frame. Unit: mm.
  double distance = 0.0;                            // Unit: mm. Limit: > 0.
  double turn = 3.14159265358979;                   // Unit: rad. Limit: > 0.
};

// The mean square error of the pose with its origin at `origin`: the inverse of the information of constraints and
// prior, and the square of the step to the least squares pose, which a reported pose mostly falls short of. Planes
// whose data scatter more than their sigma count less by as much. Measured by `experiments covariance`.
[[nodiscard]] PoseCovariance covariance_of(const PoolVector<PoseConstraint>& constraints, const PosePrior& prior,
                                           const Eigen::Vector3d& origin);

// Both, with the object's diameter as the prior's distance. Assumes the right object near its true pose; what the
// sensor's calibration or the part's departure from its CAD model add is not in it.
[[nodiscard]] PoseCovariance pose_covariance(const CompiledModel& model, const Pose& T_sensor_model,
                                             const RangeImage& image, const PinholeCamera& camera,
                                             const SensorModel& sensor);

}  // namespace foresight
