#include "runtime/interpenetration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace foresight {
namespace {

using Eigen::Vector3d;

constexpr double kFarthestPoint = 0.87;  // from the centre of the bounding box, by the diameter: sqrt(3) / 2 at most

struct Triangle {
  Vector3d a, b, c;
};

// Solid angle under which the point sees the triangle, positive from behind it.
double solid_angle(const Vector3d& point, const Triangle& triangle) {
  const Vector3d a = triangle.a - point;
  const Vector3d b = triangle.b - point;
  const Vector3d c = triangle.c - point;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

double squared_distance_to_segment(const Vector3d& point, const Vector3d& p, const Vector3d& q) {
  const Vector3d along = q - p;
  const double length = along.squaredNorm();
  const double t = length > 0.0 ? std::clamp((point - p).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p + t * along - point).squaredNorm();
}

double squared_distance(const Vector3d& point, const Triangle& triangle) {
  const Vector3d normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
  const auto beside = [&](const Vector3d& p, const Vector3d& q) { return normal.cross(q - p).dot(point - p) < 0.0; };
  if (!beside(triangle.a, triangle.b) && !beside(triangle.b, triangle.c) && !beside(triangle.c, triangle.a)) {
    const double height = normal.dot(point - triangle.a);
    return height * height / std::max(normal.squaredNorm(), std::numeric_limits<double>::min());
  }
  return std::min({squared_distance_to_segment(point, triangle.a, triangle.b),
                   squared_distance_to_segment(point, triangle.b, triangle.c),
                   squared_distance_to_segment(point, triangle.c, triangle.a)});
}

class Solid {
 public:
  explicit Solid(const CompiledModel& model) {
    const auto vertex = [&](int index) { return model.vertices[static_cast<std::size_t>(index)].cast<double>(); };
    for (const auto& indices : model.triangles) {
      triangles_.push_back({vertex(indices[0]), vertex(indices[1]), vertex(indices[2])});
    }
    for (const Eigen::Vector3f& corner : model.vertices) box_.extend(corner.cast<double>());
  }

  [[nodiscard]] bool holds(const Vector3d& point, double depth) const {
    if (((point - box_.min()).array() < depth).any() || ((box_.max() - point).array() < depth).any()) return false;
    double angles = 0.0;
    for (const Triangle& triangle : triangles_) {
      if (squared_distance(point, triangle) < depth * depth) return false;
      angles += solid_angle(point, triangle);
    }
    return angles > 2.0 * std::numbers::pi;  // 4 pi inside, 0 outside
  }

 private:
  PoolVector<Triangle> triangles_;
  Eigen::AlignedBox3d box_;
};

}  // namespace

double share_inside(const CompiledModel& a, const Pose& T_sensor_a, const CompiledModel& b, const Pose& T_sensor_b,
                    double depth) {
  const double apart = (T_sensor_a * a.centre - T_sensor_b * b.centre).norm();
  if (a.surface.points.empty() || apart > kFarthestPoint * (a.diameter + b.diameter)) return 0.0;
  const Pose T_b_a = T_sensor_b.inverse() * T_sensor_a;
  const Solid solid(b);
  const auto inside = std::count_if(a.surface.points.begin(), a.surface.points.end(), [&](const auto& point) {
    return solid.holds(T_b_a * point.position.template cast<double>(), depth);
  });
  return static_cast<double>(inside) / static_cast<double>(a.surface.points.size());
}

}  // namespace foresight
