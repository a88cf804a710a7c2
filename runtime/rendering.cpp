#include "runtime/rendering.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace foresight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The value a * column + b * row + c over the image; distances to edges and inverse depths are such functions.
struct Affine {
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;
};

// >= 0 on the side of the edge p-q where the triangle lies, for triangles with positive area in (column, row).
Affine edge_function(const Vector2d& p, const Vector2d& q) {
  const Vector2d d = q - p;
  return {-d.y(), d.x(), d.y() * p.x() - d.x() * p.y()};
}

// The inverse depth of a plane normal . p = offset: 1 / z = normal . ray / offset, and the ray is affine in the cell.
Affine inverse_depth(const Vector3d& normal, double offset, const PinholeCamera& camera) {
  const double a = normal.x() / camera.fx;
  const double b = normal.y() / camera.fy;
  return {a / offset, b / offset, (normal.z() - a * camera.cx - b * camera.cy) / offset};
}

// Columns of a row at which all edge functions are >= 0: [first, last], empty when first > last.
std::array<int, 2> inside(const std::array<Affine, 3>& edges, double row, int first_column, int last_column) {
  double low = first_column;
  double high = last_column;
  for (const Affine& edge : edges) {
    const double rest = edge.b * row + edge.c;
    if (edge.a > 0.0) {
      low = std::max(low, -rest / edge.a);
    } else if (edge.a < 0.0) {
      high = std::min(high, -rest / edge.a);
    } else if (rest < 0.0) {
      return {1, 0};
    }
  }
  if (!(low <= high)) return {1, 0};  // also keeps both within the columns asked for
  return {static_cast<int>(std::ceil(low)), static_cast<int>(std::floor(high))};
}

struct Corner {
  Vector3d point;  // sensor frame. Unit: mm.
  Vector2d image;  // column, row
};

void draw(const std::array<const Corner*, 3>& corners, int triangle, const PinholeCamera& camera,
          Rendering& rendering) {
  const Vector3d normal = (corners[1]->point - corners[0]->point).cross(corners[2]->point - corners[0]->point);
  const double offset = normal.dot(corners[0]->point);
  const Vector3d unit = normal.stableNormalized();
  rendering.normal[static_cast<std::size_t>(triangle)] = unit.cast<float>();
  rendering.height[static_cast<std::size_t>(triangle)] = static_cast<float>(-unit.dot(corners[0]->point));
  if (!(offset < 0.0)) return;  // seen from behind or edge-on
  // Facing triangles run counter-clockwise to the eye; with rows downwards their area in (column, row) is negative.
  const Vector2d& p = corners[0]->image;
  const Vector2d& q = corners[2]->image;
  const Vector2d& r = corners[1]->image;
  const std::array<Affine, 3> edges = {edge_function(p, q), edge_function(q, r), edge_function(r, p)};
  const Affine inverse = inverse_depth(normal, offset, camera);
  const auto [lowest, highest] = std::minmax({p.y(), q.y(), r.y()});
  // Compared before they become integers: vertices close to the camera's plane project beyond those.
  const int end_row = rendering.first_row + rendering.rows;
  const int first_row = static_cast<int>(std::ceil(std::clamp<double>(lowest, rendering.first_row, end_row)));
  const int last_row = static_cast<int>(std::floor(std::clamp<double>(highest, rendering.first_row - 1, end_row - 1)));
  for (int row = first_row; row <= last_row; ++row) {
    const auto [first, last] =
        inside(edges, row, rendering.first_column, rendering.first_column + rendering.columns - 1);
    for (int column = first; column <= last; ++column) {
      const auto depth = static_cast<float>(1.0 / (inverse.a * column + inverse.b * row + inverse.c));
      const auto cell =
          static_cast<std::size_t>(rendering.cell(row - rendering.first_row, column - rendering.first_column));
      if (rendering.triangle[cell] >= 0 && rendering.depth[cell] <= depth) continue;
      rendering.depth[cell] = depth;
      rendering.triangle[cell] = triangle;
    }
  }
}

}  // namespace

