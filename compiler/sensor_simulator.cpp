#include "compiler/sensor_simulator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "compiler/embree.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceOwner = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using SceneOwner = std::unique_ptr<RTCSceneTy, ReleaseScene>;

// A triangle in the sensor frame. Embree keeps floats; depths are computed from these.
struct SceneTriangle {
  std::array<Vector3d, 3> corners;
  Vector3d normal;
  CellLabel label;
};

// A point origin + t * direction on a surface.
struct SurfaceHit {
  double t = 0.0;
  Vector3d normal = Vector3d::Zero();  // outward
  CellLabel label;
};

std::vector<SceneTriangle> triangles_of(std::span<const PlacedObject> objects) {
  std::vector<SceneTriangle> triangles;
  for (std::size_t object = 0; object < objects.size(); ++object) {
    const CadModel& model = *objects[object].model;
    assert(model.triangle_face.size() == model.triangles.size());
    for (std::size_t i = 0; i < model.triangles.size(); ++i) {
      SceneTriangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto vertex = static_cast<std::size_t>(model.triangles[i][k]);
        triangle.corners[k] = objects[object].T_sensor_model * model.vertices[vertex];
      }
      const auto& [a, b, c] = triangle.corners;
      triangle.normal = (b - a).cross(c - a).normalized();
      triangle.label = {static_cast<int>(object), model.triangle_face[i]};
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

// The rows and columns in which rays from the camera may meet the triangles: one cell more on each side than these
// project to, for Embree's floats. All where a corner is not before the camera. Most rays of a view pass by.
Eigen::AlignedBox2d image_of(const std::vector<SceneTriangle>& triangles, const PinholeCamera& camera) {
  Eigen::AlignedBox2d cells;
  for (const SceneTriangle& triangle : triangles) {
    for (const Vector3d& corner : triangle.corners) {
      if (!(corner.z() > 0.0)) return {Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(camera.columns, camera.rows)};
      cells.extend(camera.project(corner));
    }
  }
  if (cells.isEmpty()) return cells;
  return {cells.min() - Eigen::Vector2d::Ones(), cells.max() + Eigen::Vector2d::Ones()};
}

RTCRay make_ray(const Vector3d& origin, const Vector3d& direction, float farthest) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = 0.0F;
  ray.tfar = farthest;
  ray.mask = std::numeric_limits<unsigned>::max();
  return ray;
}

// Where a ray that Embree found to hit a triangle meets its plane, in double precision: a float depth at 900 mm is only
// good to some 1e-4 mm. The triangle's own extent along the ray bounds it, for planes seen edge on.
double depth_on(const SceneTriangle& triangle, const Vector3d& origin, const Vector3d& direction, float float_depth) {
  const double slope = triangle.normal.dot(direction);
  if (slope == 0.0) return static_cast<double>(float_depth);
  const double square = direction.squaredNorm();
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = -nearest;
  for (const Vector3d& corner : triangle.corners) {
    const double along = (corner - origin).dot(direction) / square;
    nearest = std::min(nearest, along);
    farthest = std::max(farthest, along);
  }
  return std::clamp(triangle.normal.dot(triangle.corners[0] - origin) / slope, nearest, farthest);
}

// What Embree's float arithmetic may be off by at a point this far from the origin, with a factor of ten in hand.
double float_margin(const Vector3d& point) { return std::max(1e-3, 2e-6 * point.norm()); }

double quantized(double z, double step) { return step > 0.0 ? std::round(z / step) * step : z; }

// Sums over windows of the image in constant time each.
class WindowSums {
 public:
  WindowSums(const std::vector<double>& values, int rows, int columns)
      : rows_(rows), columns_(columns), sums_(static_cast<std::size_t>((rows + 1) * (columns + 1)), 0.0) {
    for (int row = 0; row < rows; ++row) {
      double of_row = 0.0;
      for (int column = 0; column < columns; ++column) {
        of_row += values[static_cast<std::size_t>(row * columns + column)];
        sums_[at(row + 1, column + 1)] = sums_[at(row, column + 1)] + of_row;
      }
    }
  }
  // Of the cells inside the image among those at most `reach` rows and columns away.
  [[nodiscard]] double around(int row, int column, int reach) const {
    const int top = std::max(0, row - reach);
    const int left = std::max(0, column - reach);
    const int bottom = std::min(rows_, row + reach + 1);
    const int right = std::min(columns_, column + reach + 1);
    return sums_[at(bottom, right)] - sums_[at(top, right)] - sums_[at(bottom, left)] + sums_[at(top, left)];
  }

 private:
  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row * (columns_ + 1) + column);
  }
  int rows_, columns_;
  std::vector<double> sums_;  // of all cells above and to the left of a grid point
};

