#include "benchmarks/random_solids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "common/random.h"
#include "compiler/triangle_mesh.h"

namespace foresight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Corners sharper or flatter than these make faces that hardly show, or two faces that look like one.
constexpr double kSharpestCorner = 35.0 * std::numbers::pi / 180.0;
constexpr double kFlattestCorner = 25.0 * std::numbers::pi / 180.0;  // from straight

bool corners_show(const std::vector<Vector2d>& polygon) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d before = polygon[(i + polygon.size() - 1) % polygon.size()] - polygon[i];
    const Vector2d after = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double angle = std::acos(std::clamp(before.normalized().dot(after.normalized()), -1.0, 1.0));
    if (angle < kSharpestCorner || angle > std::numbers::pi - kFlattestCorner) return false;
  }
  return true;
}

// Star-shaped about the origin, counter-clockwise. Every second one has a notch or two.
std::vector<Vector2d> star_polygon(Random& random) {
  const int corners = random.integer(4, 9);
  const double radius = random.uniform(40.0, 105.0);
  const double unevenness = random.uniform(0.0, 0.5);
  std::vector<double> radii(at(corners));
  for (double& r : radii) r = radius * random.uniform(1.0 - unevenness, 1.0);
  if (random.integer(0, 1) == 1) {
    for (int notches = random.integer(1, 2); notches > 0; --notches) {
      radii[at(random.integer(0, corners - 1))] = radius * random.uniform(0.25, 0.5);
    }
  }
  std::vector<Vector2d> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + random.uniform(-0.35, 0.35)) / corners;
    polygon.push_back(radii[at(i)] * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

// The top is the base scaled and shifted: its sides stay parallel to those of the base, so all faces are planar.
std::optional<CadModel> frustum(Random& random) {
  const std::vector<Vector2d> base = star_polygon(random);
  const double height = random.uniform(25.0, 150.0);
  const double scale = random.integer(0, 2) == 0 ? 1.0 : random.uniform(0.45, 1.0);
  const Vector2d shift(random.uniform(-0.4, 0.4) * height, random.uniform(-0.4, 0.4) * height);
  if (!corners_show(base)) return std::nullopt;

  CadModel model;
  const int n = static_cast<int>(base.size());
  for (const Vector2d& p : base) model.vertices.emplace_back(p.x(), p.y(), 0.0);
  const std::vector<Triangle> cap = triangulate(model.vertices);
  for (const Vector2d& p : base) {
    const Vector2d top = scale * p + shift;
    model.vertices.emplace_back(top.x(), top.y(), height);
  }
  for (const Triangle& t : cap) model.triangles.push_back({t[0], t[2], t[1]});
  for (const Triangle& t : cap) model.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    model.triangles.push_back({i, j, j + n});
    model.triangles.push_back({i, j + n, i + n});
  }
  return model;
}

// Boxes side by side on one floor; heights[column][row] counts levels of the grid, 0 outside it.
struct HeightField {
  std::vector<double> x, y, z;  // grid lines. Unit: mm.
  std::vector<std::vector<int>> heights;

  [[nodiscard]] int columns() const { return static_cast<int>(x.size()) - 1; }
  [[nodiscard]] int rows() const { return static_cast<int>(y.size()) - 1; }
  [[nodiscard]] int levels() const { return static_cast<int>(z.size()) - 1; }
  [[nodiscard]] bool filled(int i, int j, int k) const {
    if (i < 0 || j < 0 || k < 0 || i >= columns() || j >= rows()) return false;
    return k < heights[at(i)][at(j)];
  }
};

std::vector<double> grid_lines(Random& random, int cells, double narrowest, double widest) {
  std::vector<double> lines = {0.0};
  for (int i = 0; i < cells; ++i) lines.push_back(lines.back() + random.uniform(narrowest, widest));
  return lines;
}

// Two boxes that face each other across a grid line, both higher than the other two there: their upper parts touch
// along an edge alone, which four faces would share.
bool touches_along_edge(const HeightField& field) {
  for (std::size_t i = 0; i + 1 < field.heights.size(); ++i) {
    for (std::size_t j = 0; j + 1 < field.heights[i].size(); ++j) {
      const auto [a, b] = std::minmax(field.heights[i][j], field.heights[i + 1][j + 1]);
      const auto [c, d] = std::minmax(field.heights[i + 1][j], field.heights[i][j + 1]);
      if (a > d || c > b) return true;
    }
  }
  return false;
}

