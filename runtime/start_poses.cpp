#include "runtime/start_poses.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/pose_from_matches.h"

namespace foresight {
namespace {

constexpr double kLeastVolume = 0.1;  // of the parallelepiped of three unit normals
constexpr double kSameEnd = 3.0;      // shifts nearer than this are one start. Unit: mm.
constexpr double kReach = 6.0;        // a region may seem to reach this far beyond its face, and
constexpr double kReachShare = 0.08;  // this share of the face. Unit: mm, 1.

struct Interval {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] double length() const { return high - low; }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

template <typename Points>
Interval extent(const Points& points, const Eigen::Vector3d& direction) {
  Interval interval;
  for (const Eigen::Vector3d& point : points) interval.add(direction.dot(point));
  return interval;
}

Interval posed_extent(const PoolVector<Eigen::Vector3d>& points, const Pose& pose, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d turned = pose.rotation.transpose() * direction;
  Interval interval = extent(points, turned);
  const double shift = direction.dot(pose.translation);
  return {interval.low + shift, interval.high + shift};
}

// Directions of the hull's sides; hulls given as any points yield all that matter through their extreme ones.
PoolVector<Eigen::Vector3d> side_directions(const PoolVector<Eigen::Vector3d>& points, const Eigen::Vector3d& normal) {
  // Gift wrapping in the plane: few points, and exact ones need no sorting.
  PoolVector<Eigen::Vector3d> directions;
  const Eigen::Vector3d helper = std::abs(normal.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d u = normal.cross(helper).normalized();
  std::size_t start = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (u.dot(points[i]) < u.dot(points[start])) start = i;
  }
  std::size_t at = start;
  for (std::size_t sides = 0; sides < points.size(); ++sides) {
    std::size_t next = at == 0 ? 1 % points.size() : 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == at) continue;
      const Eigen::Vector3d to_next = points[next] - points[at];
      const Eigen::Vector3d to_i = points[i] - points[at];
      const double turn = normal.dot(to_next.cross(to_i));
      if (turn < 0.0 || (turn == 0.0 && to_i.squaredNorm() > to_next.squaredNorm())) next = i;
    }
    const Eigen::Vector3d side = points[next] - points[at];
    if (side.norm() > 0.0) directions.push_back(side.normalized());
    at = next;
    if (at == start) break;
  }
  return directions;
}

// The pose that takes a face's frame to a region's; `axis` is where the face's axis points, `from` comes to lie on
// `to`.
Pose laid(const PatchFrame& face, const Eigen::Vector3d& face_axis, const Eigen::Vector3d& normal,
          const Eigen::Vector3d& axis, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Matrix3d model_axes;
  model_axes << face_axis, face.normal.cross(face_axis), face.normal;
  Eigen::Matrix3d sensor_axes;
  sensor_axes << axis, normal.cross(axis), normal;
  Pose pose;
  pose.rotation = sensor_axes * model_axes.transpose();
  pose.translation = to - pose.rotation * from;
  return pose;
}

// Of triangles of one plane, about their common centroid.
Eigen::Vector3d larger_second_moment(const CompiledModel& model, int face) {
  const ModelFace& model_face = model.faces[static_cast<std::size_t>(face)];
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    if (model.triangle_faces[t] != face) continue;
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(model.triangles[t][k]);
      corners[k] = model.vertices[vertex].cast<double>() - model_face.centroid;
    }
    const double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    const Eigen::Vector3d sum = corners[0] + corners[1] + corners[2];
    moments += area * sum * sum.transpose();
    for (const Eigen::Vector3d& corner : corners) moments += area * corner * corner.transpose();
  }
  const Eigen::Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(2);
  return (axis - model_face.normal * model_face.normal.dot(axis)).normalized();
}

bool fits_in(double region, double face) { return region <= face + std::max(kReach, kReachShare * face); }
bool same_length(double region, double face) { return fits_in(region, face) && fits_in(face, region); }

Eigen::Vector3d corner(const PatchFrame& frame, const Eigen::Vector3d& axis, double along, double across) {
  return frame.centre + 0.5 * along * axis + 0.5 * across * frame.normal.cross(axis);
}

}  // namespace

