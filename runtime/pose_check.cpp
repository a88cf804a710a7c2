#include "runtime/pose_check.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace foresight {
namespace {

constexpr double kDoubt = 30.0;           // cells against every pose, as in evidence_features
constexpr std::size_t kFewestOfFace = 4;  // samples of a face in sight, if it has as many
constexpr double kStay = 0.02;            // weight of the pose as it is, against 1 for all planes together
constexpr std::size_t kStretch = 16;      // samples after which a pose may be given up, if by then
constexpr double kHopeless = 0.6;         // of the cells looked at speak against it
constexpr double kDoubtOfOne = 1.0;       // by which one sample may mislead about all
constexpr double kLeastShare = 1.0 / 3.0;

void add_support(PoolVector<FaceSupport>& supports, int region, int face, double cells) {
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
      squared_least_cosine_(static_cast<float>(std::pow(std::cos(scan.sensor.largest_incidence), 2))),
      points_(database.models().size()),
      of_region_(scan.regions.size(), 0.0) {}

const PoolVector<PoseChecker::FacePoints>& PoseChecker::points_of(int model) {
  const CompiledModel& compiled = database_.models()[static_cast<std::size_t>(model)];
  PoolVector<FacePoints>& points = points_[static_cast<std::size_t>(model)];
  if (!points.empty()) return points;
  points.resize(compiled.faces.size());
  for (std::size_t i = 0; i < compiled.surface.points.size(); ++i) {
    const std::vector<int>& faces = compiled.surface.points[i].faces;
    for (const int face : faces) {
      FacePoints& of_face = points[static_cast<std::size_t>(face)];
      (faces.size() > 1 ? of_face.edge : of_face.middle).push_back(static_cast<int>(i));
    }
  }
  return points;
}

// Points in the middle of faces, evenly from the list of each; edge points only where a face has few others.
PoolVector<PoseChecker::Sample> PoseChecker::choose_samples(int index, const std::vector<int>& faces) {
  const CompiledModel& model = database_.models()[static_cast<std::size_t>(index)];
  PoolVector<Sample> chosen;
  std::size_t in_sight = 0;
  PoolVector<PoolVector<int>> of_face;
  for (const int face : faces) {
    const FacePoints& all = points_of(index)[static_cast<std::size_t>(face)];
    PoolVector<int>& points = of_face.emplace_back(all.middle);
    const std::size_t missing = points.size() < kFewestOfFace ? kFewestOfFace - points.size() : 0;
    const auto edges = static_cast<std::ptrdiff_t>(std::min(missing, all.edge.size()));
    points.insert(points.end(), all.edge.begin(), all.edge.begin() + edges);
    in_sight += points.size();
  }
  const double keep =
      std::min(1.0, static_cast<double>(options_.samples) / static_cast<double>(std::max<std::size_t>(1, in_sight)));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const PoolVector<int>& points = of_face[f];
    const auto wanted = static_cast<std::size_t>(std::lround(keep * static_cast<double>(points.size())));
    const std::size_t count = std::min(points.size(), std::max(wanted, kFewestOfFace));
    const auto area = static_cast<float>(model.faces[static_cast<std::size_t>(faces[f])].area /
                                         static_cast<double>(std::max<std::size_t>(1, count)));
    for (std::size_t k = 0; k < count; ++k) {
      const auto point = static_cast<std::size_t>(points[(2 * k + 1) * points.size() / (2 * count)]);
      chosen.push_back({model.surface.points[point].position, static_cast<int>(f), area});
    }
  }
  // Every stretch of the list looks at all faces, so that a hopeless pose shows soon.
  PoolVector<Sample> spread;
  spread.reserve(chosen.size());
  const std::size_t stretches = (chosen.size() + kStretch - 1) / kStretch;
  for (std::size_t first = 0; first < stretches; ++first) {
    for (std::size_t i = first; i < chosen.size(); i += stretches) spread.push_back(chosen[i]);
  }
  return spread;
}

const PoolVector<PoseChecker::Sample>& PoseChecker::samples_of(int model, int aspect) {
  const auto [at, added] = samples_.try_emplace({model, aspect});
  if (added) {
    const SurfaceTemplate& surface = database_.models()[static_cast<std::size_t>(model)].surface;
    at->second = choose_samples(model, surface.aspects[static_cast<std::size_t>(aspect)]);
  }
  return at->second;
}

void PoseChecker::pose_faces(const CompiledModel& model, const std::vector<int>& faces, const Pose& T_sensor_model) {
  posed_.clear();
  for (const int index : faces) {
    const ModelFace& face = model.faces[static_cast<std::size_t>(index)];
    const Eigen::Vector3d normal = T_sensor_model.rotation * face.normal;
    posed_.push_back({normal.cast<float>(), static_cast<float>(-normal.dot(T_sensor_model.translation) - face.offset)});
  }
}

// A ray with z = 1 meets a face under -normal . ray = height / z: the point lies on the face's plane.
void PoseChecker::look_at(const Sample& sample, const Eigen::Vector3f& point, int face, PoseCheck& check) {
  const PosedFace& posed = posed_[static_cast<std::size_t>(sample.face)];
  if (!(point.z() > 0.0F) || !(posed.height > 0.0F)) return;
  if (posed.height * posed.height <= squared_least_cosine_ * point.squaredNorm()) return;
  const PinholeCamera& camera = scan_.camera;
  const float scale = 1.0F / point.z();
  const float facing = posed.height * scale;
  const auto focals = static_cast<float>(camera.fx * camera.fy);
  const double cells = sample.area * facing * focals * scale * scale;
  check.total += cells;
  const float column = static_cast<float>(camera.fx) * point.x() * scale + static_cast<float>(camera.cx) + 0.5F;
  const float row = static_cast<float>(camera.fy) * point.y() * scale + static_cast<float>(camera.cy) + 0.5F;
  if (!(column >= 0.0F && row >= 0.0F && column < static_cast<float>(camera.columns) &&
        row < static_cast<float>(camera.rows)))
    return;
  const int cell = scan_.image.cell(static_cast<int>(row), static_cast<int>(column));
  const float across = (scan_.depths[static_cast<std::size_t>(cell)] - point.z()) * facing;
  const auto distance = static_cast<float>(options_.distance);
  if (std::isnan(across)) return;  // no data
  if (across < -distance) {
    check.hidden += cells;
    return;
  }
  const int region = scan_.labels[static_cast<std::size_t>(cell)] - 1;
  const auto tilted = [&] {
    const Eigen::Vector3d& normal = scan_.regions[static_cast<std::size_t>(region)].region.normal;
    return normal.cast<float>().dot(posed.normal) < static_cast<float>(options_.normal_cosine);
  };
  if (across > distance || scan_.taken[static_cast<std::size_t>(cell)] || (region >= 0 && tilted())) {
    check.contradicted += cells;
    return;
  }
  check.explained += cells;
  if (region < 0) {
    check.owned += cells;
    return;
  }
  add_support(check.supports, region, face, cells);
  of_region_[static_cast<std::size_t>(region)] += cells;
}

PoseCheck PoseChecker::check(int model, const Pose& T_sensor_model, double least_quality) {
  PoseCheck check;
  const CompiledModel& compiled = database_.models()[static_cast<std::size_t>(model)];
  const Eigen::Vector3d to_sensor = -(T_sensor_model.rotation.transpose() * (T_sensor_model * compiled.centre));
  if (!(to_sensor.norm() > 0.0)) return check;
  const int aspect = sphere_.cell_of(to_sensor.normalized());
  const std::vector<int>& faces = compiled.surface.aspects[static_cast<std::size_t>(aspect)];
  pose_faces(compiled, faces, T_sensor_model);
  const Eigen::Matrix3f rotation = T_sensor_model.rotation.cast<float>();
  const Eigen::Vector3f translation = T_sensor_model.translation.cast<float>();
  std::size_t looked_at = 0;
  for (const Sample& sample : samples_of(model, aspect)) {
    if (looked_at++ % kStretch == 0 && looked_at > 1) {
      // What the samples so far leave to hope for: they are a few of all, evenly spread.
      const double doubt = kDoubtOfOne / std::sqrt(static_cast<double>(looked_at - 1));
      if (check.explained - check.contradicted < (least_quality - doubt) * check.total) break;
      if (check.contradicted > kHopeless * check.total) break;
    }
    look_at(sample, rotation * sample.position + translation, faces[static_cast<std::size_t>(sample.face)], check);
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
                     const PoolVector<DescribedRegion>& regions) {
  struct PlanePair {
    const Region* region;
    const ModelFace* face;
    double weight;
  };
  PoolVector<PlanePair> planes;
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