// The rectangles of the grid between filled and empty, which share the grid's nodes as vertices.
CadModel surface_of(const HeightField& field) {
  CadModel model;
  std::map<std::array<int, 3>, int> nodes;
  const auto vertex = [&](std::array<int, 3> node) {
    const auto [found, added] = nodes.try_emplace(node, static_cast<int>(model.vertices.size()));
    if (added) model.vertices.emplace_back(field.x[at(node[0])], field.y[at(node[1])], field.z[at(node[2])]);
    return found->second;
  };
  const auto add_rectangle = [&](std::array<int, 3> low, std::size_t axis, bool outward_up) {
    std::array<int, 3> second = low, third = low, fourth = low;
    ++second[(axis + 1) % 3];
    ++third[(axis + 1) % 3];
    ++third[(axis + 2) % 3];
    ++fourth[(axis + 2) % 3];
    int a = vertex(low), b = vertex(second), c = vertex(third), d = vertex(fourth);
    if (!outward_up) std::swap(b, d);
    model.triangles.push_back({a, b, c});
    model.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < field.columns(); ++i) {
    for (int j = 0; j < field.rows(); ++j) {
      for (int k = 0; k < field.levels(); ++k) {
        if (!field.filled(i, j, k)) continue;
        if (!field.filled(i - 1, j, k)) add_rectangle({i, j, k}, 0, false);
        if (!field.filled(i + 1, j, k)) add_rectangle({i + 1, j, k}, 0, true);
        if (!field.filled(i, j - 1, k)) add_rectangle({i, j, k}, 1, false);
        if (!field.filled(i, j + 1, k)) add_rectangle({i, j + 1, k}, 1, true);
        if (!field.filled(i, j, k - 1)) add_rectangle({i, j, k}, 2, false);
        if (!field.filled(i, j, k + 1)) add_rectangle({i, j, k + 1}, 2, true);
      }
    }
  }
  return model;
}

std::optional<CadModel> staircase(Random& random) {
  const int columns = random.integer(2, 4), rows = random.integer(2, 3), levels = random.integer(2, 3);
  HeightField field;
  field.x = grid_lines(random, columns, 18.0, 60.0);
  field.y = grid_lines(random, rows, 18.0, 60.0);
  field.z = grid_lines(random, levels, 18.0, 50.0);
  field.heights.assign(at(columns), std::vector<int>(at(rows)));
  for (auto& column : field.heights) {
    for (int& height : column) height = random.integer(1, levels);
  }
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  if (random.integer(0, 1) == 1) {
    for (const auto& [row, column] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
      shear(row, column) = random.uniform(-0.5, 0.5);
    }
  }
  const bool even = std::all_of(field.heights.begin(), field.heights.end(), [&](const auto& column) {
    return column == std::vector<int>(at(rows), field.heights[0][0]);
  });
  if (even || touches_along_edge(field)) return std::nullopt;
  CadModel model = surface_of(field);
  for (Vector3d& v : model.vertices) v = shear * v;  // of determinant 1: outward stays outward
  return model;
}

constexpr double kFlattestEdge = 0.94;  // cosine between the normals of two faces that meet: 20 degrees

// Whether every edge between two faces is long and sharp enough. Long edges of a staircase may come in several pieces.
bool edges_show(const CadModel& model) {
  const std::vector<EdgeUse> uses = edge_uses(model.triangles);
  for (std::size_t i = 0; i + 1 < uses.size(); i += 2) {  // closed: the two uses of an edge stand together
    const int a = model.triangle_face[at(uses[i].triangle)];
    const int b = model.triangle_face[at(uses[i + 1].triangle)];
    if (a == b) continue;
    const double length = (model.vertices[at(uses[i].high)] - model.vertices[at(uses[i].low)]).norm();
    if (length < kSmallestSolidEdge) return false;
    if (model.faces[at(a)].normal.dot(model.faces[at(b)].normal) > kFlattestEdge) return false;
  }
  return true;
}

std::string solid_name(int index) {
  std::string digits = std::to_string(index);
  digits.insert(0, digits.size() < 4 ? 4 - digits.size() : 0, '0');
  return "solid_" + digits;
}

}  // namespace

CadModel random_solid(std::uint64_t seed, int index) {
  assert(index >= 0);
  Random random(seed, static_cast<std::uint64_t>(index));
  const bool stairs = random.integer(0, 1) == 1;
  while (true) {
    std::optional<CadModel> model = stairs ? staircase(random) : frustum(random);
    if (!model) continue;
    const double diameter = model->diameter();
    if (diameter < kSmallestSolid || diameter > kLargestSolid) continue;
    find_planar_faces(*model, {});
    if (!edges_show(*model)) continue;
    model->name = solid_name(index);
    return std::move(*model);
  }
}

}  // namespace foresight