Rendering render(const CompiledModel& model, const Pose& T_sensor_model, const PinholeCamera& camera, int beyond) {
  Rendering rendering;
  PoolVector<Corner> corners;
  corners.reserve(model.vertices.size());
  Vector2d low(camera.columns + beyond, camera.rows + beyond);
  Vector2d high(-1.0 - beyond, -1.0 - beyond);
  for (const Eigen::Vector3f& vertex : model.vertices) {
    Corner corner;
    corner.point = T_sensor_model * vertex.cast<double>();
    if (!(corner.point.z() > 0.0)) return rendering;
    corner.image = camera.project(corner.point);
    low = low.cwiseMin(corner.image);
    high = high.cwiseMax(corner.image);
    corners.push_back(corner);
  }
  const auto first = [beyond](double value, int cells) {
    return static_cast<int>(std::ceil(std::clamp<double>(value, -beyond, cells + beyond)));
  };
  const auto last = [beyond](double value, int cells) {
    return static_cast<int>(std::floor(std::clamp<double>(value, -1.0 - beyond, cells - 1.0 + beyond)));
  };
  rendering.first_column = first(low.x(), camera.columns);
  rendering.first_row = first(low.y(), camera.rows);
  rendering.columns = std::max(0, last(high.x(), camera.columns) - rendering.first_column + 1);
  rendering.rows = std::max(0, last(high.y(), camera.rows) - rendering.first_row + 1);
  const auto cells = static_cast<std::size_t>(rendering.rows) * static_cast<std::size_t>(rendering.columns);
  rendering.depth.assign(cells, 0.0F);
  rendering.triangle.assign(cells, -1);
  rendering.normal.assign(model.triangles.size(), Eigen::Vector3f::Zero());
  rendering.height.assign(model.triangles.size(), 0.0F);
  if (cells == 0) return rendering;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const auto& indices = model.triangles[t];
    draw({&corners[static_cast<std::size_t>(indices[0])], &corners[static_cast<std::size_t>(indices[1])],
          &corners[static_cast<std::size_t>(indices[2])]},
         static_cast<int>(t), camera, rendering);
  }
  return rendering;
}

namespace {

// Cells of `a` that show something, and those at which `b` shows the same within `reach` cells.
std::pair<long, long> shown_and_same(const Rendering& a, const Rendering& b, double distance, int reach) {
  const auto same_at = [&](int row, int column, float depth) {
    if (row < 0 || column < 0 || row >= b.rows || column >= b.columns) return false;
    const float other = b.depth[static_cast<std::size_t>(b.cell(row, column))];
    return other > 0.0F && std::abs(static_cast<double>(other - depth)) <= distance;
  };
  const auto same_around = [&](int row, int column, float depth) {
    if (same_at(row, column, depth)) return true;
    for (int r = row - reach; r <= row + reach; ++r) {
      for (int c = column - reach; c <= column + reach; ++c) {
        if (same_at(r, c, depth)) return true;
      }
    }
    return false;
  };
  long shown = 0;
  long same = 0;
  for (int row = 0; row < a.rows; ++row) {
    for (int column = 0; column < a.columns; ++column) {
      const float depth = a.depth[static_cast<std::size_t>(a.cell(row, column))];
      if (!(depth > 0.0F)) continue;
      ++shown;
      same += same_around(row + a.first_row - b.first_row, column + a.first_column - b.first_column, depth) ? 1 : 0;
    }
  }
  return {shown, same};
}

}  // namespace

double same_share(const Rendering& a, const Rendering& b, double distance, int reach) {
  const auto [shown_by_a, same_in_a] = shown_and_same(a, b, distance, reach);
  const auto [shown_by_b, same_in_b] = shown_and_same(b, a, distance, reach);
  const double same = 0.5 * static_cast<double>(same_in_a + same_in_b);
  const double either = static_cast<double>(shown_by_a + shown_by_b) - same;
  return either > 0.0 ? same / either : 0.0;
}

}  // namespace foresight
