#include "runtime/shadow.h"

#include <algorithm>

namespace foresight {
namespace {

constexpr float kStep = 2.0F;     // on the way to the projector. Unit: cells.
constexpr float kSlowest = 1.0F;  // the way crosses cells no slower than so, or it would take steps beyond its end

}  // namespace

bool may_be_in_shadow(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, const LabelledScan& scan) {
  if (!scan.sensor.projector) return false;
  const PinholeCamera& camera = scan.camera;
  const Eigen::Vector3f way = scan.sensor.projector->cast<float>() - point;
  if (way.dot(normal) <= 0.0F) return true;
  const Eigen::Vector2f focal(static_cast<float>(camera.fx), static_cast<float>(camera.fy));
  const Eigen::Vector2f centre(static_cast<float>(camera.cx) + 0.5F, static_cast<float>(camera.cy) + 0.5F);
  const auto size = Eigen::Vector2f(static_cast<float>(camera.columns), static_cast<float>(camera.rows));
  // at = point + along * way crosses the image at speed / at.z^2 cells.
  const Eigen::Vector2f speed = focal.cwiseProduct(way.head<2>() * point.z() - point.head<2>() * way.z());
  const float step = kStep / std::max(speed.norm(), kSlowest);
  for (float along = 0.0F; along < 1.0F;) {
    const float depth = point.z() + along * way.z();
    along += step * depth * depth;
    const Eigen::Vector3f at = point + along * way;
    if (!(at.z() > scan.nearest)) return false;  // nearer than all that is seen
    const Eigen::Vector2f cell = focal.cwiseProduct(at.head<2>()) / at.z() + centre;
    if (!((cell.array() >= 0.0F).all() && (cell.array() < size.array()).all())) return true;
    const int seen = scan.image.cell(static_cast<int>(cell.y()), static_cast<int>(cell.x()));
    if (scan.depths[static_cast<std::size_t>(seen)] < at.z()) return true;
  }
  return false;
}

}  // namespace foresight
