#include "runtime/verification.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "runtime/localization.h"

namespace foresight {
namespace {

enum class Sight : char { hidden, unmatched, matched };

// Occ(q): the data in the point's cell lie behind it, where the sensor could not have looked through the object.
// Cells without data say nothing, and neither does what lies beyond the image.
bool occludes(const Eigen::Vector3d& point, const RangeImage& image, const PinholeCamera& camera, double tolerance) {
  const int cell = camera.cell_of(point);
  return cell >= 0 && image.valid(cell) && static_cast<double>(image[cell].z()) > point.z() + tolerance;
}

// beta: of the visible neighbours of all visible points, the matched fraction. 0 when there are no neighbours.
double coherent_fraction(const SurfaceTemplate& surface, const PoolVector<int>& visible,
                         const PoolVector<Sight>& sight) {
  long neighbours = 0;
  long matched = 0;
  for (const int i : visible) {
    for (const int neighbour : surface.points[static_cast<std::size_t>(i)].neighbours) {
      const Sight seen = sight[static_cast<std::size_t>(neighbour)];
      neighbours += seen != Sight::hidden ? 1 : 0;
      matched += seen == Sight::matched ? 1 : 0;
    }
  }
  return neighbours > 0 ? static_cast<double>(matched) / static_cast<double>(neighbours) : 0.0;
}

}  // namespace

Verification verify(const CompiledModel& model, const ViewingSphere& sphere, const Pose& T_sensor_model,
                    const RangeImage& image, const PinholeCamera& camera, const NearestData& data,
                    const VerificationOptions& options) {
  assert(camera.rows == image.rows && camera.columns == image.columns);
  const PoolVector<int> visible = visible_points(model, sphere, T_sensor_model);
  Verification verification;
  verification.visible = static_cast<int>(visible.size());
  if (visible.empty()) return verification;

  // Distances up to the limit match; nearer than the next number is just that.
  const float reach = std::nextafter(static_cast<float>(options.match_distance), std::numeric_limits<float>::max());
  PoolVector<Sight> sight(model.surface.points.size(), Sight::hidden);
  int matched = 0;
  int occluding = 0;
  for (const int i : visible) {
    const auto index = static_cast<std::size_t>(i);
    const Eigen::Vector3d point = T_sensor_model * model.surface.points[index].position.cast<double>();
    const bool near = data.find_within(point.cast<float>(), reach).index >= 0;
    sight[index] = near ? Sight::matched : Sight::unmatched;
    matched += near ? 1 : 0;
    occluding += occludes(point, image, camera, options.match_distance) ? 1 : 0;
  }
  verification.matched = static_cast<double>(matched) / verification.visible;
  verification.coherent = coherent_fraction(model.surface, visible, sight);
  verification.occluding = static_cast<double>(occluding) / verification.visible;
  verification.accepted = verification.matched >= options.smallest_matched &&
                          verification.coherent >= options.smallest_coherent &&
                          verification.occluding <= options.largest_occluding;
  return verification;
}

}  // namespace foresight
