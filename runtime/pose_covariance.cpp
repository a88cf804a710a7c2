#include "runtime/pose_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "runtime/pose_evidence.h"
#include "runtime/rendering.h"

namespace foresight {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kLeastSigma = 1e-3;        // no sensor is better than a micrometre. Unit: mm.
constexpr float kEdgeCosine = 0.87F;        // of the normals at an edge: 30 degrees, as region and surface may differ
constexpr int kOutlineWindow = 3;           // cells to each side that tell which way an outline runs
constexpr int kBeyond = 2;                  // cells from the border to data that are surely not of the object
constexpr double kOutlineSigma = 1.0;       // Unit: cells.
constexpr std::size_t kFewestScatter = 24;  // constraints that tell how much data scatter

// Noise dithers quantization: what is left of the rounding error as a bias that neighbouring cells share falls with
// exp(-2 (pi sigma / q)^2) (Widrow & Kollar, Quantization Noise, 2008).
double shared_quantization(const SensorModel& sensor) {
  const double step = sensor.depth_quantization;
  if (!(step > 0.0)) return 0.0;
  const double ratio = std::numbers::pi * sensor.depth_noise / step;
  return step / std::sqrt(12.0) * std::exp(-2.0 * ratio * ratio);
}

// The object drawn over the image.
class DrawnObject {
 public:
  DrawnObject(const CompiledModel& model, const Pose& pose, const RangeImage& image, const PinholeCamera& camera,
              const SensorModel& sensor)
      : model_(model),
        image_(image),
        camera_(camera),
        drawn_(render(model, pose, camera)),
        distance_(agreeing_distance(sensor)),
        sigma_(sensor.depth_sigma()),
        shared_(shared_quantization(sensor)),
        least_cosine_(std::cos(sensor.largest_incidence)) {}

  [[nodiscard]] PoolVector<PoseConstraint> constraints() const {
    PoolVector<PoseConstraint> planes;
    PoolVector<PoseConstraint> outline;
    for (int row = 0; row < drawn_.rows; ++row) {
      for (int column = 0; column < drawn_.columns; ++column) {
        const std::optional<PoseConstraint> plane = plane_at(row, column);
        if (!plane) continue;
        if (inner(row, column)) planes.push_back(*plane);
        if (const std::optional<PoseConstraint> border = outline_at(row, column)) outline.push_back(*border);
      }
    }
    const double together = std::sqrt(static_cast<double>(outline.size()));
    for (PoseConstraint& border : outline) {
      border.sigma *= together;
      planes.push_back(border);
    }
    return planes;
  }

 private:
  [[nodiscard]] int triangle(int row, int column) const {
    if (row < 0 || column < 0 || row >= drawn_.rows || column >= drawn_.columns) return -1;
    return drawn_.triangle[static_cast<std::size_t>(drawn_.cell(row, column))];
  }
  [[nodiscard]] const Eigen::Vector3f& normal(int triangle) const {
    return drawn_.normal[static_cast<std::size_t>(triangle)];
  }
  [[nodiscard]] double depth(int row, int column) const {
    return static_cast<double>(drawn_.depth[static_cast<std::size_t>(drawn_.cell(row, column))]);
  }
  [[nodiscard]] Eigen::Vector3d ray(int row, int column) const {
    return camera_.ray(row + drawn_.first_row, column + drawn_.first_column);
  }
  // -1 outside the image.
  [[nodiscard]] int image_cell(int row, int column) const {
    row += drawn_.first_row;
    column += drawn_.first_column;
    if (row < 0 || column < 0 || row >= image_.rows || column >= image_.columns) return -1;
    return image_.cell(row, column);
  }

  // None where there are no data on the object.
  [[nodiscard]] std::optional<PoseConstraint> plane_at(int row, int column) const {
    const int drawn = triangle(row, column);
    const int cell = image_cell(row, column);
    if (drawn < 0 || cell < 0 || !image_.valid(cell)) return std::nullopt;
    PoseConstraint plane;
    plane.direction = normal(drawn).cast<double>().normalized();
    const Eigen::Vector3d sight = ray(row, column);
    const double facing = -plane.direction.dot(sight);
    if (facing <= least_cosine_ * sight.norm()) return std::nullopt;
    plane.point = image_[cell].cast<double>();
    plane.offset = (depth(row, column) - plane.point.z()) * facing;
    if (std::abs(plane.offset) > distance_) return std::nullopt;
    plane.sigma = std::max(kLeastSigma, sigma_ * facing);
    plane.shared = shared_ * facing;
    plane.group = model_.triangle_faces.empty() ? drawn : model_.triangle_faces[static_cast<std::size_t>(drawn)];
    return plane;
  }

