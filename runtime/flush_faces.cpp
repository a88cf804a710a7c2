#include "runtime/flush_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/plane_fit.h"
#include "common/region_boundary.h"
#include "runtime/pose_evidence.h"
#include "runtime/start_poses.h"

namespace foresight {
namespace {

constexpr double kRectangular = 0.97;    // of the smallest rectangle around a face that the face fills
constexpr double kLargeFace = 0.7;       // of the model's largest rectangle: goods lie on large faces, narrow ones fit
                                         // into any outline
constexpr double kSameSize = 1.0;        // rectangles that differ by less are one. Unit: mm.
constexpr double kFinest = 25.0;         // nodes across the narrowest rectangle
constexpr std::size_t kBeam = 8;         // layouts followed at once
constexpr std::size_t kBranches = 8;     // next faces tried for each
constexpr std::size_t kCandidates = 40;  // faces looked at for one that is certain
constexpr double kFaceCost = 0.012;      // of the region: what one face more has to explain
constexpr double kKindCost = 0.03;       // of the region: what one more size of faces has to explain
constexpr double kMostOverlap = 0.06;    // of a face with those laid before

// Full lengths of a rectangular face. Unit: mm.
struct Rectangle {
  double along = 0.0;
  double across = 0.0;
};

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

// A grid in the plane of a region, along the directions in which most of the region's border runs.
struct PlaneGrid {
  Eigen::Vector3d origin, u, v;
  double step = 1.0;  // Unit: mm.
  int rows = 0, columns = 0;
  std::vector<char> filled;   // by node: the region's
  std::vector<char> unknown;  // by node: the face may go on there: data of another region in the plane, none, no image
  std::vector<char> behind;   // by node: nothing of the plane is there, the sensor saw something farther

  [[nodiscard]] std::size_t at(int row, int column) const { return static_cast<std::size_t>(row * columns + column); }
};

// Counts in rectangles of the grid; what lies beyond it is empty.
class GridCounts {
 public:
  GridCounts(const std::vector<char>& nodes, int rows, int columns)
      : rows_(rows), columns_(columns), sums_(static_cast<std::size_t>((rows + 1) * (columns + 1)), 0) {
    for (int row = 0; row < rows; ++row) {
      int of_row = 0;
      for (int column = 0; column < columns; ++column) {
        of_row += nodes[static_cast<std::size_t>(row * columns + column)];
        sums_[at(row + 1, column + 1)] = sums_[at(row, column + 1)] + of_row;
      }
    }
  }
  // first included, last not.
  [[nodiscard]] int in(int first_row, int last_row, int first_column, int last_column) const {
    const int top = std::clamp(first_row, 0, rows_);
    const int bottom = std::clamp(last_row, top, rows_);
    const int left = std::clamp(first_column, 0, columns_);
    const int right = std::clamp(last_column, left, columns_);
    return sums_[at(bottom, right)] - sums_[at(top, right)] - sums_[at(bottom, left)] + sums_[at(top, left)];
  }

 private:
  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row * (columns_ + 1) + column);
  }
  int rows_, columns_;
  std::vector<int> sums_;
};

// A face laid on the grid: first included, last not. Both may lie beyond the grid.
struct Tile {
  int first_row = 0, last_row = 0, first_column = 0, last_column = 0;
  double value = 0.0;     // how well it sits: share filled and share of the outline at which nothing goes on
  double outline = 0.0;   // of it, where the region itself ends
  double seen_end = 0.0;  // of it, where something farther is seen beyond

  [[nodiscard]] int rows() const { return last_row - first_row; }
  [[nodiscard]] int columns() const { return last_column - first_column; }
  [[nodiscard]] int area() const { return rows() * columns(); }
  [[nodiscard]] bool holds(int row, int column) const {
    return row >= first_row && row < last_row && column >= first_column && column < last_column;
  }
};

struct Layout {
  std::vector<Tile> tiles;
  std::vector<char> rest;   // by node: of the region and of no tile
  std::vector<char> taken;  // by node: of a tile
  double value = 0.0;
  int left = 0;  // nodes of the rest
};

// Share of the nodes just beyond a tile's outline that are counted.
double share_beyond(const Tile& tile, const GridCounts& counts, int margin) {
  const int above = counts.in(tile.first_row - margin, tile.first_row, tile.first_column, tile.last_column);
  const int below = counts.in(tile.last_row, tile.last_row + margin, tile.first_column, tile.last_column);
  const int left = counts.in(tile.first_row, tile.last_row, tile.first_column - margin, tile.first_column);
  const int right = counts.in(tile.first_row, tile.last_row, tile.last_column, tile.last_column + margin);
  return static_cast<double>(above + below + left + right) / (2.0 * margin * (tile.rows() + tile.columns()));
}

// Share of a tile's outline just inside which there is something, allowing for what the sensor rounds off.
double filled_outline(const Tile& tile, const GridCounts& filled, int margin, int loss) {
  const int top = tile.first_row + margin + loss;
  const int bottom = tile.last_row - margin - loss;
  const int left = tile.first_column + margin + loss;
  const int right = tile.last_column - margin - loss;
  const int along_rows = filled.in(top, top + margin, left, right) + filled.in(bottom - margin, bottom, left, right);
  const int along_columns = filled.in(top, bottom, left, left + margin) + filled.in(top, bottom, right - margin, right);
  return static_cast<double>(along_rows + along_columns) / (2.0 * margin * (right - left + bottom - top));
}

