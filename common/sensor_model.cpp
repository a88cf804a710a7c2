#include "common/sensor_model.h"

#include <algorithm>
#include <cmath>

#include "common/errors.h"

namespace foresight {

double SensorModel::depth_sigma() const {
  // A value rounded to steps of q has a uniform error of variance q^2 / 12.
  return std::sqrt(depth_noise * depth_noise + depth_quantization * depth_quantization / 12.0);
}

double SensorModel::cell_size() const { return working_distance() / std::min(camera.fx, camera.fy); }

double SensorModel::field_of_view() const {
  return working_distance() * std::min(camera.columns / camera.fx, camera.rows / camera.fy);
}

bool operator==(const SensorModel& a, const SensorModel& b) {
  return a.name == b.name && a.camera == b.camera && a.projector == b.projector &&
         a.nearest_distance == b.nearest_distance && a.farthest_distance == b.farthest_distance &&
         a.depth_quantization == b.depth_quantization && a.depth_noise == b.depth_noise &&
         a.largest_incidence == b.largest_incidence && a.background == b.background &&
         a.matching_window == b.matching_window;
}

void check(const SensorModel& sensor, const std::string& file) {
  const auto require = [&](bool holds, const std::string& cause, const std::string& mend) {
    if (!holds) throw InputError(file, cause, mend);
  };
  const auto side = [](int cells) { return cells >= kSmallestImageSide && cells <= kLargestImageSide; };
  const PinholeCamera& camera = sensor.camera;
  require(side(camera.rows) && side(camera.columns),
          "the image is " + std::to_string(camera.rows) + " x " + std::to_string(camera.columns) + " cells",
          "give rows and columns from 32 to 4096");
  require(camera.fx > 0 && camera.fy > 0 && std::isfinite(camera.fx) && std::isfinite(camera.fy),
          "a focal length is not a positive number", "give fx and fy in cells");
  require(std::isfinite(camera.cx) && std::isfinite(camera.cy), "the principal point is not finite", "give cx and cy in cells");
  require(sensor.nearest_distance > 0 && std::isfinite(sensor.farthest_distance) &&
              sensor.farthest_distance >= sensor.nearest_distance,
          "the working range is not 0 < nearest <= farthest", "give nearest_distance and farthest_distance in mm");
  require(sensor.depth_quantization >= 0 && std::isfinite(sensor.depth_quantization), "depth_quantization is negative or not finite",
          "give the depth step in mm, or 0");
  require(sensor.depth_noise >= 0 && std::isfinite(sensor.depth_noise), "depth_noise is negative or not finite",
          "give the standard deviation of the depth in mm, or 0");
  require(sensor.largest_incidence > 0 && sensor.largest_incidence <= 1.5707963267948967,
          "largest_incidence is outside (0, 90] degrees", "give the steepest angle at which a surface still gives data");
  require(sensor.matching_window >= 1 && sensor.matching_window <= 31 && sensor.matching_window % 2 == 1,
          "matching_window is " + std::to_string(sensor.matching_window) + " cells",
          "give an odd number of cells from 1 to 31");
  require(!sensor.projector || sensor.projector->allFinite(), "the projector position is not finite", "give x, y, z in mm");
}

}  // namespace foresight
