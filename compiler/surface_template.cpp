#include "compiler/surface_template.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "common/viewing_sphere.h"
#include "compiler/segment_visibility.h"
#include "compiler/triangle_mesh.h"

namespace foresight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Points in cubes, to find the near ones.
class PointCubes {
 public:
  explicit PointCubes(double side) : side_(side) {}

  void add(const Vector3d& point) {
    cubes_[key(cube_of(point))].push_back(static_cast<int>(points_.size()));
    points_.push_back(point);
  }
  [[nodiscard]] const std::vector<Vector3d>& points() const { return points_; }

  // Points nearer than the distance, ascending.
  [[nodiscard]] std::vector<int> nearer_than(const Vector3d& point, double distance) const {
    std::vector<int> near;
    const Cube centre = cube_of(point);
    const auto reach = static_cast<std::int64_t>(std::ceil(distance / side_));
    for (std::int64_t x = -reach; x <= reach; ++x) {
      for (std::int64_t y = -reach; y <= reach; ++y) {
        for (std::int64_t z = -reach; z <= reach; ++z) {
          const auto cube = cubes_.find(key(centre + Cube(x, y, z)));
          if (cube == cubes_.end()) continue;
          for (const int i : cube->second) {
            if ((points_[at(i)] - point).norm() < distance) near.push_back(i);
          }
        }
      }
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());  // two far cubes may share a key
    return near;
  }

 private:
  using Cube = Eigen::Array<std::int64_t, 3, 1>;
  [[nodiscard]] Cube cube_of(const Vector3d& p) const { return (p / side_).array().floor().cast<std::int64_t>(); }
  static std::uint64_t key(const Cube& c) {
    constexpr std::uint64_t kBits = (1U << 21U) - 1U;
    const Eigen::Array<std::uint64_t, 3, 1> u = c.cast<std::uint64_t>();
    return ((u.x() & kBits) << 42U) | ((u.y() & kBits) << 21U) | (u.z() & kBits);
  }

  double side_;
  std::vector<Vector3d> points_;
  std::unordered_map<std::uint64_t, std::vector<int>> cubes_;  // only looked up, never walked through
};

std::array<Vector3d, 3> corners_of(const CadModel& model, int triangle) {
  const Triangle& t = model.triangles[at(triangle)];
  return {model.vertices[at(t[0])], model.vertices[at(t[1])], model.vertices[at(t[2])]};
}

bool lies_on_face(const CadModel& model, const CadFace& face, const Vector3d& point, double tolerance) {
  return std::any_of(face.triangles.begin(), face.triangles.end(), [&](int t) {
    const auto [a, b, c] = corners_of(model, t);
    return distance_to_triangle(point, a, b, c) <= tolerance;
  });
}

// The longest edge of each face: the direction its grid is laid along. The first of equals.
std::vector<Vector3d> longest_edges(const CadModel& model) {
  std::vector<Vector3d> longest(model.faces.size(), Vector3d::Zero());
  const std::vector<EdgeUse> uses = edge_uses(model.triangles);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const int face = model.triangle_face[at(uses[i].triangle)];
    const auto inner = [&](std::size_t other) {  // the neighbouring use is across this very edge, and of the same face
      return uses[other].low == uses[i].low && uses[other].high == uses[i].high &&
             model.triangle_face[at(uses[other].triangle)] == face;
    };
    if ((i > 0 && inner(i - 1)) || (i + 1 < uses.size() && inner(i + 1))) continue;
    const Vector3d along = model.vertices[at(uses[i].high)] - model.vertices[at(uses[i].low)];
    if (along.norm() > longest[at(face)].norm() * (1.0 + 1e-6)) longest[at(face)] = along;
  }
  return longest;
}

// Places from low to high, both included, as many as the spacing allows; the middle when it allows only one.
std::vector<double> even_places(double low, double high, double spacing) {
  const auto steps = static_cast<int>((high - low) / spacing + 1e-6);
  if (steps == 0) return {0.5 * (low + high)};
  std::vector<double> places;
  for (int i = 0; i <= steps; ++i) places.push_back(low + (high - low) * i / steps);
  return places;
}

