#include "runtime/explained_regions.h"

#include "runtime/localization.h"

namespace foresight {

std::vector<int> explained_regions(const CompiledModel& model, const ViewingSphere& sphere, const Pose& T_sensor_model,
                                   const std::vector<DescribedRegion>& regions, const std::vector<int>& region_of_cell,
                                   const NearestDataPoint& data, const ExplanationOptions& options) {
  std::vector<double> covered(regions.size(), 0.0);
  for (const int i : visible_points(model, sphere, T_sensor_model)) {
    const TemplatePoint& point = model.surface.points[static_cast<std::size_t>(i)];
    const Eigen::Vector3d position = T_sensor_model * point.position.cast<double>();
    const NearestDataPoint::Answer nearest = data.find(position.cast<float>());
    const int label = region_of_cell[static_cast<std::size_t>(nearest.cell)];
    if (label == 0 || nearest.distance > options.match_distance) continue;
    const DescribedRegion& region = regions[static_cast<std::size_t>(label - 1)];
    // A point on an edge has faces of several normals: any of them will do.
    for (const int face : point.faces) {
      const Eigen::Vector3d normal = T_sensor_model.rotation * model.faces[static_cast<std::size_t>(face)].normal;
      if (normal.dot(region.region.normal) < options.normal_cosine) continue;
      covered[static_cast<std::size_t>(label - 1)] += model.surface.spacing * model.surface.spacing;
      break;
    }
  }
  std::vector<int> explained;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (covered[i] >= options.smallest_share * regions[i].attributes[kArea]) explained.push_back(static_cast<int>(i));
  }
  return explained;
}

}  // namespace foresight