class FaceLayer {
 public:
  FaceLayer(const PlaneGrid& grid, const KnownFaces& known, int margin, int loss, const FlushFaceOptions& options)
      : grid_(grid),
        margin_(margin),
        loss_(loss),
        options_(options),
        unknown_(grid.unknown, grid.rows, grid.columns),
        behind_(grid.behind, grid.rows, grid.columns),
        whole_(grid.filled, grid.rows, grid.columns),
        nodes_(whole_.in(0, grid.rows, 0, grid.columns)) {
    for (const Rectangle& rectangle : known.rectangles) {
      sizes_.push_back({static_cast<int>(std::lround(rectangle.across / grid.step)),
                        static_cast<int>(std::lround(rectangle.along / grid.step))});
    }
  }

  // The layout of least cost of the whole region, with faces of one size or of any. Where there is none, the tiles that
  // the outline of the region speaks for by itself.
  [[nodiscard]] std::vector<Tile> run() const {
    std::vector<Tile> best;
    double least_cost = std::numeric_limits<double>::max();
    for (const Size& size : sizes_) {
      if (size.first <= size.second) lay_out(faces_of(size), best, least_cost);
    }
    lay_out(sizes_, best, least_cost);
    return best.empty() ? certain_tiles() : best;
  }

 private:
  using Size = std::pair<int, int>;  // rows, columns

  // A size, both ways round.
  [[nodiscard]] std::vector<Size> faces_of(const Size& size) const {
    std::vector<Size> faces = {size};
    if (size.first != size.second) faces.emplace_back(size.second, size.first);
    return faces;
  }

  // Layouts of ever more tiles, the best few of each count. Keeps the whole one of least cost: what fits the outline
  // best, and of two that fit alike the one of fewer faces.
  void lay_out(const std::vector<Size>& sizes, std::vector<Tile>& best, double& least_cost) const {
    std::vector<Layout> layouts = {{{}, grid_.filled, std::vector<char>(grid_.filled.size(), 0), 0.0, nodes_}};
    const auto worth = [&](const Layout& layout) {
      return layout.value - kKindCost * nodes_ * static_cast<double>(kinds(layout));
    };
    for (int count = 1; count <= options_.most_faces && count * kFaceCost + kKindCost < least_cost; ++count) {
      std::vector<Layout> next;
      for (const Layout& layout : layouts) extend(layout, sizes, next);
      if (next.empty()) break;
      std::stable_sort(next.begin(), next.end(), [&](const Layout& a, const Layout& b) { return worth(a) > worth(b); });
      if (next.size() > kBeam) next.resize(kBeam);
      for (const Layout& layout : next) {
        if (misfit(layout) > options_.largest_misfit || seen_end(layout) < options_.least_seen_end ||
            cost(layout) >= least_cost)
          continue;
        least_cost = cost(layout);
        best = layout.tiles;
      }
      layouts = std::move(next);
    }
  }

  // One after the other, tiles that end where the region ends, or where one that is certain begins.
  [[nodiscard]] std::vector<Tile> certain_tiles() const {
    Layout layout{{}, grid_.filled, std::vector<char>(grid_.filled.size(), 0), 0.0, nodes_};
    while (static_cast<int>(layout.tiles.size()) < options_.most_faces) {
      const GridCounts rest(layout.rest, grid_.rows, grid_.columns);
      const std::vector<Tile> tiles = best_tiles(layout, sizes_, kCandidates);
      const auto next = std::find_if(tiles.begin(), tiles.end(), [&](const Tile& tile) {
        const double outline = 1.0 - share_beyond(tile, rest, margin_) - share_beyond(tile, unknown_, margin_);
        return outline >= options_.least_outline && tile.seen_end >= options_.least_seen_end;
      });
      if (next == tiles.end()) break;
      lay(*next, layout);
    }
    return layout.tiles;
  }

  // Sizes of faces, whichever way round.
  [[nodiscard]] static std::size_t kinds(const Layout& layout) {
    std::vector<std::pair<int, int>> found;
    for (const Tile& tile : layout.tiles) {
      const std::pair<int, int> size = std::minmax(tile.rows(), tile.columns());
      if (std::find(found.begin(), found.end(), size) == found.end()) found.push_back(size);
    }
    return found.size();
  }