// A uniform grid over the bounding rectangle of a face along its longest edge, in the plane of the face, with points on
// the rectangle's sides: where the sides are edges, the edges belong to the face.
std::vector<Vector3d> grid_over(const CadModel& model, const CadFace& face, const Vector3d& longest_edge,
                                double spacing) {
  const Vector3d flat = longest_edge - face.normal * face.normal.dot(longest_edge);
  const Vector3d u = flat.norm() > 0.0 ? Vector3d(flat.normalized()) : Vector3d(face.normal.unitOrthogonal());
  const Vector3d v = face.normal.cross(u);
  Eigen::AlignedBox2d rectangle;
  for (const int t : face.triangles) {
    for (const Vector3d& corner : corners_of(model, t)) rectangle.extend(Vector2d(u.dot(corner), v.dot(corner)));
  }
  std::vector<Vector3d> grid;
  for (const double b : even_places(rectangle.min().y(), rectangle.max().y(), spacing)) {
    for (const double a : even_places(rectangle.min().x(), rectangle.max().x(), spacing)) {
      grid.push_back(a * u + b * v + face.offset * face.normal);
    }
  }
  return grid;
}

// Lays points over a surface, none nearer to another than the spacing.
class PointLayer {
 public:
  PointLayer(const CadModel& model, const SurfaceTemplateOptions& options)
      : model_(model), options_(options), cubes_(options.spacing), points_of_face_(model.faces.size(), 0) {
    for (const CadFace& face : model.faces) {
      Eigen::AlignedBox3d box;
      for (const int t : face.triangles) {
        for (const Vector3d& corner : corners_of(model, t)) box.extend(corner);
      }
      const Vector3d margin = Vector3d::Constant(options.edge_tolerance);
      boxes_.emplace_back(box.min() - margin, box.max() + margin);
    }
  }

  void lay(const CadFace& face, const std::vector<Vector3d>& candidates) {
    // Faces are planes to some hundredths of a millimetre, so points on a side of the rectangle may be that far
    // outside.
    constexpr double kOnFace = 0.02;
    const double tolerance = std::min(kOnFace, options_.edge_tolerance);
    for (const Vector3d& point : candidates) {
      if (!cubes_.nearer_than(point, options_.spacing - 1e-6).empty()) continue;
      if (lies_on_face(model_, face, point, tolerance)) keep(point);
    }
  }
  [[nodiscard]] bool has_points(std::size_t face) const { return points_of_face_[face] > 0; }
  [[nodiscard]] const PointCubes& cubes() const { return cubes_; }
  [[nodiscard]] const std::vector<std::vector<int>>& faces_of_points() const { return faces_of_points_; }

 private:
  void keep(const Vector3d& point) {
    std::vector<int> faces;
    for (std::size_t f = 0; f < model_.faces.size(); ++f) {
      if (!boxes_[f].contains(point) || !lies_on_face(model_, model_.faces[f], point, options_.edge_tolerance))
        continue;
      faces.push_back(static_cast<int>(f));
      ++points_of_face_[f];
    }
    cubes_.add(point);
    faces_of_points_.push_back(std::move(faces));
  }

  const CadModel& model_;
  const SurfaceTemplateOptions& options_;
  PointCubes cubes_;
  std::vector<std::vector<int>> faces_of_points_;
  std::vector<int> points_of_face_;
  std::vector<Eigen::AlignedBox3d> boxes_;
};

