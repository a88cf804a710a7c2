#include "compiler/scene_generator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <optional>

#include "common/errors.h"

namespace foresight {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr double kGap = 1.0;            // objects keep at least this far apart. Unit: mm.
constexpr int kPositions = 200;         // tried for one object in one arrangement
constexpr int kStrictArrangements = 8;  // tried before a scene may hold fewer objects or reach over the image border
constexpr double kDepthSpread = 100.0;  // several objects before a sensor of one distance: +- this. Unit: mm.
constexpr int kFewestFaceCells = 12;    // of a visible face
constexpr double kLowestElevation = 30.0 * std::numbers::pi / 180.0;  // of the sensor above the table
constexpr double kHighestElevation = 60.0 * std::numbers::pi / 180.0;

// How freely objects may be placed. Grows from one arrangement to the next, so that some arrangement succeeds.
struct Room {
  double nearest = 0.0;  // depth of the objects' centres. Unit: mm.
  double farthest = 0.0;
  double border = 0.0;  // objects may reach over the image border by this share of the image
};

struct Placement {
  int model = 0;
  Pose T_sensor_model;
  Points vertices;   // sensor frame
  Points footprint;  // what must not overlap: the vertices, or their feet on the table
};

Room room_of(const SensorModel& sensor, bool spread, int arrangement) {
  const double single_distance = sensor.nearest_distance == sensor.farthest_distance ? kDepthSpread : 0.0;
  const double extension = spread ? single_distance + 25.0 * arrangement : 0.0;
  // Beyond half the nearest and one and a half times the farthest distance the sensor gives no data.
  return {std::max(sensor.nearest_distance - extension, 0.6 * sensor.nearest_distance),
          std::min(sensor.farthest_distance + extension, 1.4 * sensor.farthest_distance),
          0.1 * std::max(0, arrangement - kStrictArrangements + 1)};
}

Points transformed(const CadModel& model, const Pose& pose) {
  Points points;
  points.reserve(model.vertices.size());
  for (const Vector3d& vertex : model.vertices) points.push_back(pose * vertex);
  return points;
}

Vector3d box_centre(const CadModel& model) {
  Vector3d low = model.vertices.front();
  Vector3d high = low;
  for (const Vector3d& vertex : model.vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  return 0.5 * (low + high);
}

Vector3d centre_of_mass(const CadModel& model) {
  const Vector3d origin = model.vertices.front();
  Vector3d moment = Vector3d::Zero();
  double volume = 0.0;
  for (const auto& corners : model.triangles) {
    const auto corner = [&](std::size_t k) -> Vector3d {
      return model.vertices[static_cast<std::size_t>(corners[k])] - origin;
    };
    const double signed_volume = corner(0).dot(corner(1).cross(corner(2)));
    volume += signed_volume;
    moment += signed_volume / 4.0 * (corner(0) + corner(1) + corner(2));
  }
  return origin + moment / volume;
}

// Whether a plane separates two sets of points, hence their convex hulls, by kGap. Perceptron rule: the axis turns
// towards the pair of points that violates it most. Never says yes wrongly; may say no to hulls that barely miss each
// other.
bool separable(const Points& a, const Points& b) {
  const auto mean = [](const Points& points) -> Vector3d {
    return std::accumulate(points.begin(), points.end(), Vector3d(0, 0, 0)) / static_cast<double>(points.size());
  };
  Vector3d axis = (mean(b) - mean(a)).stableNormalized();
  for (int step = 0; step < 64; ++step) {
    const auto along = [&](const Vector3d& p, const Vector3d& q) { return axis.dot(p) < axis.dot(q); };
    const Vector3d shortest =
        *std::min_element(b.begin(), b.end(), along) - *std::max_element(a.begin(), a.end(), along);
    if (axis.dot(shortest) >= kGap * axis.norm() && axis.norm() > 0.0) return true;
    axis += shortest.stableNormalized();
  }
  return false;
}

bool inside_image(const Points& points, const PinholeCamera& camera, double border) {
  const double rows = border * camera.rows;
  const double columns = border * camera.columns;
  return std::all_of(points.begin(), points.end(), [&](const Vector3d& point) {
    if (point.z() <= 0.0) return false;
    const Eigen::Vector2d cell = camera.project(point);
    return cell.x() >= -columns && cell.x() <= camera.columns - 1 + columns && cell.y() >= -rows &&
           cell.y() <= camera.rows - 1 + rows;
  });
}

// How a body that rests on `contacts` (points of a plane) falls over.
struct Tip {
  Vector3d pivot;
  Vector3d sideways;  // unit, in the plane, from the pivot to the side it falls to
};

// None when the centre of mass stands over the contacts' convex hull.
std::optional<Tip> tip_of(const Points& contacts, const Vector3d& mass, const Vector3d& down, double tolerance) {
  const Vector3d foot = mass + down * down.dot(contacts.front() - mass);
  // The nearest point of the hull, when the foot is outside: on one of the segments between two contacts.
  double least = std::numeric_limits<double>::infinity();
  Tip tip;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = i; j < contacts.size(); ++j) {
      const Vector3d edge = contacts[j] - contacts[i];
      const double share = i == j ? 0.0 : std::clamp((foot - contacts[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      const Vector3d point = contacts[i] + share * edge;
      const double distance = (foot - point).norm();
      if (distance >= least) continue;
      least = distance;
      const Vector3d aside =
          i == j ? down.unitOrthogonal() : Vector3d(down.cross(edge).normalized());  // balanced on it
      tip = {point, distance > tolerance ? Vector3d((foot - point) / distance) : aside};
    }
  }
  const bool held = std::any_of(contacts.begin(), contacts.end(), [&](const Vector3d& contact) {
    return tip.sideways.dot(contact - tip.pivot) > tolerance;
  });
  return held ? std::nullopt : std::optional(tip);
}

// The direction (model frame) that points down once the object, put down in a random attitude, has come to rest on a
// facet of its convex hull. It tips over, without momentum, until its centre of mass stands over what it rests on.
// Every step lowers the centre of mass, so the steps end.
Vector3d resting_down(const CadModel& model, Random& random) {
  const Vector3d mass = centre_of_mass(model);
  double size = 0.0;
  for (const Vector3d& vertex : model.vertices) size = std::max(size, (vertex - mass).norm());
  const double tolerance = 1e-6 * size;
  Vector3d down = random.direction();
  for (int step = 0; step < 1000; ++step) {
    double lowest = -std::numeric_limits<double>::infinity();
    for (const Vector3d& vertex : model.vertices) lowest = std::max(lowest, down.dot(vertex));
    Points contacts;
    for (const Vector3d& vertex : model.vertices) {
      if (down.dot(vertex) >= lowest - tolerance) contacts.push_back(vertex);
    }
    const std::optional<Tip> tip = tip_of(contacts, mass, down, tolerance);
    if (!tip) break;
    double angle = std::numbers::pi;
    for (const Vector3d& vertex : model.vertices) {
      const Vector3d arm = vertex - tip->pivot;
      const double side = tip->sideways.dot(arm);
      if (side > tolerance) angle = std::min(angle, std::atan2(std::max(0.0, -down.dot(arm)), side));
    }
    down = (std::cos(angle) * down + std::sin(angle) * tip->sideways).normalized();
  }
  return down;
}

// A table seen from above: its normal points up, towards the sensor.
BackgroundPlane random_table(const Room& room, Random& random) {
  const double elevation = random.uniform(kLowestElevation, kHighestElevation);
  const Vector3d up(0.0, -std::cos(elevation), -std::sin(elevation));
  return {up, up.z() * random.uniform(room.nearest, room.farthest)};
}

// Proposes poses of one object and says whether they fit: what differs between floating and resting on a table.
class Proposer {
 public:
  Proposer(const CadModel& model, const PinholeCamera& camera, const Room& room, const BackgroundPlane* table)
      : model_(model), camera_(camera), room_(room), table_(table), centre_(box_centre(model)) {}

  // Uniformly random rotation; the centre seen within `spread` of the image's half sides from its middle.
  [[nodiscard]] Pose floating(double spread, Random& random) const {
    Pose pose;
    pose.rotation = random.rotation();
    const double depth = random.uniform(room_.nearest, room_.farthest);
    pose.translation = depth * random_ray(spread, random) - pose.rotation * centre_;
    return pose;
  }

  // Turned about the vertical at random, standing somewhere on the table. None when the ray drawn misses the table.
  [[nodiscard]] std::optional<Pose> resting(const Vector3d& down, Random& random) const {
    Pose pose;
    const Eigen::AngleAxisd yaw(random.uniform(0.0, 2.0 * std::numbers::pi), table_->normal);
    pose.rotation =
        yaw.toRotationMatrix() * Eigen::Quaterniond::FromTwoVectors(down, -table_->normal).toRotationMatrix();
    const Vector3d ray = random_ray(1.0 + 2.0 * room_.border, random);
    const double depth = table_->offset / table_->normal.dot(ray);
    if (!(table_->normal.dot(ray) < 0.0) || depth > 1.5 * room_.farthest) return std::nullopt;
    pose.translation = depth * ray - pose.rotation * centre_;
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vector3d& vertex : transformed(model_, pose)) lowest = std::min(lowest, table_->normal.dot(vertex));
    pose.translation += (table_->offset - lowest) * table_->normal;
    return pose;
  }

  [[nodiscard]] Placement placement(int index, const Pose& pose) const {
    Placement placed{index, pose, transformed(model_, pose), {}};
    placed.footprint = placed.vertices;
    // Objects on a table are kept apart on the table, so that none stands above another.
    if (table_ != nullptr) {
      for (Vector3d& point : placed.footprint) point -= table_->normal * table_->normal.dot(point);
    }
    return placed;
  }

 private:
  [[nodiscard]] Vector3d random_ray(double spread, Random& random) const {
    const double row = 0.5 * (camera_.rows - 1) + 0.5 * camera_.rows * spread * random.uniform(-1.0, 1.0);
    const double column = 0.5 * (camera_.columns - 1) + 0.5 * camera_.columns * spread * random.uniform(-1.0, 1.0);
    return camera_.ray(row, column);
  }

  const CadModel& model_;
  const PinholeCamera& camera_;
  const Room& room_;
  const BackgroundPlane* table_;
  Vector3d centre_;
};

// As many of the chosen objects as find a place.
std::vector<Placement> arrange(const std::vector<CadModel>& models, const std::vector<int>& chosen,
                               const PinholeCamera& camera, const Room& room, const BackgroundPlane* table,
                               Random& random) {
  std::vector<Placement> placed;
  for (const int index : chosen) {
    const CadModel& model = models[static_cast<std::size_t>(index)];
    const Proposer proposer(model, camera, room, table);
    const Vector3d down = table != nullptr ? resting_down(model, random) : Vector3d::Zero();
    for (int position = 0; position < kPositions; ++position) {
      // A single floating object: near the optical axis, nearer with every try, so that a large one fits in the end.
      const double spread = chosen.size() == 1 ? 0.3 * (1.0 - (position + 1.0) / kPositions) : 1.0 + 2.0 * room.border;
      const std::optional<Pose> pose =
          table != nullptr ? proposer.resting(down, random) : proposer.floating(spread, random);
      if (!pose) continue;
      Placement candidate = proposer.placement(index, *pose);
      const auto clear = [&](const Placement& other) { return separable(candidate.footprint, other.footprint); };
      if (!inside_image(candidate.vertices, camera, room.border)) continue;
      if (!std::all_of(placed.begin(), placed.end(), clear)) continue;
      placed.push_back(std::move(candidate));
      break;
    }
  }
  return placed;
}

std::vector<int> random_choice(std::size_t models, int count, Random& random) {
  std::vector<int> order(models);
  std::iota(order.begin(), order.end(), 0);
  for (int i = 0; i < count; ++i) {
    const int other = random.integer(i, static_cast<int>(models) - 1);
    std::swap(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(other)]);
  }
  order.resize(static_cast<std::size_t>(count));
  return order;
}

// Objects and table of the scene. All objects chosen if an arrangement strictly inside the image is found soon; else as
// many as options.fewest_objects allows; else with more room until those fit.
void set_scene(const std::vector<CadModel>& models, const SensorModel& sensor, const SceneOptions& options,
               Random& random, Scene& scene) {
  const int count = random.integer(options.fewest_objects, options.most_objects);
  const std::vector<int> chosen = random_choice(models.size(), count, random);
  std::vector<Placement> best;
  for (int arrangement = 0;; ++arrangement) {
    const Room room = room_of(sensor, count > 1 || arrangement > kStrictArrangements, arrangement);
    std::vector<BackgroundPlane> background;
    if (options.background) background.push_back(random_table(room, random));
    const BackgroundPlane* table = options.background ? background.data() : nullptr;
    std::vector<Placement> placed = arrange(models, chosen, sensor.camera, room, table, random);
    if (placed.size() > best.size()) {
      best = std::move(placed);
      scene.background = std::move(background);
    }
    const auto enough = arrangement < kStrictArrangements ? count : options.fewest_objects;
    if (best.size() >= static_cast<std::size_t>(enough)) break;
  }
  for (const Placement& placement : best) scene.objects.push_back({placement.model, placement.T_sensor_model, 0.0, 0});
}

// Data cells on each face of one object.
std::vector<int> cells_by_face(const SimulatedScan& scan, int object, std::size_t faces) {
  std::vector<int> cells(faces, 0);
  for (const CellLabel& label : scan.labels) {
    if (label.object == object) ++cells[static_cast<std::size_t>(label.face)];
  }
  return cells;
}

// The sensor with as many more rows and columns as it takes to see the whole object: what lies beyond the image is not
// visible.
SensorModel with_room_for(const CadModel& model, const Pose& T_sensor_model, SensorModel sensor) {
  PinholeCamera& camera = sensor.camera;
  Eigen::Vector2d low(0.0, 0.0);
  Eigen::Vector2d high(camera.columns - 1.0, camera.rows - 1.0);
  for (const Eigen::Vector3d& vertex : model.vertices) {
    const Eigen::Vector3d point = T_sensor_model * vertex;
    if (!(point.z() > 0.0)) continue;
    low = low.cwiseMin(camera.project(point));
    high = high.cwiseMax(camera.project(point));
  }
  const auto cells = [](double value) { return static_cast<int>(std::ceil(std::min(value, 1.0 * kLargestImageSide))); };
  const int left = cells(-low.x());
  const int top = cells(-low.y());
  camera.columns = std::min(kLargestImageSide, left + 1 + cells(high.x()));
  camera.rows = std::min(kLargestImageSide, top + 1 + cells(high.y()));
  camera.cx += left;
  camera.cy += top;
  return sensor;
}

// Compares each object's cells with those it would have alone. Noise decides about no cell, so it is left out there.
void measure_visibility(const std::vector<CadModel>& models, SensorModel sensor, std::optional<int> only,
                        Scene& scene) {
  sensor.depth_noise = 0.0;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    SceneObject& object = scene.objects[i];
    if (only && object.model != *only) continue;
    const CadModel& model = models[static_cast<std::size_t>(object.model)];
    const auto seen = cells_by_face(scene.scan, static_cast<int>(i), model.faces.size());
    const PlacedObject lone{&model, object.T_sensor_model};
    const SensorModel wide = with_room_for(model, object.T_sensor_model, sensor);
    const auto alone = cells_by_face(SimulatedScene({&lone, 1}).scan(wide, Random(0)), 0, model.faces.size());
    const int seen_cells = std::accumulate(seen.begin(), seen.end(), 0);
    const int lone_cells = std::accumulate(alone.begin(), alone.end(), 0);
    object.visible_fraction = lone_cells == 0 ? 0.0 : std::min(1.0, static_cast<double>(seen_cells) / lone_cells);
    object.visible_faces =
        static_cast<int>(std::count_if(seen.begin(), seen.end(), [](int cells) { return cells >= kFewestFaceCells; }));
  }
}