  // Whether the surface goes on around the cell, without an edge.
  [[nodiscard]] bool inner(int row, int column) const {
    const int drawn = triangle(row, column);
    const Eigen::Vector3f& here = normal(drawn);
    const double depth_here = depth(row, column);
    const Eigen::Vector3d sight = ray(row, column);
    const double cosine = -here.cast<double>().dot(sight) / sight.norm();
    const double step = distance_ + 3.0 * depth_here / camera_.fx / std::max(cosine, 0.05);
    for (int r = row - 1; r <= row + 1; ++r) {
      for (int c = column - 1; c <= column + 1; ++c) {
        const int other = triangle(r, c);
        if (other < 0 || (other != drawn && here.dot(normal(other)) < kEdgeCosine)) return false;
        if (std::abs(depth(r, c) - depth_here) > step) return false;
      }
    }
    return true;
  }

  // Away from the object, in cells to the right and down; zero where the cell is not at its border.
  [[nodiscard]] Eigen::Vector2d outwards(int row, int column) const {
    const bool border = triangle(row - 1, column) < 0 || triangle(row + 1, column) < 0 ||
                        triangle(row, column - 1) < 0 || triangle(row, column + 1) < 0;
    Eigen::Vector2d away = Eigen::Vector2d::Zero();
    for (int r = -kOutlineWindow; border && r <= kOutlineWindow; ++r) {
      for (int c = -kOutlineWindow; c <= kOutlineWindow; ++c) {
        if (triangle(row + r, column + c) >= 0) away -= Eigen::Vector2d(c, r);
      }
    }
    return away.norm() > 0.0 ? away.normalized().eval() : away;
  }

  // None where the border is that of something before the object, of the image, or not seen in the data.
  [[nodiscard]] std::optional<PoseConstraint> outline_at(int row, int column) const {
    const Eigen::Vector2d away = outwards(row, column);
    if (away.isZero()) return std::nullopt;
    const int r = row + static_cast<int>(std::lround(kBeyond * away.y()));
    const int c = column + static_cast<int>(std::lround(kBeyond * away.x()));
    const int beyond = image_cell(r, c);
    if (beyond < 0 || triangle(r, c) >= 0) return std::nullopt;
    if (image_.valid(beyond)) {
      const Eigen::Vector3d plane = normal(triangle(row, column)).cast<double>();
      const Eigen::Vector3d place = depth(row, column) * ray(row, column);
      if (plane.dot(image_[beyond].cast<double>() - place) > -distance_) return std::nullopt;
    }
    PoseConstraint border;
    border.point = depth(row, column) * ray(row, column);
    const Eigen::Vector3d sight = ray(row, column).normalized();
    const Eigen::Vector3d side(away.x(), away.y(), 0.0);
    border.direction = (side - side.dot(sight) * sight).normalized();
    border.sigma = kOutlineSigma * depth(row, column) / std::min(camera_.fx, camera_.fy);
    border.group = -1;
    return border;
  }

  const CompiledModel& model_;
  const RangeImage& image_;
  const PinholeCamera& camera_;
  const Rendering drawn_;
  double distance_;
  double sigma_;
  double shared_;
  double least_cosine_;
};

// Normal equations of errors (d, w about a centre): H e = g.
struct Information {
  PoseCovariance H = PoseCovariance::Zero();
  Vector6 g = Vector6::Zero();
  double squares = 0.0;  // weighted, of the offsets
  std::size_t count = 0;

