// A range image, made ready for the rivals.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "benchmarks/rivals/oriented_points.h"
#include "common/camera.h"
#include "common/range_image.h"
#include "common/sensor_model.h"

namespace foresight {

struct RivalSceneOptions {
  int normal_window = 3;             // cells each way that a normal is fitted to. Limit: >= 1.
  double depth_step = 6.0;           // of neighbours: farther in depth is another surface. Unit: mm. Limit: > 0.
  double background_share = 0.3;     // planes that cover more than this of the scan are background. Limit: (0, 1].
  double background_distance = 2.0;  // of data points from a background plane, and
  double background_sigmas = 3.0;    // at least this many standard deviations of the sensor. Unit: mm. Limit: > 0.
  int background_trials = 200;       // of RANSAC, a plane. Limit: >= 1.
  int most_background_planes = 2;    // a floor and a backdrop. Limit: >= 0.
};

struct RivalScene {
  const RangeImage* image = nullptr;
  PinholeCamera camera;
  std::vector<Eigen::Vector3f> normals;  // of each cell, unit, towards the sensor; zero where there is none
  std::vector<bool> background;          // of each cell
  OrientedPoints points;                 // of the cells with a normal that are not background
};

// Background is looked for only where the sensor's scans show one. The image must outlive the scene.
[[nodiscard]] RivalScene prepare_scene(const RangeImage& image, const PinholeCamera& camera, const SensorModel& sensor,
                                       const RivalSceneOptions& options = {});

// Overlapping balls of this radius that cover the points: centres among the points, none within 0.9 radius of another,
// each the point farthest from those before. Balls with fewer than `fewest` points are left out. Indices of points.
[[nodiscard]] std::vector<std::vector<std::size_t>> windows(const OrientedPoints& points, double radius,
                                                            std::size_t fewest);

}  // namespace foresight
