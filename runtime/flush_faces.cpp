#include "runtime/flush_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/plane_fit.h"
#include "common/region_boundary.h"
#include "runtime/face_layout.h"
#include "runtime/pose_evidence.h"
#include "runtime/start_poses.h"

namespace foresight {
namespace {

constexpr double kRectangular = 0.97;   // of the smallest rectangle around a face that the face fills
constexpr double kLargeFace = 0.7;      // of the model's largest rectangle: goods lie on large faces, narrow ones fit
                                        // into any outline
constexpr double kSameSize = 1.0;       // rectangles that differ by less are one. Unit: mm.
constexpr double kMostNodes = 40000.0;  // of a grid
constexpr double kFinest = 25.0;        // nodes across the narrowest rectangle

struct KnownFaces {
  std::vector<Rectangle> rectangles;               // both ways round
  std::vector<std::array<double, 2>> all_extents;  // of the smallest rectangles around all faces, longer side first
  double largest_area = 0.0;                       // of a rectangle. Unit: mm^2.
  double narrowest = std::numeric_limits<double>::max();
};

KnownFaces known_faces(const Database& database) {
  KnownFaces known;
  const FaceShapes shapes(database);
  const auto add = [&](double along, double across) {
    for (const Rectangle& other : known.rectangles) {
      if (std::abs(other.along - along) < kSameSize && std::abs(other.across - across) < kSameSize) return;
    }
    known.rectangles.push_back({along, across});
  };
  std::vector<double> largest(database.models().size(), 0.0);  // rectangle, by model. Unit: mm^2.
  const auto is_rectangle = [](const ModelFace& face, const std::array<double, 2>& extents) {
    return face.area >= kRectangular * extents[0] * extents[1];
  };
  for (const FaceIndex& index : database.faces()) {
    const ModelFace& face =
        database.models()[static_cast<std::size_t>(index.model)].faces[static_cast<std::size_t>(index.face)];
    if (shapes.vertices(index.model, index.face).empty()) continue;
    double& area = largest[static_cast<std::size_t>(index.model)];
    if (is_rectangle(face, shapes.frame(index.model, index.face).extents)) area = std::max(area, face.area);
  }
  for (const FaceIndex& index : database.faces()) {
    const ModelFace& face =
        database.models()[static_cast<std::size_t>(index.model)].faces[static_cast<std::size_t>(index.face)];
    if (shapes.vertices(index.model, index.face).empty()) continue;
    const std::array<double, 2>& extents = shapes.frame(index.model, index.face).extents;
    known.all_extents.push_back(extents);
    if (!is_rectangle(face, extents) || face.area < kLargeFace * largest[static_cast<std::size_t>(index.model)])
      continue;
    add(extents[0], extents[1]);
    add(extents[1], extents[0]);
    known.largest_area = std::max(known.largest_area, extents[0] * extents[1]);
    known.narrowest = std::min(known.narrowest, extents[1]);
  }
  return known;
}

// Whether a face is large enough for all of the region.
bool fits_a_face(const PatchFrame& region, const KnownFaces& known, double edge) {
  return std::any_of(known.all_extents.begin(), known.all_extents.end(), [&](const std::array<double, 2>& face) {
    return region.extents[0] <= face[0] + edge && region.extents[1] <= face[1] + edge;
  });
}

class RegionParter {
 public:
  RegionParter(const RangeImage& image, const PinholeCamera& camera, const Database& database,
               const FlushFaceOptions& options)
      : image_(image), camera_(camera), options_(options), known_(known_faces(database)) {
    const SensorModel& sensor = database.content().sensor;
    edge_cells_ = 1.0 + 0.25 * (sensor.matching_window - 1);
    loss_cells_ = 0.38 * (sensor.matching_window - 1);
    tolerance_ = agreeing_distance(sensor);
    smallest_region_ = database.content().segmentation.smallest_region;
  }

