#include "benchmarks/rivals/rival_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/plane_fit.h"
#include "common/random.h"

namespace foresight {
namespace {

constexpr double kCentreDistance = 0.9;  // of two windows, in radii
constexpr int kFewestForNormal = 6;      // cells

// Of the cells that are not background, from such cells alone.
std::vector<Eigen::Vector3f> grid_normals(const RangeImage& image, const std::vector<bool>& background,
                                          const RivalSceneOptions& options) {
  std::vector<Eigen::Vector3f> normals(static_cast<std::size_t>(image.size()), Eigen::Vector3f::Zero());
  const auto usable = [&](int cell) { return image.valid(cell) && !background[static_cast<std::size_t>(cell)]; };
  const int window = options.normal_window;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const int cell = image.cell(row, column);
      if (!usable(cell)) continue;
      PointSums sums;
      const Eigen::Vector3d origin = image[cell].cast<double>();
      for (int r = std::max(0, row - window); r <= std::min(image.rows - 1, row + window); ++r) {
        for (int c = std::max(0, column - window); c <= std::min(image.columns - 1, column + window); ++c) {
          const int other = image.cell(r, c);
          if (!usable(other)) continue;
          const Eigen::Vector3d point = image[other].cast<double>();
          if (std::abs(point.z() - origin.z()) <= options.depth_step) sums.add(point);
        }
      }
      if (sums.count() < kFewestForNormal) continue;
      normals[static_cast<std::size_t>(cell)] = sums.fit().normal.normalized().cast<float>();
    }
  }
  return normals;
}

std::vector<int> cells_near(const RangeImage& image, const std::vector<int>& cells, const Plane& plane,
                            double distance) {
  std::vector<int> near;
  for (const int cell : cells) {
    if (std::abs(plane.distance(image[cell].cast<double>())) <= distance) near.push_back(cell);
  }
  return near;
}

// The plane with most of the cells, by RANSAC, fitted again to what it holds.
std::vector<int> largest_plane(const RangeImage& image, const std::vector<int>& cells, double distance, int trials) {
  Random random(1, cells.size());
  std::vector<int> some;  // enough to count with
  const std::size_t stride = std::max<std::size_t>(1, cells.size() / 2000);
  for (std::size_t i = 0; i < cells.size(); i += stride) some.push_back(cells[i]);
  Plane best;
  std::size_t most = 0;
  for (int trial = 0; trial < trials; ++trial) {
    PointSums sums;
    for (int k = 0; k < 3; ++k) {
      const int pick = random.integer(0, static_cast<int>(cells.size()) - 1);
      sums.add(image[cells[static_cast<std::size_t>(pick)]].cast<double>());
    }
    const Plane plane = sums.fit();
    const std::size_t count = cells_near(image, some, plane, distance).size();
    if (count > most) {
      most = count;
      best = plane;
    }
  }
  for (int round = 0; round < 3; ++round) {
    PointSums sums;
    for (const int cell : cells_near(image, cells, best, distance)) sums.add(image[cell].cast<double>());
    if (sums.count() >= 3) best = sums.fit();
  }
  return cells_near(image, cells, best, distance);
}

std::vector<bool> find_background(const RangeImage& image, const SensorModel& sensor,
                                  const RivalSceneOptions& options) {
  std::vector<bool> background(static_cast<std::size_t>(image.size()), false);
  if (!sensor.background) return background;
  std::vector<int> left;
  for (int cell = 0; cell < image.size(); ++cell) {
    if (image.valid(cell)) left.push_back(cell);
  }
  const double distance = std::max(options.background_distance, options.background_sigmas * sensor.depth_sigma());
  const double fewest = options.background_share * static_cast<double>(left.size());
  for (int plane = 0; plane < options.most_background_planes && left.size() >= 3; ++plane) {
    const std::vector<int> cells = largest_plane(image, left, distance, options.background_trials);
    if (static_cast<double>(cells.size()) < fewest) break;
    for (const int cell : cells) background[static_cast<std::size_t>(cell)] = true;
    std::erase_if(left, [&](int cell) { return background[static_cast<std::size_t>(cell)]; });
  }
  return background;
}

}  // namespace

RivalScene prepare_scene(const RangeImage& image, const PinholeCamera& camera, const SensorModel& sensor,
                         const RivalSceneOptions& options) {
  RivalScene scene;
  scene.image = &image;
  scene.camera = camera;
  scene.background = find_background(image, sensor, options);
  scene.normals = grid_normals(image, scene.background, options);
  for (int cell = 0; cell < image.size(); ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    if (scene.normals[i] != Eigen::Vector3f::Zero()) {
      scene.points.add(image[cell], scene.normals[i]);
    }
  }
  return scene;
}

std::vector<std::vector<std::size_t>> windows(const OrientedPoints& points, double radius, std::size_t fewest) {
  std::vector<std::vector<std::size_t>> balls;
  if (points.size() == 0) return balls;
  std::vector<double> distance(points.size(), std::numeric_limits<double>::max());
  std::size_t centre = 0;
  while (distance[centre] > kCentreDistance * radius) {
    std::vector<std::size_t> ball;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double to_centre = static_cast<double>((points.points[i] - points.points[centre]).norm());
      distance[i] = std::min(distance[i], to_centre);
      if (to_centre <= radius) ball.push_back(i);
    }
    if (ball.size() >= fewest) balls.push_back(std::move(ball));
    centre = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
  }
  return balls;
}

}  // namespace foresight