// What a sensor that matches windows makes of exact depths (0 = no data) and of white noise of deviation 1: means over
// the data of a window, of 1 / z, which such a sensor measures and of which planes stay planes; and noise of the same
// deviation that neighbouring cells share.
void match_windows(const SensorModel& sensor, std::vector<double>& depths, std::vector<double>& noise) {
  const PinholeCamera& camera = sensor.camera;
  const int reach = sensor.matching_window / 2;
  std::vector<double> inverse(depths.size(), 0.0);
  std::vector<double> has_data(depths.size(), 0.0);
  for (std::size_t cell = 0; cell < depths.size(); ++cell) {
    if (!(depths[cell] > 0.0)) continue;
    inverse[cell] = 1.0 / depths[cell];
    has_data[cell] = 1.0;
  }
  const WindowSums inverses(inverse, camera.rows, camera.columns);
  const WindowSums data(has_data, camera.rows, camera.columns);
  const WindowSums white(noise, camera.rows, camera.columns);
  const WindowSums cells(std::vector<double>(depths.size(), 1.0), camera.rows, camera.columns);
  for (int row = 0; row < camera.rows; ++row) {
    for (int column = 0; column < camera.columns; ++column) {
      const auto cell = static_cast<std::size_t>(row * camera.columns + column);
      noise[cell] = white.around(row, column, reach) / std::sqrt(cells.around(row, column, reach));
      if (depths[cell] > 0.0) depths[cell] = data.around(row, column, reach) / inverses.around(row, column, reach);
    }
  }
}

}  // namespace

struct SimulatedScene::Impl {
  std::vector<SceneTriangle> triangles;
  std::vector<BackgroundPlane> planes;
  std::string fault;  // Embree's first complaint
  DeviceOwner device;
  SceneOwner scene;

  void build();
  void attach_triangles();
  // among_objects: whether the ray may meet any.
  [[nodiscard]] std::optional<SurfaceHit> nearest(const Vector3d& origin, const Vector3d& direction,
                                                  bool among_objects = true) const;
  [[nodiscard]] bool blocked(const Vector3d& start, const Vector3d& end) const;
  [[nodiscard]] bool gives_data(const SurfaceHit& hit, const Vector3d& ray, const SensorModel& sensor) const;
};

void SimulatedScene::Impl::build() {
  // A device of its own: nothing is shared between scenes, and it costs less than a tenth of a scan.
  const std::string isa = ray_isa();
  const std::string settings = isa == "default" ? "threads=1" : "threads=1,isa=" + isa;
  device.reset(rtcNewDevice(settings.c_str()));
  if (!device) throw std::runtime_error("Embree cannot start with " + settings);
  const auto complain = [](void* text, RTCError, const char* message) {
    auto& first = *static_cast<std::string*>(text);
    if (first.empty()) first = message;
  };
  rtcSetDeviceErrorFunction(device.get(), complain, &fault);
  scene.reset(rtcNewScene(device.get()));
  // Robust: no ray slips between two triangles that share an edge.
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  if (!triangles.empty()) attach_triangles();
  rtcCommitScene(scene.get());
  if (!fault.empty()) throw std::runtime_error("Embree: " + fault);
}

void SimulatedScene::Impl::attach_triangles() {
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), 3 * triangles.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), triangles.size()));
  if (vertices == nullptr || indices == nullptr) throw std::runtime_error("Embree: " + fault);
  unsigned next = 0;
  for (const SceneTriangle& triangle : triangles) {
    for (const Vector3d& corner : triangle.corners) {
      for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(corner[axis]);
      *indices++ = next++;
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
}

std::optional<SurfaceHit> SimulatedScene::Impl::nearest(const Vector3d& origin, const Vector3d& direction,
                                                        bool among_objects) const {
  RTCRayHit query{};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  if (among_objects) {
    query.ray = make_ray(origin, direction, std::numeric_limits<float>::infinity());
    embree::intersect(scene.get(), query);
  }
  std::optional<SurfaceHit> best;
  if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
    const SceneTriangle& triangle = triangles[query.hit.primID];
    best = SurfaceHit{depth_on(triangle, origin, direction, query.ray.tfar), triangle.normal, triangle.label};
  }
  for (const BackgroundPlane& plane : planes) {
    const double slope = plane.normal.dot(direction);
    if (slope == 0.0) continue;
    const double t = (plane.offset - plane.normal.dot(origin)) / slope;
    // A plane has no inside: it faces whoever looks at it.
    const Vector3d normal = slope < 0.0 ? plane.normal : Vector3d(-plane.normal);
    if (t > 0.0 && (!best || t < best->t)) best = SurfaceHit{t, normal, CellLabel{}};
  }
  return best;
}

