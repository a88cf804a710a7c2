#include "runtime/pose_check.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace foresight {
namespace {

constexpr double kDoubt = 30.0;           // cells against every pose, as in evidence_features
constexpr std::size_t kFewestOfFace = 4;  // samples of a face in sight, if it has as many
constexpr double kStay = 0.02;            // weight of the pose as it is, against 1 for all planes together
constexpr std::size_t kStretch = 24;      // samples after which a pose may be given up, if by then
constexpr double kHopeless = 0.6;         // of the cells looked at speak against it
constexpr double kLeastShare = 1.0 / 3.0;

void add_support(std::vector<FaceSupport>& supports, int region, int face, double cells) {
  for (FaceSupport& support : supports) {
    if (support.region != region || support.face != face) continue;
    support.cells += cells;
    return;
  }
  supports.push_back({region, face, cells});
}

}  // namespace

double PoseCheck::quality() const { return (owned - contradicted) / (total + kDoubt); }

PoseChecker::PoseChecker(const Database& database, const LabelledScan& scan, const PoseCheckOptions& options)
    : database_(database),
      scan_(scan),
      options_(options),
      least_cosine_(std::cos(scan.sensor.largest_incidence)),
      of_region_(scan.regions.size(), 0.0) {}

// Points in the middle of faces, evenly from the list of each; edge points only where a face has few others.
std::vector<PoseChecker::Sample> PoseChecker::choose_samples(const CompiledModel& model,
                                                             const std::vector<int>& faces) const {
  std::vector<Sample> chosen;
  std::size_t in_sight = 0;
  std::vector<std::vector<int>> of_face(faces.size());
  for (int edges = 0; edges < 2; ++edges) {
    for (std::size_t i = 0; i < model.surface.points.size(); ++i) {
      const TemplatePoint& point = model.surface.points[i];
      if ((point.faces.size() > 1) != (edges == 1)) continue;
      for (const int face : point.faces) {
        const auto at = std::lower_bound(faces.begin(), faces.end(), face);
        if (at == faces.end() || *at != face) continue;
        std::vector<int>& points = of_face[static_cast<std::size_t>(at - faces.begin())];
        if (edges == 1 && points.size() >= kFewestOfFace) continue;
        points.push_back(static_cast<int>(i));
        ++in_sight;
      }
    }
  }
  const double keep =
      std::min(1.0, static_cast<double>(options_.samples) / static_cast<double>(std::max<std::size_t>(1, in_sight)));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::vector<int>& points = of_face[f];
    const auto wanted = static_cast<std::size_t>(std::lround(keep * static_cast<double>(points.size())));
    const std::size_t count = std::min(points.size(), std::max(wanted, kFewestOfFace));
    const auto area = static_cast<float>(model.faces[static_cast<std::size_t>(faces[f])].area /
                                         static_cast<double>(std::max<std::size_t>(1, count)));
    for (std::size_t k = 0; k < count; ++k) {
      const auto point = static_cast<std::size_t>(points[(2 * k + 1) * points.size() / (2 * count)]);
      chosen.push_back({model.surface.points[point].position, faces[f], area});
    }
  }
  // Every stretch of the list looks at all faces, so that a hopeless pose shows soon.
  std::vector<Sample> spread;
  spread.reserve(chosen.size());
  const std::size_t stretches = (chosen.size() + kStretch - 1) / kStretch;
  for (std::size_t first = 0; first < stretches; ++first) {
    for (std::size_t i = first; i < chosen.size(); i += stretches) spread.push_back(chosen[i]);
  }
  return spread;
}

const std::vector<PoseChecker::Sample>& PoseChecker::samples_of(int model, int aspect) {
  const auto [at, added] = samples_.try_emplace({model, aspect});
  if (added) {
    const CompiledModel& compiled = database_.models()[static_cast<std::size_t>(model)];
    at->second = choose_samples(compiled, compiled.surface.aspects[static_cast<std::size_t>(aspect)]);
  }
  return at->second;
}

