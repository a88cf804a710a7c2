// Robust pose refinement by 3D template matching (Section V.A, V.B, eqs. (6)-(10)).
#pragma once

#include <Eigen/Core>

#include "common/compiled_model.h"
#include "common/memory_pool.h"
#include "common/pose.h"
#include "common/segmentation.h"
#include "common/viewing_sphere.h"
#include "runtime/foresight.h"
#include "runtime/nearest_data.h"

namespace foresight {

struct LocalizationOptions {
  Loss loss = Loss::lorentzian;
  double sigma = 2.0;             // standard deviation of the sensor's error, Section V.B. Unit: mm. Limit: > 0.
  double translation_step = 1.0;  // Section V.B. Unit: mm. Limit: > 0.
  double rotation_step = 0.017453292519943295;  // 1 degree, Section V.B. Unit: rad. Limit: > 0.
  // Template points without data this near pull nowhere: beyond the paper, where each is pulled to its nearest data
  // point however far. Searches end sooner; 0 = the paper's. Unit: mm. Limit: >= 0.
  double reach = 0.0;
  // So many of the visible template points take part, evenly chosen; 0 = the paper's, all. Limit: >= 0.
  int most_points = 0;
  int most_rounds = 50;  // the paper's UNTIL may cycle when the aspect changes: a cap on its rounds. Limit: >= 1.
};

struct Localization {
  Pose T_sensor_model;
  double energy = 0.0;         // E of eq. (9) at the end
  int energy_evaluations = 0;  // computations of E: Table I's cost
};

// Indices of the template points visible in a pose, ascending: those with a face in the aspect of the current viewing
// direction, which points from the model's centre to the camera. V(q). Empty when that centre lies in the camera.
[[nodiscard]] PoolVector<int> visible_points(const CompiledModel& model, const ViewingSphere& sphere,
                                             const Pose& T_sensor_model);

// One evaluation of E(q), eq. (9), with what it was summed from.
struct EnergyEvaluation {
  struct Residual {
    Eigen::Vector3d point;    // x_i(q), the template point in the sensor frame. Unit: mm.
    Eigen::Vector3d nearest;  // its nearest data point. Unit: mm.
    double distance = 0.0;    // z_i(q), eq. (10). Unit: mm.
    int data_index = 0;       // of the nearest data point, for the next search; -1: none within reach, and
    double clearance = 0.0;   // no data are nearer than this. Unit: mm.
  };
  double energy = 0.0;
  PoolVector<Residual> residuals;  // in the order of the visible points
};

// E(q) of eq. (9) over fixed visible points: one search for a nearest data point each. 0 when there are none.
// nearby: an evaluation of the same visible points at a pose not far away; the searches start from its nearest points.
[[nodiscard]] EnergyEvaluation evaluate_energy(const CompiledModel& model, const PoolVector<int>& visible,
                                               const Pose& T_sensor_model, const NearestData& data,
                                               const LocalizationOptions& options,
                                               const EnergyEvaluation* nearby = nullptr);

// Its energy alone.
[[nodiscard]] double localization_energy(const CompiledModel& model, const PoolVector<int>& visible,
                                         const Pose& T_sensor_model, const NearestData& data,
                                         const LocalizationOptions& options);

// Derivatives of E, eq. (7), with the nearest data points of the evaluation: they need no search of their own.
struct EnergyGradient {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // by a translation in the sensor frame. Unit: 1/mm.
  Eigen::Vector3d rotation =
      Eigen::Vector3d::Zero();  // by a rotation vector about `centre`, sensor frame. Unit: 1/rad.
};
[[nodiscard]] EnergyGradient energy_gradient(const EnergyEvaluation& evaluation, const Eigen::Vector3d& centre,
                                             const LocalizationOptions& options);

// The paper's pseudo-code: line searches of fixed step against the gradient, translation and rotation in turn, the
// aspect fixed within each, until neither takes a step. sphere: ViewingSphere(80).
// A start in which nothing is visible is returned as it is, with energy 0; verification accepts no such pose.
// stop: asked between line searches; the pose is as good as it has become by then.
[[nodiscard]] Localization localize(const CompiledModel& model, const ViewingSphere& sphere, const Pose& start,
                                    const NearestData& data, const LocalizationOptions& options, const Stop& stop = {});

}  // namespace foresight
