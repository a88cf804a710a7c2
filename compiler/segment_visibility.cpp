#include "compiler/segment_visibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace foresight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Eigen::Vector3d;

constexpr double kClearance = 1e-3;  // the line of sight begins this far from the point. Unit: mm.
constexpr int kLargestSide = 64;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997. Edges count as hit, so that no line of
// sight slips through between two triangles.
bool crosses(const Vector3d& from, const Vector3d& along, const Vector3d& corner, const Vector3d& first_edge,
             const Vector3d& second_edge, double nearest) {
  constexpr double kEdge = 1e-9;
  const Vector3d p = along.cross(second_edge);
  const double determinant = first_edge.dot(p);
  if (determinant == 0.0) return false;
  const Vector3d to = from - corner;
  const double u = to.dot(p) / determinant;
  if (u < -kEdge || u > 1.0 + kEdge) return false;
  const Vector3d q = to.cross(first_edge);
  const double v = along.dot(q) / determinant;
  if (v < -kEdge || u + v > 1.0 + kEdge) return false;
  const double place = second_edge.dot(q) / determinant;
  return place > nearest && place < 1.0;
}

}  // namespace

EyeView::EyeView(const CadModel& model, const Vector3d& eye) : model_(model), eye_(eye) {
  const Vector3d centre = 0.5 * (model.lowest() + model.highest());
  assert((eye - centre).norm() > 0.5 * (model.highest() - model.lowest()).norm());
  forward_ = (centre - eye).normalized();
  right_ = forward_.unitOrthogonal();
  up_ = forward_.cross(right_);
  collect_occluders();
  sort_into_cells();
}

bool EyeView::faces_eye(int face) const {
  const CadFace& plane = model_.faces[at(face)];
  return plane.normal.dot(eye_) > plane.offset + 1e-6;
}

bool EyeView::sees(const Vector3d& point, std::span<const int> own_faces) const {
  const Vector3d along = eye_ - point;
  const double nearest = kClearance / along.norm();
  const Vector2i cell = cell_of(project(point));
  const std::size_t index = at(cell.y() * side_ + cell.x());
  for (int i = first_in_cell_[index]; i < first_in_cell_[index + 1]; ++i) {
    const Occluder& o = occluders_[at(in_cells_[at(i)])];
    if (!crosses(point, along, o.corner, o.first_edge, o.second_edge, nearest)) continue;
    if (!std::binary_search(own_faces.begin(), own_faces.end(), o.face)) return false;
  }
  return true;
}

Vector2d EyeView::project(const Vector3d& point) const {
  const Vector3d to = point - eye_;
  return Vector2d(to.dot(right_), to.dot(up_)) / to.dot(forward_);
}

Vector2i EyeView::cell_of(const Vector2d& place) const {
  const Eigen::Array2d cell = ((place - lowest_).array() / cell_size_.array()).floor();
  return cell.max(0.0).min(side_ - 1.0).matrix().cast<int>();
}

// Only triangles that face the eye can be the first thing it meets; the far sides of a closed solid stand behind them.
void EyeView::collect_occluders() {
  for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
    const auto& corners = model_.triangles[t];
    const Vector3d& corner = model_.vertices[at(corners[0])];
    const Vector3d first_edge = model_.vertices[at(corners[1])] - corner;
    const Vector3d second_edge = model_.vertices[at(corners[2])] - corner;
    if (first_edge.cross(second_edge).dot(eye_ - corner) <= 0.0) continue;
    occluders_.push_back({corner, first_edge, second_edge, model_.triangle_face[t]});
  }
}

// Each occluder goes into every cell its projected bounding rectangle touches: a counting sort, in occluder order.
void EyeView::sort_into_cells() {
  struct Rectangle {
    Vector2d low, high;
  };
  std::vector<Rectangle> rectangles;
  Eigen::AlignedBox2d picture;
  for (const Occluder& o : occluders_) {
    const Vector2d a = project(o.corner), b = project(o.corner + o.first_edge), c = project(o.corner + o.second_edge);
    const Vector2d slack = Vector2d::Constant(1e-9);
    rectangles.push_back({a.cwiseMin(b).cwiseMin(c) - slack, a.cwiseMax(b).cwiseMax(c) + slack});
    picture.extend(rectangles.back().low);
    picture.extend(rectangles.back().high);
  }
  side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(occluders_.size())) / 2.0), 1, kLargestSide);
  lowest_ = occluders_.empty() ? Vector2d(0.0, 0.0) : Vector2d(picture.min());
  cell_size_ = occluders_.empty() ? Vector2d(1.0, 1.0) : Vector2d(picture.sizes() / side_);
  first_in_cell_.assign(at(side_ * side_ + 1), 0);
  const auto for_each_cell = [this](const Rectangle& rectangle, const auto& visit) {
    const Vector2i low = cell_of(rectangle.low), high = cell_of(rectangle.high);
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) visit(at(y * side_ + x));
    }
  };
  for (const Rectangle& r : rectangles) for_each_cell(r, [this](std::size_t cell) { ++first_in_cell_[cell + 1]; });
  for (std::size_t cell = 1; cell < first_in_cell_.size(); ++cell) first_in_cell_[cell] += first_in_cell_[cell - 1];
  in_cells_.resize(at(first_in_cell_.back()));
  std::vector<int> next(first_in_cell_.begin(), first_in_cell_.end() - 1);
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    for_each_cell(rectangles[i], [&](std::size_t cell) { in_cells_[at(next[cell]++)] = static_cast<int>(i); });
  }
}

}  // namespace foresight