  void add(const Information& other) {
    H += other.H;
    g += other.g;
    squares += other.squares;
    count += other.count;
  }
};

// Constraints that stand together. Their errors have the covariance D + b b^T, with D = diag(sigma^2) and b = shared;
// its inverse is W - W b (W b)^T / (1 + b^T W b), with W the inverse of D.
class Group {
 public:
  void add(const PoseConstraint& constraint, const Eigen::Vector3d& about) {
    Vector6 a;
    a << constraint.direction, (constraint.point - about).cross(constraint.direction);
    const double weight = 1.0 / (constraint.sigma * constraint.sigma);
    const double shared = weight * constraint.shared;
    own_.H.noalias() += (weight * a) * a.transpose();
    own_.g += weight * constraint.offset * a;
    own_.squares += weight * constraint.offset * constraint.offset;
    ++own_.count;
    shared_a_ += shared * a;
    shared_r_ += shared * constraint.offset;
    shared_b_ += shared * constraint.shared;
  }

  [[nodiscard]] Information information() const {
    Information sum = own_;
    sum.H -= shared_a_ * shared_a_.transpose() / shared_b_;
    sum.g -= shared_a_ * shared_r_ / shared_b_;
    sum.squares -= shared_r_ * shared_r_ / shared_b_;
    return sum;
  }

 private:
  Information own_;
  Vector6 shared_a_ = Vector6::Zero();
  double shared_r_ = 0.0;
  double shared_b_ = 1.0;
};

struct AllInformation {
  Information planes;
  Information outline;
};

AllInformation gather(const PoolVector<PoseConstraint>& constraints, const Eigen::Vector3d& about) {
  PoolMap<int, Group> groups;
  for (const PoseConstraint& constraint : constraints) groups[constraint.group].add(constraint, about);
  AllInformation all;
  for (const auto& [number, group] : groups) (number < 0 ? all.outline : all.planes).add(group.information());
  return all;
}

// How much larger the scatter about the best pose is than the sensor's noise says, as a variance; at least 1.
double excess_scatter(const Information& planes, const PoseCovariance& prior) {
  if (planes.count < kFewestScatter) return 1.0;
  const Vector6 step = (planes.H + prior).ldlt().solve(planes.g);
  const double left = planes.squares - planes.g.dot(step);
  return std::max(1.0, left / (static_cast<double>(planes.count) - 6.0));
}

}  // namespace

PoolVector<PoseConstraint> pose_constraints(const CompiledModel& model, const Pose& T_sensor_model,
                                            const RangeImage& image, const PinholeCamera& camera,
                                            const SensorModel& sensor) {
  return DrawnObject(model, T_sensor_model, image, camera, sensor).constraints();
}

PoseCovariance covariance_of(const PoolVector<PoseConstraint>& constraints, const PosePrior& prior,
                             const Eigen::Vector3d& origin) {
  const AllInformation seen = gather(constraints, prior.about);
  Vector6 before;  // a uniform error within +- l has the variance l^2 / 3
  before << Eigen::Vector3d::Constant(3.0 / (prior.distance * prior.distance)),
      Eigen::Vector3d::Constant(3.0 / (prior.turn * prior.turn));
  const PoseCovariance others = seen.outline.H + PoseCovariance(before.asDiagonal());
  const double excess = excess_scatter(seen.planes, others);
  const Eigen::LDLT<PoseCovariance> information((seen.planes.H / excess + others).eval());
  const Vector6 step = information.solve(seen.planes.g / excess + seen.outline.g);
  const PoseCovariance about_centre = information.solve(PoseCovariance::Identity()) + step * step.transpose();
  // Of the origin: it moves by d + w x (origin - about).
  PoseCovariance T_origin_centre = PoseCovariance::Identity();
  const Eigen::Vector3d lever = origin - prior.about;
  T_origin_centre.topRightCorner<3, 3>() << 0.0, lever.z(), -lever.y(), -lever.z(), 0.0, lever.x(), lever.y(),
      -lever.x(), 0.0;
  const PoseCovariance covariance = T_origin_centre * about_centre * T_origin_centre.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

PoseCovariance pose_covariance(const CompiledModel& model, const Pose& T_sensor_model, const RangeImage& image,
                               const PinholeCamera& camera, const SensorModel& sensor) {
  PosePrior prior;
  prior.about = T_sensor_model * model.centre;
  prior.distance = model.diameter;
  return covariance_of(pose_constraints(model, T_sensor_model, image, camera, sensor), prior,
                       T_sensor_model.translation);
}

}  // namespace foresight