nlohmann::ordered_json matrix_json(const Pose& pose) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int row = 0; row < 3; ++row) {
    rows.push_back({pose.rotation(row, 0), pose.rotation(row, 1), pose.rotation(row, 2), pose.translation(row)});
  }
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

}  // namespace

void check(const SceneOptions& options, std::size_t models) {
  if (options.fewest_objects < 1 || options.most_objects < options.fewest_objects) {
    throw UsageError("--objects",
                     "from " + std::to_string(options.fewest_objects) + " to " + std::to_string(options.most_objects) +
                         " objects a scene is no range",
                     "give the fewest (1 or more) and the most");
  }
  if (static_cast<std::size_t>(options.most_objects) > models) {
    throw UsageError("--objects",
                     "a scene of " + std::to_string(options.most_objects) +
                         " objects needs as many CAD files, but there are " + std::to_string(models),
                     "give more CAD files or ask for fewer objects");
  }
}

Scene generate_scene(const std::vector<CadModel>& models, const SensorModel& sensor, const SceneOptions& options,
                     std::uint64_t seed, std::uint64_t index) {
  assert(options.fewest_objects >= 1 && options.fewest_objects <= options.most_objects);
  assert(static_cast<std::size_t>(options.most_objects) <= models.size());
  Random random(seed, index);
  Scene scene;
  set_scene(models, sensor, options, random, scene);
  std::vector<PlacedObject> objects;
  for (const SceneObject& object : scene.objects) {
    objects.push_back({&models[static_cast<std::size_t>(object.model)], object.T_sensor_model});
  }
  scene.scan = SimulatedScene(objects, scene.background).scan(sensor, Random(random.next()));
  measure_visibility(models, sensor, options.only_measured, scene);
  return scene;
}