PatchFrame smallest_rectangle(const PoolVector<Eigen::Vector3d>& points, const Eigen::Vector3d& normal) {
  PatchFrame frame;
  frame.normal = normal;
  frame.centre = points.front();
  const Eigen::Vector3d helper = std::abs(normal.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  frame.axis = normal.cross(helper).normalized();
  double least_area = std::numeric_limits<double>::max();
  const double level = normal.dot(points.front());
  for (const Eigen::Vector3d& side : side_directions(points, normal)) {
    const Eigen::Vector3d along = (side - normal * normal.dot(side)).normalized();
    const Eigen::Vector3d across = normal.cross(along);
    const Interval a = extent(points, along);
    const Interval b = extent(points, across);
    if (!(a.length() * b.length() < least_area)) continue;
    least_area = a.length() * b.length();
    frame.centre = level * normal + a.middle() * along + b.middle() * across;
    const bool longer = a.length() >= b.length();
    frame.axis = longer ? along : across;
    frame.extents = longer ? std::array{a.length(), b.length()} : std::array{b.length(), a.length()};
  }
  return frame;
}

FaceShapes::FaceShapes(const Database& database) {
  for (const CompiledModel& model : database.models()) {
    PoolVector<Shape>& shapes = shapes_.emplace_back(model.faces.size());
    PoolVector<PoolVector<int>> indices(model.faces.size());
    for (std::size_t t = 0; t < model.triangle_faces.size(); ++t) {
      auto& of_face = indices[static_cast<std::size_t>(model.triangle_faces[t])];
      of_face.insert(of_face.end(), model.triangles[t].begin(), model.triangles[t].end());
    }
    for (std::size_t f = 0; f < shapes.size(); ++f) {
      std::sort(indices[f].begin(), indices[f].end());
      indices[f].erase(std::unique(indices[f].begin(), indices[f].end()), indices[f].end());
      for (const int i : indices[f])
        shapes[f].vertices.push_back(model.vertices[static_cast<std::size_t>(i)].cast<double>());
      if (!shapes[f].vertices.empty()) shapes[f].frame = smallest_rectangle(shapes[f].vertices, model.faces[f].normal);
      if (!shapes[f].vertices.empty()) shapes[f].major_axis = larger_second_moment(model, static_cast<int>(f));
    }
  }
}

const FaceShapes::Shape& FaceShapes::shape(int model, int face) const {
  return shapes_[static_cast<std::size_t>(model)][static_cast<std::size_t>(face)];
}
const PoolVector<Eigen::Vector3d>& FaceShapes::vertices(int model, int face) const {
  return shape(model, face).vertices;
}
const PatchFrame& FaceShapes::frame(int model, int face) const { return shape(model, face).frame; }
const Eigen::Vector3d& FaceShapes::major_axis(int model, int face) const { return shape(model, face).major_axis; }

ScanRegions frame_regions(const PoolVector<DescribedRegion>& regions) {
  ScanRegions scan{regions, {}};
  for (const DescribedRegion& region : regions)
    scan.frames.push_back(smallest_rectangle(region.hull, region.region.normal));
  return scan;
}

PoolVector<Pose> pair_starts(const Database& database, const FaceShapes& shapes, const ScanRegions& scan,
                             const MatchPair& pair) {
  const CompiledModel& model = database.models()[static_cast<std::size_t>(pair.a.model)];
  const auto region_of = [&](const RatedMatch& match) { return &scan.regions[static_cast<std::size_t>(match.region)]; };
  const auto face_of = [&](const RatedMatch& match) { return &model.faces[static_cast<std::size_t>(match.face)]; };
  const std::array<RegionFaceMatch, 2> matches = {
      {{region_of(pair.a), face_of(pair.a)}, {region_of(pair.b), face_of(pair.b)}}};
  const std::optional<Pose> base = pose_from_matches(matches);
  if (!base) return {};
  PoolVector<Pose> starts = {*base};
  const Eigen::Vector3d line = matches[0].region->region.normal.cross(matches[1].region->region.normal);
  if (line.norm() < 0.17) return starts;  // as pose_from_matches: parallel normals leave more free than one line
  const Eigen::Vector3d free = line.normalized();
  PoolVector<double> shifts = {0.0};
  const auto add = [&](double shift) {
    for (const double known : shifts) {
      if (std::abs(known - shift) < kSameEnd) return;
    }
    shifts.push_back(shift);
    starts.push_back({base->rotation, base->translation + shift * free});
  };
  for (const RatedMatch& match : {pair.a, pair.b}) {
    const Interval seen = extent(region_of(match)->hull, free);
    const Interval whole = posed_extent(shapes.vertices(match.model, match.face), *base, free);
    if (!fits_in(seen.length(), whole.length())) return {};
    add(seen.low - whole.low);
    add(seen.high - whole.high);
  }
  return starts;
}

bool same_handed(double of_regions, double of_faces) {
  return std::min(std::abs(of_regions), std::abs(of_faces)) >= kLeastVolume && (of_regions > 0.0) == (of_faces > 0.0);
}

PoolVector<Pose> single_starts(const Database& database, const FaceShapes& shapes, const ScanRegions& scan,
                               const RatedMatch& match, bool cut) {
  const DescribedRegion& region = scan.regions[static_cast<std::size_t>(match.region)];
  const PatchFrame& seen = scan.frames[static_cast<std::size_t>(match.region)];
  const PatchFrame& face = shapes.frame(match.model, match.face);
  const ModelFace& model_face =
      database.models()[static_cast<std::size_t>(match.model)].faces[static_cast<std::size_t>(match.face)];
  PoolVector<Pose> starts;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double sign = quarter < 2 ? 1.0 : -1.0;
    const bool turned = quarter % 2 == 1;
    const Eigen::Vector3d axis = sign * (turned ? Eigen::Vector3d(seen.normal.cross(seen.axis)) : seen.axis);
    const double along = turned ? seen.extents[1] : seen.extents[0];
    const double across = turned ? seen.extents[0] : seen.extents[1];
    if (!fits_in(along, face.extents[0]) || !fits_in(across, face.extents[1])) continue;
    const bool same_along = same_length(along, face.extents[0]);
    const bool same_across = same_length(across, face.extents[1]);
    if (same_along && same_across) {
      starts.push_back(laid(face, face.axis, seen.normal, axis, face.centre, seen.centre));
      continue;
    }
    if (!cut) continue;
    for (const double a : {-1.0, 1.0}) {
      if (same_along && a > 0.0) continue;  // both ends coincide
      for (const double b : {-1.0, 1.0}) {
        if (same_across && b > 0.0) continue;
        starts.push_back(laid(face, face.axis, seen.normal, axis,
                              corner(face, face.axis, a * face.extents[0], b * face.extents[1]),
                              corner(seen, axis, a * along, b * across)));
      }
    }
  }
  if (cut) return starts;
  for (const double sign : {1.0, -1.0}) {
    starts.push_back(laid(face, shapes.major_axis(match.model, match.face), seen.normal, sign * region.major_axis,
                          model_face.centroid, region.centroid));
  }
  return starts;
}

}  // namespace foresight