  // What a layout leaves over, and what reaches beyond the region more than the sensor takes from its edges; as a share
  // of the region.
  [[nodiscard]] double misfit(const Layout& layout) const {
    double missing = 0.0;
    for (const Tile& tile : layout.tiles) {
      const int filled = whole_.in(tile.first_row, tile.last_row, tile.first_column, tile.last_column);
      const double lost = 2.0 * loss_ * (tile.rows() + tile.columns() - 2 * loss_);
      missing += std::max(0.0, tile.area() - filled - lost);
    }
    return (layout.left + missing) / nodes_;
  }
  // Of all outlines of its faces.
  [[nodiscard]] static double seen_end(const Layout& layout) {
    double ends = 0.0;
    double outlines = 0.0;
    for (const Tile& tile : layout.tiles) {
      ends += tile.seen_end * (tile.rows() + tile.columns());
      outlines += tile.rows() + tile.columns();
    }
    return ends / outlines;
  }
  [[nodiscard]] double cost(const Layout& layout) const {
    return misfit(layout) + kFaceCost * static_cast<double>(layout.tiles.size()) +
           kKindCost * static_cast<double>(kinds(layout));
  }

  void lay(const Tile& tile, Layout& layout) const {
    layout.tiles.push_back(tile);
    layout.value += tile.value * tile.area();
    for (int row = std::max(0, tile.first_row); row < std::min(grid_.rows, tile.last_row); ++row) {
      for (int column = std::max(0, tile.first_column); column < std::min(grid_.columns, tile.last_column); ++column) {
        const std::size_t node = grid_.at(row, column);
        layout.left -= layout.rest[node];
        layout.rest[node] = 0;
        layout.taken[node] = 1;
      }
    }
  }

  void extend(const Layout& layout, const std::vector<Size>& sizes, std::vector<Layout>& next) const {
    for (const Tile& tile : best_tiles(layout, sizes, kBranches)) {
      Layout longer = layout;
      lay(tile, longer);
      if (std::none_of(next.begin(), next.end(), [&](const Layout& other) { return other.taken == longer.taken; }))
        next.push_back(std::move(longer));
    }
  }

  [[nodiscard]] std::vector<Tile> best_tiles(const Layout& layout, const std::vector<Size>& sizes,
                                             std::size_t most) const {
    const GridCounts rest(layout.rest, grid_.rows, grid_.columns);
    const GridCounts taken(layout.taken, grid_.rows, grid_.columns);
    std::vector<Tile> best;
    for (const auto& [height, width] : sizes) {
      for (int row = -margin_; row + height <= grid_.rows + margin_; ++row) {
        for (int column = -margin_; column + width <= grid_.columns + margin_; ++column) {
          Tile tile{row, row + height, column, column + width};
          const double fill = static_cast<double>(rest.in(row, row + height, column, column + width)) / tile.area();
          if (fill < options_.least_fill || std::min(tile.rows(), tile.columns()) <= 4 * margin_ + 2 * loss_) continue;
          if (taken.in(row, row + height, column, column + width) > kMostOverlap * tile.area()) continue;
          const double sides = filled_outline(tile, rest, margin_, loss_);
          if (sides < options_.least_sides) continue;
          tile.value = fill + sides - 1.0 - share_beyond(tile, rest, margin_) - share_beyond(tile, unknown_, margin_);
          if (tile.value > 0.0) consider(best, tile, most);
        }
      }
    }
    for (Tile& tile : best) {
      tile.outline = 1.0 - share_beyond(tile, whole_, margin_) - share_beyond(tile, unknown_, margin_);
      tile.seen_end = share_beyond(tile, behind_, margin_);
    }
    return best;
  }

  // Keeps the best few that are not all but the same.
  void consider(std::vector<Tile>& best, const Tile& tile, std::size_t most) const {
    const auto worth = [](const Tile& t) { return t.value * t.area(); };
    const auto alike = [&](const Tile& other) {
      return std::abs(other.first_row - tile.first_row) <= margin_ &&
             std::abs(other.last_row - tile.last_row) <= margin_ &&
             std::abs(other.first_column - tile.first_column) <= margin_ &&
             std::abs(other.last_column - tile.last_column) <= margin_;
    };
    const auto same = std::find_if(best.begin(), best.end(), alike);
    if (same != best.end()) {
      if (worth(*same) >= worth(tile)) return;
      best.erase(same);
    } else if (best.size() == most) {
      if (worth(best.back()) >= worth(tile)) return;
      best.pop_back();
    }
    const auto place = std::find_if(best.begin(), best.end(), [&](const Tile& t) { return worth(t) < worth(tile); });
    best.insert(place, tile);
  }

  const PlaneGrid& grid_;
  int margin_;
  int loss_;
  const FlushFaceOptions& options_;
  GridCounts unknown_;
  GridCounts behind_;
  GridCounts whole_;
  int nodes_;
  std::vector<Size> sizes_;
};

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
    if (fits_a_face(smallest_rectangle(region.hull, region.region.normal), known_, 2.0 * (edge - loss))) return {};
    const PlaneGrid grid = lay_grid(region, std::max(spacing, known_.narrowest / kFinest), loss);
    const int margin = std::max(1, static_cast<int>(std::lround(edge / grid.step)));
    const int loss_nodes = static_cast<int>(std::lround(loss / grid.step));
    if (share_ending(grid, margin + loss_nodes) < options_.least_seen_end) return {};
    const std::vector<Tile> tiles = FaceLayer(grid, known_, margin, loss_nodes, options_).run();
    if (tiles.empty()) return {};
    return share_out(region.region, grid, tiles, margin);
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