std::string truth_json(const std::vector<Scene>& scenes, const std::vector<CadModel>& models,
                       const std::vector<std::string>& scan_names, const SensorModel& sensor, std::uint64_t seed) {
  assert(scenes.size() == scan_names.size());
  nlohmann::ordered_json scans = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    nlohmann::ordered_json objects = nlohmann::ordered_json::array();
    for (const SceneObject& object : scenes[i].objects) {
      objects.push_back({{"object", models[static_cast<std::size_t>(object.model)].name},
                         {"T_sensor_model", matrix_json(object.T_sensor_model)},
                         {"visible_fraction", object.visible_fraction},
                         {"visible_faces", object.visible_faces}});
    }
    nlohmann::ordered_json background = nlohmann::ordered_json::array();
    for (const BackgroundPlane& plane : scenes[i].background) {
      background.push_back(
          {{"normal", {plane.normal.x(), plane.normal.y(), plane.normal.z()}}, {"offset", plane.offset}});
    }
    scans.push_back({{"scan", scan_names[i]}, {"objects", objects}, {"background", background}});
  }
  const nlohmann::ordered_json document = {{"unit", "mm"},
                                           {"frame", "x right, y down, z forward, camera centre at the origin"},
                                           {"sensor", sensor.name},
                                           {"seed", seed},
                                           {"scans", scans}};
  // File names are bytes, JSON is UTF-8: what is none becomes the replacement character.
  return document.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace foresight
