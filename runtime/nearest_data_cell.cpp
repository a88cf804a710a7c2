#include "runtime/nearest_data_cell.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace foresight {
namespace {

constexpr float kOffRay = 0.5F;  // data may lie this far from their rays. Unit: cells.
constexpr int kFine = 4;         // sides of blocks. Unit: cells.
constexpr int kCoarse = 16;

float square(float x) { return x * x; }

// First and last of the numbers 0 to count - 1 that lie within `reach` of a place; all before or behind: the nearest.
struct Span {
  int first;
  int last;
};
Span span_around(float place, float reach, int count) {
  const auto most = static_cast<float>(count - 1);
  return {static_cast<int>(std::clamp(std::floor(place - reach), 0.0F, most)),
          static_cast<int>(std::clamp(std::ceil(place + reach), 0.0F, most))};
}

// How far a place lies from the numbers first to first + count - 1.
float beside(float place, int first, int count) {
  return std::max({0.0F, static_cast<float>(first) - place, place - static_cast<float>(first + count - 1)});
}

RangeImage thinned(const RangeImage& image, int stride) {
  RangeImage few((image.rows + stride - 1) / stride, (image.columns + stride - 1) / stride);
  for (int row = 0; row < few.rows; ++row) {
    for (int column = 0; column < few.columns; ++column) {
      few[few.cell(row, column)] = image[image.cell(row * stride, column * stride)];
    }
  }
  return few;
}

}  // namespace

// The rays of a column are a plane through the camera, and so are those of a row. A point's distance from such a plane
// d columns beside it is z d / fx times the cosine of the plane's slant, which is least at the border of the image.
// Distances p, q, r from planes whose normals n_i have |n_i . n_j| = c_ij need a distance x with
// p^2 + q^2 + r^2 <= x^2 (1 + max over i of the sum of c_ij) (Gershgorin, for the largest eigenvalue of n_i . n_j).
NearestDataCell::NearestDataCell(const RangeImage& image, const PinholeCamera& camera, int stride)
    : stride_(stride),
      columns_(image.columns),
      thinned_(stride > 1 ? thinned(image, stride) : RangeImage()),
      image_(stride > 1 ? thinned_ : image),
      fx_(static_cast<float>(camera.fx / stride)),
      fy_(static_cast<float>(camera.fy / stride)),
      cx_(static_cast<float>(camera.cx / stride)),
      cy_(static_cast<float>(camera.cy / stride)),
      fine_(blocks_of(image_, kFine)),
      coarse_(blocks_of(image_, kCoarse)) {
  assert(camera.rows == image.rows && camera.columns == image.columns);
  const auto steepest = [](double centre, int cells, double focal) {
    return (std::max(centre, cells - centre) + 1.0) / focal;
  };
  const double along = steepest(camera.cx, camera.columns, camera.fx);
  const double down = steepest(camera.cy, camera.rows, camera.fy);
  const double long_side = std::sqrt(1.0 + along * along);
  const double down_side = std::sqrt(1.0 + down * down);
  column_step_ = static_cast<float>(stride / (camera.fx * long_side));
  row_step_ = static_cast<float>(stride / (camera.fy * down_side));
  const double of_planes = along * down / (long_side * down_side);
  const double of_depth = along / long_side + down / down_side;
  aside_ = static_cast<float>(1.0 / (1.0 + of_planes));
  anywhere_ = static_cast<float>(1.0 / (1.0 + std::max(of_depth, of_planes + std::max(along, down))));
}

NearestDataCell::Blocks NearestDataCell::blocks_of(const RangeImage& image, int side) {
  Blocks blocks;
  blocks.side = side;
  blocks.rows = (image.rows + side - 1) / side;
  blocks.columns = (image.columns + side - 1) / side;
  blocks.depths.resize(static_cast<std::size_t>(blocks.rows) * static_cast<std::size_t>(blocks.columns));
  for (int row = 0; row < image.rows; ++row) {
    Depths* depths = &blocks.depths[static_cast<std::size_t>(row / side) * static_cast<std::size_t>(blocks.columns)];
    for (int column = 0; column < image.columns; ++column) {
      const float depth = image[image.cell(row, column)].z();
      Depths& block = depths[column / side];
      if (depth < block.least) block.least = depth;  // never so without data: NaN
      if (depth > block.most) block.most = depth;
    }
  }
  return blocks;
}

NearestData::Answer NearestDataCell::find(const Eigen::Vector3f& query) const {
  return find_within(query, std::numeric_limits<float>::max());
}

