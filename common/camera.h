// The pinhole camera behind a range image.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/range_image.h"

namespace foresight {

struct PinholeCamera {
  int rows = 240;
  int columns = 256;
  double fx = 770.0;  // focal length along columns. Unit: cells. Limit: > 0.
  double fy = 770.0;  // focal length along rows. Unit: cells. Limit: > 0.
  double cx = 127.5;  // principal point, centre of the first cell = 0. Unit: cells.
  double cy = 119.5;

  // Ray through a (possibly fractional) cell, scaled so that z = 1.
  [[nodiscard]] Eigen::Vector3d ray(double row, double column) const {
    return {(column - cx) / fx, (row - cy) / fy, 1.0};
  }
  // (column, row) of a point in front of the camera. REQUIRES: point.z() > 0.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }
  // Nearest cell a point projects into, or -1 when it is behind the camera or outside the grid.
  [[nodiscard]] int cell_of(const Eigen::Vector3d& point) const;
};

bool operator==(const PinholeCamera& a, const PinholeCamera& b);

// The camera whose rays pass through the image's own grid, by least squares over its valid cells. Scans carry no
// intrinsics in PCD and PLY, but an organized grid determines them. None when fewer than 16 cells are valid, when they
// do not spread over rows and columns, or when the rms error of the fit exceeds half a cell (not a pinhole grid).
[[nodiscard]] std::optional<PinholeCamera> fit_camera(const RangeImage& image);

}  // namespace foresight
