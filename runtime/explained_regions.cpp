#include "runtime/explained_regions.h"

#include <algorithm>

namespace foresight {
namespace {

// A template point in the sensor frame, with the normals of its faces (an edge point has several).
struct PosedPoint {
  Eigen::Vector3d position;
  PoolVector<Eigen::Vector3d> normals;
};

PoolVector<PosedPoint> posed_points(const CompiledModel& model, const Pose& T_sensor_model) {
  PoolVector<PosedPoint> posed;
  for (const TemplatePoint& point : model.surface.points) {
    PosedPoint& added = posed.emplace_back();
    added.position = T_sensor_model * point.position.cast<double>();
    for (const int face : point.faces) {
      added.normals.push_back(T_sensor_model.rotation * model.faces[static_cast<std::size_t>(face)].normal);
    }
  }
  return posed;
}

PoolVector<Eigen::Vector3d> agreeing_points(const PoolVector<PosedPoint>& points, const Eigen::Vector3d& normal,
                                            double cosine) {
  PoolVector<Eigen::Vector3d> agreeing;
  for (const PosedPoint& point : points) {
    if (std::any_of(point.normals.begin(), point.normals.end(),
                    [&](const auto& n) { return n.dot(normal) >= cosine; })) {
      agreeing.push_back(point.position);
    }
  }
  return agreeing;
}

double explained_share(const Region& region, const RangeImage& image, const PoolVector<Eigen::Vector3d>& points,
                       double reach, int most_samples) {
  const std::size_t step = std::max<std::size_t>(1, region.cells.size() / static_cast<std::size_t>(most_samples));
  int looked_at = 0;
  int explained = 0;
  for (std::size_t i = 0; i < region.cells.size(); i += step) {
    const Eigen::Vector3d data = image[region.cells[i]].cast<double>();
    ++looked_at;
    explained += std::any_of(points.begin(), points.end(),
                             [&](const auto& p) { return (p - data).squaredNorm() <= reach * reach; });
  }
  return static_cast<double>(explained) / looked_at;
}

}  // namespace

PoolVector<int> explained_regions(const CompiledModel& model, const Pose& T_sensor_model, const RangeImage& image,
                                  const PoolVector<DescribedRegion>& regions, const ExplanationOptions& options) {
  const PoolVector<PosedPoint> points = posed_points(model, T_sensor_model);
  // A point of the surface lies within one spacing of a template point.
  const double reach = options.match_distance + model.surface.spacing;
  PoolVector<int> explained;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const auto agreeing = agreeing_points(points, regions[i].region.normal, options.normal_cosine);
    if (explained_share(regions[i].region, image, agreeing, reach, options.most_samples) >= options.smallest_share) {
      explained.push_back(static_cast<int>(i));
    }
  }
  return explained;
}

}  // namespace foresight