// Where a face that the grid missed may still have a point: the middles of its triangles, the largest first, then a
// finer grid. All can be too near to points of the neighbours; a face that small stays without points.
std::vector<Vector3d> places_inside(const CadModel& model, const CadFace& face, const Vector3d& longest_edge,
                                    double spacing) {
  std::vector<std::pair<double, Vector3d>> middles;
  for (const int t : face.triangles) {
    const auto [a, b, c] = corners_of(model, t);
    middles.emplace_back((b - a).cross(c - a).norm(), (a + b + c) / 3.0);
  }
  std::stable_sort(middles.begin(), middles.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Vector3d> places{face.centroid};
  for (const auto& middle : middles) places.push_back(middle.second);
  const std::vector<Vector3d> finer = grid_over(model, face, longest_edge, 0.25 * spacing);
  places.insert(places.end(), finer.begin(), finer.end());
  return places;
}

// Shares of each face's points that an eye sees.
std::vector<double> seen_shares(const CadModel& model, const SurfaceTemplate& surface, const Vector3d& eye,
                                const std::vector<Vector3d>& positions) {
  const EyeView view(model, eye);
  std::vector<double> seen(model.faces.size(), 0.0), all(model.faces.size(), 0.0);
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const std::vector<int>& faces = surface.points[p].faces;
    for (const int f : faces) all[at(f)] += 1.0;
    const auto in_front = [&view](int f) { return view.faces_eye(f); };
    if (std::none_of(faces.begin(), faces.end(), in_front) || !view.sees(positions[p], faces)) continue;
    for (const int f : faces) seen[at(f)] += in_front(f) ? 1.0 : 0.0;
  }
  for (std::size_t f = 0; f < seen.size(); ++f) seen[f] = all[f] > 0.0 ? seen[f] / all[f] : 0.0;
  return seen;
}

// Faces visible from one of the 80 cells: seen shares averaged over the middle of the cell and of its four parts.
std::vector<int> faces_of_aspect(const CadModel& model, const SurfaceTemplate& surface,
                                 const SurfaceTemplateOptions& options, const std::vector<Vector3d>& directions,
                                 const std::vector<Vector3d>& positions) {
  const Vector3d centre = 0.5 * (model.lowest() + model.highest());
  const double radius = 0.5 * (model.highest() - model.lowest()).norm();
  const double distance = std::max(options.distance, 1.1 * radius);  // from within, an eye would see nothing of it
  std::vector<double> sums(model.faces.size(), 0.0);
  for (const Vector3d& direction : directions) {
    const std::vector<double> shares = seen_shares(model, surface, centre + distance * direction, positions);
    for (std::size_t f = 0; f < sums.size(); ++f) sums[f] += shares[f];
  }
  std::vector<int> visible;
  for (std::size_t f = 0; f < sums.size(); ++f) {
    const double share = sums[f] / static_cast<double>(directions.size());
    if (share > 0.0 && share >= options.visible_share - 1e-9) visible.push_back(static_cast<int>(f));
  }
  return visible;
}

}  // namespace

SurfaceTemplate build_surface_template(const CadModel& model, const SurfaceTemplateOptions& options) {
  assert(options.spacing > 0.0 && options.neighbour_radius > options.spacing && options.edge_tolerance > 0.0);
  assert(options.visible_share > 0.0 && options.visible_share <= 1.0);
  const std::vector<Vector3d> longest = longest_edges(model);
  PointLayer layer(model, options);
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    layer.lay(model.faces[f], grid_over(model, model.faces[f], longest[f], options.spacing));
  }
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    if (layer.has_points(f)) continue;
    for (const Vector3d& place : places_inside(model, model.faces[f], longest[f], options.spacing)) {
      layer.lay(model.faces[f], {place});
      if (layer.has_points(f)) break;
    }
  }
  SurfaceTemplate surface;
  surface.spacing = options.spacing;
  const std::vector<Vector3d>& positions = layer.cubes().points();
  for (std::size_t p = 0; p < positions.size(); ++p) {
    TemplatePoint point;
    point.position = positions[p].cast<float>();
    point.faces = layer.faces_of_points()[p];
    point.normal = model.faces[at(point.faces.front())].normal.cast<float>();
    point.neighbours = layer.cubes().nearer_than(positions[p], options.neighbour_radius + 1e-6);
    std::erase(point.neighbours, static_cast<int>(p));
    surface.points.push_back(std::move(point));
  }
  const ViewingSphere aspects(kAspectCells), parts(4 * kAspectCells);
  for (int cell = 0; cell < kAspectCells; ++cell) {
    std::vector<Vector3d> directions{aspects.centre(cell)};
    for (int part = 4 * cell; part < 4 * cell + 4; ++part) directions.push_back(parts.centre(part));
    surface.aspects[at(cell)] = faces_of_aspect(model, surface, options, directions, positions);
  }
  return surface;
}

}  // namespace foresight