PoseCheck PoseChecker::check(int model, const Pose& T_sensor_model) {
  PoseCheck check;
  const CompiledModel& compiled = database_.models()[static_cast<std::size_t>(model)];
  const Eigen::Vector3d to_sensor = -(T_sensor_model.rotation.transpose() * (T_sensor_model * compiled.centre));
  if (!(to_sensor.norm() > 0.0)) return check;
  const PinholeCamera& camera = scan_.camera;
  std::size_t looked_at = 0;
  for (const Sample& sample : samples_of(model, sphere_.cell_of(to_sensor.normalized()))) {
    if (looked_at++ % kStretch == 0 && check.contradicted > kHopeless * check.total) break;
    const Eigen::Vector3d point = T_sensor_model * sample.position.cast<double>();
    if (!(point.z() > 0.0)) continue;
    const Eigen::Vector3d ray = point / point.z();
    const Eigen::Vector3d normal =
        T_sensor_model.rotation * compiled.faces[static_cast<std::size_t>(sample.face)].normal;
    const double facing = -normal.dot(ray);
    if (facing <= least_cosine_ * ray.norm()) continue;
    const double cells = static_cast<double>(sample.area) * facing * camera.fx * camera.fy / (point.z() * point.z());
    check.total += cells;
    const int cell = camera.cell_of(point);
    if (cell < 0 || !scan_.image.valid(cell)) continue;
    const double across = (static_cast<double>(scan_.image[cell].z()) - point.z()) * facing;
    if (across < -options_.distance) {
      check.hidden += cells;
      continue;
    }
    if (across > options_.distance) {
      check.contradicted += cells;
      continue;
    }
    if (scan_.taken[static_cast<std::size_t>(cell)]) {
      check.contradicted += cells;
      continue;
    }
    const int region = scan_.labels[static_cast<std::size_t>(cell)] - 1;
    if (region < 0) {
      check.explained += cells;
      check.owned += cells;
      continue;
    }
    const auto r = static_cast<std::size_t>(region);
    if (scan_.regions[r].region.normal.dot(normal) < options_.normal_cosine) {
      check.contradicted += cells;
      continue;
    }
    check.explained += cells;
    add_support(check.supports, region, sample.face, cells);
    of_region_[r] += cells;
  }
  for (const FaceSupport& support : check.supports) {
    double& explained = of_region_[static_cast<std::size_t>(support.region)];
    if (!(explained > 0.0)) continue;
    const double cells = std::max(1, scan_.free_cells[static_cast<std::size_t>(support.region)]);
    check.owned += explained * std::min(1.0, explained / cells);
    explained = 0.0;
  }
  return check;
}

Pose refit_to_planes(const CompiledModel& model, const Pose& T_sensor_model, const PoseCheck& check,
                     const std::vector<DescribedRegion>& regions) {
  struct PlanePair {
    const Region* region;
    const ModelFace* face;
    double weight;
  };
  std::vector<PlanePair> planes;
  double weights = 0.0;
  for (const FaceSupport& support : check.supports) {
    const Region& region = regions[static_cast<std::size_t>(support.region)].region;
    if (support.cells < kLeastShare * static_cast<double>(region.cells.size())) continue;
    planes.push_back({&region, &model.faces[static_cast<std::size_t>(support.face)], support.cells});
    weights += planes.back().weight;
  }
  if (planes.empty()) return T_sensor_model;
  Eigen::Matrix3d correlation = kStay * T_sensor_model.rotation;
  for (const PlanePair& plane : planes) {
    correlation += plane.weight / weights * plane.region->normal * plane.face->normal.transpose();
  }
  Pose pose;
  pose.rotation = nearest_rotation(correlation);
  const Eigen::Vector3d stay = T_sensor_model * model.centre - pose.rotation * model.centre;
  Eigen::Matrix3d normals = kStay * Eigen::Matrix3d::Identity();
  Eigen::Vector3d offsets = kStay * stay;
  for (const PlanePair& plane : planes) {
    const Eigen::Vector3d& normal = plane.region->normal;
    const double offset = plane.region->offset - normal.dot(pose.rotation * plane.face->centroid);
    normals += plane.weight / weights * normal * normal.transpose();
    offsets += plane.weight / weights * normal * offset;
  }
  pose.translation = normals.inverse() * offsets;
  return pose;
}

}  // namespace foresight