  // The parts of a region and its rest; empty when it stays whole.
  [[nodiscard]] std::vector<Region> part(const DescribedRegion& region) const {
    const double area = region.attributes[kArea];
    if (known_.rectangles.empty() || area > options_.most_faces * known_.largest_area) return {};
    const double spacing = std::sqrt(area / static_cast<double>(region.region.cells.size()));
    const double edge = edge_cells_ * spacing;
    const double loss = loss_cells_ * spacing;
    const PatchFrame frame = smallest_rectangle(region.hull, region.region.normal);
    if (fits_a_face(frame, known_, 2.0 * (edge - loss))) return {};
    const double finest =
        std::max(known_.narrowest / kFinest, std::sqrt(frame.extents[0] * frame.extents[1] / kMostNodes));
    const PlaneGrid grid = lay_grid(region, std::max(spacing, finest), loss);
    const OutlineDoubt doubt{std::max(1, static_cast<int>(std::lround(edge / grid.step))),
                             static_cast<int>(std::lround(loss / grid.step))};
    if (share_ending(grid, doubt.margin + doubt.loss) < options_.least_seen_end) return {};
    const std::vector<Tile> tiles = lay_faces(grid, known_.rectangles, doubt, options_);
    if (tiles.empty()) return {};
    return share_out(region.region, grid, tiles, doubt.margin);
  }

 private:
  // Where the ray of a cell meets the region's plane.
  [[nodiscard]] Eigen::Vector3d on_plane(const Region& region, int cell) const {
    const Eigen::Vector3d ray = camera_.ray(cell / image_.columns, cell % image_.columns);
    return region.offset / region.normal.dot(ray) * ray;
  }

  [[nodiscard]] PlaneGrid lay_grid(const DescribedRegion& described, double step, double loss) const {
    const Region& region = described.region;
    PlaneGrid grid;
    grid.step = step;
    grid.u = main_direction(described, step);
    grid.v = region.normal.cross(grid.u);
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
    Eigen::Vector2d high = -low;
    for (const Eigen::Vector3d& point : described.hull) {
      const Eigen::Vector2d place(grid.u.dot(point), grid.v.dot(point));
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
    }
    // The border of the grid is as wide as what is looked at beyond outlines.
    low -= Eigen::Vector2d::Constant(2.0 * loss + 3.0 * step);
    high += Eigen::Vector2d::Constant(2.0 * loss + 3.0 * step);
    grid.origin = region.offset * region.normal + low.x() * grid.u + low.y() * grid.v;
    grid.columns = 1 + static_cast<int>((high.x() - low.x()) / step);
    grid.rows = 1 + static_cast<int>((high.y() - low.y()) / step);
    std::vector<char> own(static_cast<std::size_t>(image_.size()), 0);
    for (const int cell : region.cells) own[static_cast<std::size_t>(cell)] = 1;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const Eigen::Vector3d point = grid.origin + (column + 0.5) * step * grid.u + (row + 0.5) * step * grid.v;
        const int cell = camera_.cell_of(point);
        const bool has_data = cell >= 0 && image_.valid(cell);
        const bool is_own = has_data && own[static_cast<std::size_t>(cell)] != 0;
        const double farther = has_data ? region.offset - region.normal.dot(image_[cell].cast<double>()) : 0.0;
        grid.filled.push_back(is_own ? 1 : 0);
        grid.unknown.push_back(!is_own && std::abs(farther) <= tolerance_ ? 1 : 0);
        grid.behind.push_back(!is_own && farther > tolerance_ ? 1 : 0);
      }
    }
    return grid;
  }