bool SimulatedScene::Impl::blocked(const Vector3d& start, const Vector3d& end) const {
  for (const BackgroundPlane& plane : planes) {
    if ((plane.normal.dot(start) - plane.offset) * (plane.normal.dot(end) - plane.offset) < 0.0) return true;
  }
  RTCRay ray = make_ray(start, end - start, 1.0F);
  embree::occlude(scene.get(), ray);
  return ray.tfar < 0.0F;
}

bool SimulatedScene::Impl::gives_data(const SurfaceHit& hit, const Vector3d& ray, const SensorModel& sensor) const {
  // Rays have z = 1, so t is the depth. Nothing is expected to be measured far outside the working range.
  if (hit.t < 0.5 * sensor.nearest_distance || hit.t > 1.5 * sensor.farthest_distance) return false;
  const double cosine = -hit.normal.dot(ray) / ray.norm();
  if (cosine <= 0.0 || cosine < std::cos(sensor.largest_incidence)) return false;
  if (!sensor.projector) return true;
  const Vector3d point = hit.t * ray;
  if (hit.normal.dot(*sensor.projector - point) <= 0.0) return false;
  return !blocked(point + float_margin(point) * hit.normal, *sensor.projector);
}

SimulatedScene::SimulatedScene(std::span<const PlacedObject> objects, std::span<const BackgroundPlane> background)
    : impl_(std::make_unique<Impl>()) {
  impl_->triangles = triangles_of(objects);
  impl_->planes.assign(background.begin(), background.end());
  impl_->build();
}

SimulatedScene::~SimulatedScene() = default;
SimulatedScene::SimulatedScene(SimulatedScene&&) noexcept = default;
SimulatedScene& SimulatedScene::operator=(SimulatedScene&&) noexcept = default;

SimulatedScan SimulatedScene::scan(const SensorModel& sensor, Random random) const {
  const PinholeCamera& camera = sensor.camera;
  SimulatedScan scan{RangeImage(camera.rows, camera.columns), {}};
  scan.labels.resize(scan.image.points.size());
  std::vector<double> depths(scan.image.points.size(), 0.0);  // by cell, 0 = no data
  std::vector<double> noise(scan.image.points.size(), 0.0);   // in standard deviations
  const Eigen::AlignedBox2d objects = image_of(impl_->triangles, camera);
  for (int row = 0; row < camera.rows; ++row) {
    for (int column = 0; column < camera.columns; ++column) {
      const auto cell = static_cast<std::size_t>(scan.image.cell(row, column));
      // One draw for every cell, seen or not: a cell's noise does not depend on what the others show.
      if (sensor.depth_noise > 0.0) noise[cell] = random.gaussian();
      const Vector3d ray = camera.ray(row, column);
      const std::optional<SurfaceHit> hit =
          impl_->nearest(Vector3d::Zero(), ray, objects.contains(Eigen::Vector2d(column, row)));
      if (!hit || !impl_->gives_data(*hit, ray, sensor)) continue;
      depths[cell] = hit->t;
      scan.labels[cell] = hit->label;
    }
  }
  if (sensor.matching_window > 1) match_windows(sensor, depths, noise);
  for (int row = 0; row < camera.rows; ++row) {
    for (int column = 0; column < camera.columns; ++column) {
      const int cell = scan.image.cell(row, column);
      const auto at = static_cast<std::size_t>(cell);
      if (!(depths[at] > 0.0)) continue;
      const double measured = depths[at] + sensor.depth_noise * noise[at];
      scan.image[cell] = (quantized(measured, sensor.depth_quantization) * camera.ray(row, column)).cast<float>();
    }
  }
  return scan;
}

bool SimulatedScene::sees(const Vector3d& eye, const Vector3d& point, double margin) const {
  return !impl_->blocked(point + margin * (eye - point).normalized(), eye);
}

SimulatedScene::Hit SimulatedScene::cast(const Vector3d& origin, const Vector3d& direction) const {
  const std::optional<SurfaceHit> hit = impl_->nearest(origin, direction);
  if (!hit) return {-1.0, -1, -1};
  return {std::max(0.0, hit->t) * direction.norm(), hit->label.object, hit->label.face};
}

std::string ray_isa() {
#if defined(__x86_64__) || defined(_M_X64)
  return "sse4.2";
#else
  return "default";
#endif
}

Pose view_pose(const Vector3d& direction, const Vector3d& centre, double distance, double roll) {
  // The rows of the rotation are the sensor's axes in the model frame.
  const Vector3d forward = -direction.normalized();
  const Vector3d up = std::abs(forward.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitY();
  const Vector3d right = forward.cross(up).normalized();
  Eigen::Matrix3d rotation;
  rotation << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(roll, Vector3d::UnitZ()).toRotationMatrix() * rotation;
  pose.translation = Vector3d(0.0, 0.0, distance) - pose.rotation * centre;
  return pose;
}

}  // namespace foresight
