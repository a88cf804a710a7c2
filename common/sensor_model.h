// The facts of one range finder: what the compiler simulates and the runtime assumes (Section III; DESIGN: the sensor model).
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "common/camera.h"

namespace foresight {

struct SensorModel {
  std::string name = "paper";
  PinholeCamera camera;
  // Where the light comes from; casts shadows. None: no shadows (the paper's simulator). Unit: mm, sensor frame.
  std::optional<Eigen::Vector3d> projector;
  double nearest_distance = 900.0;   // working range along z. Unit: mm. Limit: > 0.
  double farthest_distance = 900.0;  // Unit: mm. Limit: >= nearest_distance.
  double depth_quantization = 0.1;   // step of z, 0 = none. Unit: mm. Limit: >= 0.
  double depth_noise = 0.0;          // standard deviation of z before quantization. Unit: mm. Limit: >= 0.
  double largest_incidence = 1.5707963267948966;  // steeper surfaces give no data. Unit: rad. Limit: (0, pi/2].
  bool background = false;           // whether scans show a floor or a backdrop behind the objects
  // Side of the square of cells that each depth is taken from. Stereo cameras match windows: edges become ramps of this
  // width, and cells nearer together err alike. Unit: cells. Limit: odd, 1 to 31.
  int matching_window = 1;

  [[nodiscard]] double working_distance() const { return 0.5 * (nearest_distance + farthest_distance); }
  // Standard deviation of one depth value: noise and quantization together. Unit: mm.
  [[nodiscard]] double depth_sigma() const;
  // Side of one cell on a surface facing the sensor at the working distance; the larger of rows and columns. Unit: mm.
  [[nodiscard]] double cell_size() const;
  // Width and height of the field of view at the working distance; the smaller of the two. Unit: mm.
  [[nodiscard]] double field_of_view() const;
};

bool operator==(const SensorModel& a, const SensorModel& b);

// Throws InputError naming `file` when a field is outside its limits.
void check(const SensorModel& sensor, const std::string& file);

}  // namespace foresight
