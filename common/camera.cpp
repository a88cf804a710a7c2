#include "common/camera.h"

#include <cmath>

namespace foresight {
namespace {

// Least squares of `position = focal * ratio + principal` over one axis of the grid.
struct AxisFit {
  double n = 0, sum_r = 0, sum_p = 0, sum_rr = 0, sum_rp = 0, sum_pp = 0;

  void add(double ratio, double position) {
    n += 1;
    sum_r += ratio;
    sum_p += position;
    sum_rr += ratio * ratio;
    sum_rp += ratio * position;
    sum_pp += position * position;
  }
  [[nodiscard]] double spread() const { return sum_pp / n - (sum_p / n) * (sum_p / n); }
  [[nodiscard]] double focal() const { return (n * sum_rp - sum_r * sum_p) / (n * sum_rr - sum_r * sum_r); }
  [[nodiscard]] double principal() const { return (sum_p - focal() * sum_r) / n; }
  [[nodiscard]] double rms() const {
    const double variance_r = sum_rr / n - (sum_r / n) * (sum_r / n);
    return std::sqrt(std::max(0.0, spread() - focal() * focal() * variance_r));
  }
};

}  // namespace

int PinholeCamera::cell_of(const Eigen::Vector3d& point) const {
  if (!(point.z() > 0.0)) return -1;
  const Eigen::Vector2d p = project(point);
  // Compared as numbers before the cast: a point far aside would not fit an int.
  if (!(p.x() > -0.5 && p.x() < columns - 0.5 && p.y() > -0.5 && p.y() < rows - 0.5)) return -1;
  return static_cast<int>(std::lround(p.y())) * columns + static_cast<int>(std::lround(p.x()));
}

bool operator==(const PinholeCamera& a, const PinholeCamera& b) {
  return a.rows == b.rows && a.columns == b.columns && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy;
}

std::optional<PinholeCamera> fit_camera(const RangeImage& image) {
  AxisFit across;
  AxisFit down;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const int cell = image.cell(row, column);
      if (!image.valid(cell) || !(image[cell].z() > 0.0F)) continue;
      const Eigen::Vector3d point = image[cell].cast<double>();
      across.add(point.x() / point.z(), column);
      down.add(point.y() / point.z(), row);
    }
  }
  if (across.n < 16 || across.spread() < 1.0 || down.spread() < 1.0) return std::nullopt;
  PinholeCamera camera{image.rows, image.columns, across.focal(), down.focal(), across.principal(), down.principal()};
  if (!(camera.fx > 0.0) || !(camera.fy > 0.0) || !std::isfinite(camera.fx) || !std::isfinite(camera.fy)) return std::nullopt;
  if (!(across.rms() <= 0.5) || !(down.rms() <= 0.5)) return std::nullopt;
  return camera;
}

}  // namespace foresight