NearestData::Answer NearestDataCell::find(const Eigen::Vector3f& query, int guess) const {
  return find_within(query, std::numeric_limits<float>::max(), guess);
}

struct NearestDataCell::Search {
  const NearestDataCell& data;
  const Eigen::Vector3f& query;
  float row, column;  // of the query in the image
  float squared;      // distance of the nearest so far
  int cell = -1;      // it

  void look_at(int first, int last) {
    for (int c = first; c <= last; ++c) {
      const float distance = (data.image_[c] - query).squaredNorm();
      if (distance < squared) {  // never so without data: NaN
        squared = distance;
        cell = c;
      }
    }
  }
  // Whether a block may hold anything nearer.
  [[nodiscard]] bool may_hold(const Blocks& blocks, int block_row, int block_column) const {
    const Depths& depths =
        blocks.depths[static_cast<std::size_t>(block_row) * static_cast<std::size_t>(blocks.columns) +
                      static_cast<std::size_t>(block_column)];
    const float depth = std::max({0.0F, depths.least - query.z(), query.z() - depths.most});
    const float along = std::max(0.0F, beside(column, block_column * blocks.side, blocks.side) - kOffRay);
    const float down = std::max(0.0F, beside(row, block_row * blocks.side, blocks.side) - kOffRay);
    const float aside = square(along * data.column_step_ * query.z()) + square(down * data.row_step_ * query.z());
    return depth * depth < squared && aside * data.aside_ < squared &&
           (aside + depth * depth) * data.anywhere_ < squared;
  }
  void look_at_fine(int block_row, int block_column) {
    if (!may_hold(data.fine_, block_row, block_column)) return;
    const RangeImage& image = data.image_;
    const int last_column = std::min(image.columns, (block_column + 1) * kFine) - 1;
    for (int r = block_row * kFine; r < std::min(image.rows, (block_row + 1) * kFine); ++r) {
      look_at(image.cell(r, block_column * kFine), image.cell(r, last_column));
    }
  }
  // Of a coarse block, the fine ones that lie in a window of fine blocks.
  void look_at_coarse(int block_row, int block_column, const Span& rows, const Span& columns) {
    if (!may_hold(data.coarse_, block_row, block_column)) return;
    constexpr int kInside = kCoarse / kFine;
    const int last_row = std::min(rows.last, block_row * kInside + kInside - 1);
    const int last_column = std::min(columns.last, block_column * kInside + kInside - 1);
    for (int r = std::max(rows.first, block_row * kInside); r <= last_row; ++r) {
      for (int c = std::max(columns.first, block_column * kInside); c <= last_column; ++c) look_at_fine(r, c);
    }
  }
};

NearestData::Answer NearestDataCell::find_within(const Eigen::Vector3f& query, float reach, int guess) const {
  assert(query.allFinite() && reach > 0.0F);
  const Answer nothing = {query, -1, reach, -1};
  if (!(query.z() > 0.0F)) return nothing;
  Search search{*this, query, fy_ * query.y() / query.z() + cy_, fx_ * query.x() / query.z() + cx_, reach * reach};
  if (guess >= 0) search.look_at(guess, guess);
  // The block that the query falls into, and then all that may hold anything nearer than what that one does.
  const Span middle_row = span_around(search.row, 0.0F, image_.rows);
  const Span middle_column = span_around(search.column, 0.0F, image_.columns);
  search.look_at_fine(middle_row.first / kFine, middle_column.first / kFine);
  const float radius = std::sqrt(search.squared / aside_) / query.z();
  const auto blocks = [](const Span& cells) { return Span{cells.first / kFine, cells.last / kFine}; };
  const Span rows = blocks(span_around(search.row, radius / row_step_ + kOffRay, image_.rows));
  const Span columns = blocks(span_around(search.column, radius / column_step_ + kOffRay, image_.columns));
  constexpr int kInside = kCoarse / kFine;
  for (int r = rows.first / kInside; r <= rows.last / kInside; ++r) {
    for (int c = columns.first / kInside; c <= columns.last / kInside; ++c) {
      search.look_at_coarse(r, c, rows, columns);
    }
  }
  if (search.cell < 0) return nothing;
  const int row = search.cell / image_.columns * stride_;
  const int cell = row * columns_ + search.cell % image_.columns * stride_;
  return {image_[search.cell], cell, std::sqrt(search.squared), search.cell};
}

}  // namespace foresight