  // Of what lies beside the region, the share that is farther away.
  [[nodiscard]] static double share_ending(const PlaneGrid& grid, int margin) {
    const GridCounts filled(grid.filled, grid.rows, grid.columns);
    long beside = 0;
    long behind = 0;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const std::size_t node = grid.at(row, column);
        if (grid.filled[node] != 0 ||
            filled.in(row - margin, row + margin + 1, column - margin, column + margin + 1) == 0)
          continue;
        ++beside;
        behind += grid.behind[node];
      }
    }
    return beside > 0 ? static_cast<double>(behind) / static_cast<double>(beside) : 0.0;
  }

  // The direction in the plane along and across which the border of the region lies in few lines.
  [[nodiscard]] Eigen::Vector3d main_direction(const DescribedRegion& described, double step) const {
    constexpr int kDirections = 90;
    const Region& region = described.region;
    std::vector<Eigen::Vector3d> border;
    for (const int cell : region.cells) {
      for (const int next : {cell - 1, cell + 1, cell - image_.columns, cell + image_.columns}) {
        if (std::binary_search(region.cells.begin(), region.cells.end(), next)) continue;
        border.push_back(on_plane(region, cell));
        break;
      }
    }
    const Eigen::Vector3d first = described.major_axis;
    const Eigen::Vector3d second = region.normal.cross(first);
    Eigen::Vector3d best = first;
    long most = -1;
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 0.5 * std::numbers::pi * k / kDirections;
      const Eigen::Vector3d direction = std::cos(angle) * first + std::sin(angle) * second;
      const long lines =
          concentration(border, direction, step) + concentration(border, region.normal.cross(direction), step);
      if (lines <= most) continue;
      most = lines;
      best = direction;
    }
    return best;
  }

  // Sum of squared counts of points in stripes across a direction.
  [[nodiscard]] static long concentration(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& across,
                                          double step) {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (const Eigen::Vector3d& point : points) {
      low = std::min(low, across.dot(point));
      high = std::max(high, across.dot(point));
    }
    std::vector<long> counts(2 + static_cast<std::size_t>((high - low) / step), 0);
    for (const Eigen::Vector3d& point : points) ++counts[static_cast<std::size_t>((across.dot(point) - low) / step)];
    long sum = 0;
    for (const long count : counts) sum += count * count;
    return sum;
  }

  // Cells to the tiles they lie on, or beside within the margin; what is left becomes the last region.
  [[nodiscard]] std::vector<Region> share_out(const Region& region, const PlaneGrid& grid,
                                              const std::vector<Tile>& tiles, int margin) const {
    std::vector<std::vector<int>> cells(tiles.size() + 1);
    for (const int cell : region.cells) {
      const Eigen::Vector3d place = on_plane(region, cell) - grid.origin;
      const int column = static_cast<int>(std::floor(grid.u.dot(place) / grid.step));
      const int row = static_cast<int>(std::floor(grid.v.dot(place) / grid.step));
      std::size_t owner = tiles.size();
      int least = margin + 1;
      for (std::size_t t = 0; t < tiles.size(); ++t) {
        const int beside = std::max({0, tiles[t].first_row - row, row + 1 - tiles[t].last_row,
                                     tiles[t].first_column - column, column + 1 - tiles[t].last_column});
        if (beside >= least) continue;
        least = beside;
        owner = t;
      }
      cells[owner].push_back(cell);
    }
    std::vector<Region> parts;
    for (std::vector<int>& of_part : cells) {
      if (static_cast<int>(of_part.size()) >= smallest_region_) parts.push_back(fitted(std::move(of_part)));
    }
    return parts;
  }

  [[nodiscard]] Region fitted(std::vector<int> cells) const {
    PointSums sums;
    for (const int cell : cells) sums.add(image_[cell].cast<double>());
    const Plane plane = sums.fit();
    return {std::move(cells), plane.normal, plane.offset, std::sqrt(sums.mean_squared_distance(plane))};
  }

  const RangeImage& image_;
  const PinholeCamera& camera_;
  const FlushFaceOptions& options_;
  KnownFaces known_;
  double edge_cells_ = 0.0;  // that the outline of a region is uncertain by
  double loss_cells_ = 0.0;  // that a region ends before its face does, at steps in depth
  double tolerance_ = 0.0;   // of data in a plane. Unit: mm.
  int smallest_region_ = 0;
};

}  // namespace

std::vector<DescribedRegion> part_flush_faces(std::vector<DescribedRegion> regions, const RangeImage& image,
                                              const PinholeCamera& camera, const Database& database,
                                              const FlushFaceOptions& options) {
  const RegionParter parter(image, camera, database, options);
  std::vector<Region> parted;
  bool changed = false;
  for (const DescribedRegion& region : regions) {
    std::vector<Region> parts = parter.part(region);
    changed = changed || !parts.empty();
    if (parts.empty()) {
      parted.push_back(region.region);
    } else {
      std::move(parts.begin(), parts.end(), std::back_inserter(parted));
    }
  }
  if (!changed) return regions;
  std::stable_sort(parted.begin(), parted.end(),
                   [](const Region& a, const Region& b) { return a.cells.size() > b.cells.size(); });
  const std::vector<double> cut = cut_shares(parted, image, camera);
  std::vector<DescribedRegion> described;
  for (std::size_t r = 0; r < parted.size(); ++r) {
    described.push_back(describe(std::move(parted[r]), image, camera));
    described.back().cut_share = cut[r];
  }
  return described;
}

}  // namespace foresight
