#include "runtime/face_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace foresight {
namespace {

constexpr std::size_t kBeam = 8;         // layouts followed at once
constexpr std::size_t kBranches = 8;     // next faces tried for each
constexpr std::size_t kCandidates = 40;  // faces looked at for one that is certain
constexpr double kFaceCost = 0.012;      // of the region: what one face more has to explain
constexpr double kKindCost = 0.03;       // of the region: what one more size of faces has to explain
constexpr double kMostOverlap = 0.06;    // of a face with those laid before

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
  FaceLayer(const PlaneGrid& grid, const std::vector<Rectangle>& faces, const OutlineDoubt& doubt,
            const FlushFaceOptions& options)
      : grid_(grid),
        margin_(doubt.margin),
        loss_(doubt.loss),
        options_(options),
        unknown_(grid.unknown, grid.rows, grid.columns),
        behind_(grid.behind, grid.rows, grid.columns),
        whole_(grid.filled, grid.rows, grid.columns),
        nodes_(whole_.in(0, grid.rows, 0, grid.columns)) {
    for (const Rectangle& rectangle : faces) {
      sizes_.push_back({static_cast<int>(std::lround(rectangle.across / grid.step)),
                        static_cast<int>(std::lround(rectangle.along / grid.step))});
    }
  }

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

}  // namespace

std::vector<Tile> lay_faces(const PlaneGrid& grid, const std::vector<Rectangle>& faces, const OutlineDoubt& doubt,
                            const FlushFaceOptions& options) {
  return FaceLayer(grid, faces, doubt, options).run();
}

}  // namespace foresight
