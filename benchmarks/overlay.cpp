#include "benchmarks/overlay.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/scan_file.h"

namespace foresight {
namespace {

constexpr Colour kNoData = {18, 22, 40};
constexpr double kNearPlane = 1.0;  // nothing nearer the sensor is drawn. Unit: mm.

struct DepthRange {
  float nearest = std::numeric_limits<float>::infinity();
  float farthest = 0.0F;
};

DepthRange depth_range(const RangeImage& image) {
  DepthRange range;
  for (int cell = 0; cell < image.size(); ++cell) {
    if (!image.valid(cell)) continue;
    range.nearest = std::min(range.nearest, image[cell].z());
    range.farthest = std::max(range.farthest, image[cell].z());
  }
  return range;
}

// Cosine between surface and line of sight from the cells two steps away, which smooths noise; 0.7 where they are
// missing.
double facing(const RangeImage& image, int row, int column) {
  constexpr int kStep = 2;
  if (row < kStep || column < kStep || row >= image.rows - kStep || column >= image.columns - kStep) return 0.7;
  const int left = image.cell(row, column - kStep);
  const int right = image.cell(row, column + kStep);
  const int above = image.cell(row - kStep, column);
  const int below = image.cell(row + kStep, column);
  if (!image.valid(left) || !image.valid(right) || !image.valid(above) || !image.valid(below)) return 0.7;
  const Eigen::Vector3f normal = (image[right] - image[left]).cross(image[below] - image[above]);
  const Eigen::Vector3f sight = image[image.cell(row, column)];
  const float length = normal.norm() * sight.norm();
  return length > 0.0F ? std::abs(static_cast<double>(normal.dot(sight) / length)) : 0.7;
}

Eigen::Vector3d triangle_normal(std::span<const Eigen::Vector3d> vertices, const std::array<int, 3>& triangle) {
  const auto vertex = [&](int corner) {
    return vertices[static_cast<std::size_t>(triangle[static_cast<std::size_t>(corner)])];
  };
  return (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).normalized();
}

void draw_line(Picture& picture, const Eigen::Vector2d& from, const Eigen::Vector2d& to, const LineStyle& style) {
  const double longest = (to - from).cwiseAbs().maxCoeff();
  const int steps = std::max(1, static_cast<int>(std::ceil(longest)));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d at = from + (to - from) * (static_cast<double>(i) / steps);
    const int column = static_cast<int>(std::lround(at.x())) - style.width / 2;
    const int row = static_cast<int>(std::lround(at.y())) - style.width / 2;
    for (int k = 0; k < style.width * style.width; ++k)
      picture.paint(row + k / style.width, column + k % style.width, style.colour);
  }
}

// Cuts the part of a segment before the near plane off. False when nothing is left.
bool cut_near(Eigen::Vector3d& from, Eigen::Vector3d& to) {
  if (from.z() < kNearPlane && to.z() < kNearPlane) return false;
  if (from.z() >= kNearPlane && to.z() >= kNearPlane) return true;
  const Eigen::Vector3d crossing = from + (to - from) * ((kNearPlane - from.z()) / (to.z() - from.z()));
  (from.z() < kNearPlane ? from : to) = crossing;
  return true;
}

// Cuts a line to the picture (Liang and Barsky, "A new concept and method for line clipping", 1984). False when it
// misses.
bool cut_to_picture(const Picture& picture, Eigen::Vector2d& from, Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  double enter = 0.0;
  double leave = 1.0;
  const auto edge = [&](double rate, double room) {
    if (rate == 0.0) return room >= 0.0;
    (rate < 0.0 ? enter : leave) = rate < 0.0 ? std::max(enter, room / rate) : std::min(leave, room / rate);
    return enter <= leave;
  };
  if (!edge(-along.x(), from.x()) || !edge(along.x(), picture.columns - 1 - from.x())) return false;
  if (!edge(-along.y(), from.y()) || !edge(along.y(), picture.rows - 1 - from.y())) return false;
  const Eigen::Vector2d start = from;
  from = start + enter * along;
  to = start + leave * along;
  return true;
}

}  // namespace

void Picture::paint(int row, int column, const Colour& colour) {
  if (row < 0 || column < 0 || row >= rows || column >= columns) return;
  std::copy(colour.begin(), colour.end(), rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(row) * columns + column));
}

Picture shade(const RangeImage& image) {
  Picture picture{image.rows, image.columns, std::vector<unsigned char>(3 * static_cast<std::size_t>(image.size()))};
  const DepthRange range = depth_range(image);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const int cell = image.cell(row, column);
      Colour colour = kNoData;
      if (image.valid(cell)) {
        const double span = std::max(1.0F, range.farthest - range.nearest);
        const double nearness = (range.farthest - image[cell].z()) / span;
        const double grey = (40.0 + 150.0 * facing(image, row, column)) * (0.75 + 0.25 * nearness);
        colour.fill(static_cast<unsigned char>(std::clamp(grey, 0.0, 255.0)));
      }
      picture.paint(row, column, colour);
    }
  }
  return picture;
}

std::vector<ModelEdge> model_edges(std::span<const Eigen::Vector3d> vertices,
                                   std::span<const std::array<int, 3>> triangles, double angle) {
  std::map<std::pair<int, int>, std::vector<Eigen::Vector3d>> meeting;  // normals of the triangles at each edge
  for (const auto& triangle : triangles) {
    const Eigen::Vector3d normal = triangle_normal(vertices, triangle);
    for (std::size_t i = 0; i < 3; ++i) {
      meeting[std::minmax({triangle[i], triangle[(i + 1) % 3]})].push_back(normal);
    }
  }
  std::vector<ModelEdge> edges;
  for (const auto& [ends, normals] : meeting) {
    if (normals.size() == 2 && normals[0].cross(normals[1]).norm() < std::sin(angle) &&
        normals[0].dot(normals[1]) > 0.0)
      continue;
    edges.push_back({vertices[static_cast<std::size_t>(ends.first)],
                     vertices[static_cast<std::size_t>(ends.second)],
                     {normals.front(), normals.back()}});
  }
  return edges;
}

void draw_edges(Picture& picture, const PinholeCamera& camera, std::span<const ModelEdge> edges,
                const Pose& T_sensor_model, const LineStyle& style) {
  const Eigen::Vector3d eye = T_sensor_model.inverse().translation;  // of the sensor, in the model frame
  for (const ModelEdge& edge : edges) {
    const auto looks_away = [&](const Eigen::Vector3d& normal) { return normal.dot(eye - edge.from) <= 0.0; };
    if (!style.far_side && looks_away(edge.normals[0]) && looks_away(edge.normals[1])) continue;
    Eigen::Vector3d from = T_sensor_model * edge.from;
    Eigen::Vector3d to = T_sensor_model * edge.to;
    if (!cut_near(from, to)) continue;
    Eigen::Vector2d start = camera.project(from);
    Eigen::Vector2d end = camera.project(to);
    if (cut_to_picture(picture, start, end)) draw_line(picture, start, end, style);
  }
}

Colour object_colour(int index) {
  static constexpr std::array<Colour, 8> kColours = {{{240, 80, 60},
                                                      {70, 200, 90},
                                                      {70, 150, 255},
                                                      {250, 200, 40},
                                                      {220, 90, 220},
                                                      {60, 215, 215},
                                                      {255, 140, 40},
                                                      {170, 130, 255}}};
  return kColours[static_cast<std::size_t>(index) % kColours.size()];
}

void write_picture(const std::string& file, const Picture& picture) {
  write_rgb_png(file, picture.rows, picture.columns, picture.rgb);
}

}  // namespace foresight
