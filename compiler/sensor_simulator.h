// The appearance simulator (Section III): range images of CAD models through a sensor model, with the true face of
// every cell. The only place that knows Embree.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/pose.h"
#include "common/random.h"
#include "common/range_image.h"
#include "common/sensor_model.h"
#include "compiler/cad_model.h"

namespace foresight {

// What a cell shows.
struct CellLabel {
  int object = -1;  // index into the placed objects; -1: background or nothing
  int face = -1;    // face of that object's CadModel
};

struct SimulatedScan {
  RangeImage image;
  std::vector<CellLabel> labels;  // by cell; {-1, -1} where the cell is invalid or shows background
};

struct PlacedObject {
  const CadModel* model = nullptr;
  Pose T_sensor_model;
};

// An unbounded plane behind the objects (a table, a backdrop): normal . p = offset, sensor frame. Unit: mm.
struct BackgroundPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;
};

// A scene of rigid objects ready for ray casting. Owns its Embree device and scene (0.1 ms to make); const methods may
// run in parallel, and so may the making of several scenes.
class SimulatedScene {
 public:
  explicit SimulatedScene(std::span<const PlacedObject> objects, std::span<const BackgroundPlane> background = {});
  ~SimulatedScene();
  SimulatedScene(SimulatedScene&&) noexcept;
  SimulatedScene& operator=(SimulatedScene&&) noexcept;

  // One range image: a ray through each cell's centre; z with noise, over windows where
  // the sensor matches such, then quantized; no data where the sensor sees none
  // (nothing hit, projector shadow, grazing incidence). Same scene, sensor and seed: same bits.
  [[nodiscard]] SimulatedScan scan(const SensorModel& sensor, Random random) const;

  // Whether the segment from a surface point to the eye is free. The start is moved towards the eye by `margin` mm, to
  // leave the point's own surface. Background planes block too.
  [[nodiscard]] bool sees(const Eigen::Vector3d& eye, const Eigen::Vector3d& point, double margin = 1e-3) const;

  // The first surface along a ray; direction of any length. Unit: mm, along the ray. A hit with object -1 is
  // background.
  struct Hit {
    double distance;  // < 0: nothing hit
    int object;
    int face;
  };
  [[nodiscard]] Hit cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The instruction set Embree is pinned to: its hits differ between instruction sets, so it is one that every machine
// has, and recorded.
[[nodiscard]] std::string ray_isa();

// Pose of an object seen from `direction` (unit, model frame, object towards sensor) with its `centre` on the optical
// axis at `distance` mm, turned by `roll` radians about the optical axis. With roll 0 the model's z axis points up in
// the image (its y axis where the view is within 26 degrees of z).
[[nodiscard]] Pose view_pose(const Eigen::Vector3d& direction, const Eigen::Vector3d& centre, double distance,
                             double roll);

}  // namespace foresight
