#include "common/cell_connectivity.h"

#include <algorithm>
#include <cmath>

namespace foresight {
namespace {

// Decides whether neighbouring cells hold together.
class StepJudge {
 public:
  StepJudge(const Coordinates& points, const SegmentationOptions& options)
      : points_(points),
        noise_(static_cast<float>(4.0 * options.plane_sigma)),
        largest_slope_(static_cast<float>(options.largest_depth_step)) {}

  // Which of `count` cells hold together with the one a stride further because the step is small; 0 or 1.
  void find_small_steps(int first, int count, int stride, unsigned char* is_small) const {
    const float* x = points_.x.data() + first;
    const float* y = points_.y.data() + first;
    const float* z = points_.z.data() + first;
    const float noise = noise_;
    const float slope2 = largest_slope_ * largest_slope_;
    for (int i = 0; i < count; ++i) {
      const float across = x[i + stride] - x[i];
      const float down = y[i + stride] - y[i];
      const float depth = std::abs(z[i + stride] - z[i]) - noise;
      is_small[i] = static_cast<unsigned char>(depth <= 0.0F) |
                    static_cast<unsigned char>(depth * depth <= slope2 * (across * across + down * down));
    }
  }

  // Of a valid cell that is not a small step from the next: cells to the next valid one along a row or column within
  // `room`, 0 when there is none or a depth step lies between. behind: how many cells lie before this one on its row or
  // column.
  [[nodiscard]] int gap_to_next(int cell, int stride, int room, int behind) const {
    for (int gap = 1; gap <= std::min(2, room); ++gap) {
      const int next = cell + gap * stride;
      if (!points_.valid(next)) continue;
      if (within_slope(cell, next, largest_slope_)) return gap;
      // Steps as large as a surface seen at a grazing angle makes them hold together only where the slope goes on.
      constexpr float kGrazingSlope = 20.0F;  // tan 87 degrees
      if (!within_slope(cell, next, kGrazingSlope)) return 0;
      const bool before = behind >= gap && continues(cell - gap * stride, cell, next);
      const bool after = room >= 2 * gap && continues(cell, next, next + gap * stride);
      return before || after ? gap : 0;
    }
    return 0;
  }

 private:
  [[nodiscard]] float depth(int cell) const { return points_.z[static_cast<std::size_t>(cell)]; }

  [[nodiscard]] bool within_slope(int a, int b, float slope) const {
    const auto from = static_cast<std::size_t>(a);
    const auto to = static_cast<std::size_t>(b);
    const float across = points_.x[to] - points_.x[from];
    const float down = points_.y[to] - points_.y[from];
    const float step = std::abs(points_.z[to] - points_.z[from]) - noise_;
    return step <= 0.0F || step * step <= slope * slope * (across * across + down * down);
  }

  // Three cells in a row whose two steps in depth agree.
  [[nodiscard]] bool continues(int a, int b, int c) const {
    if (!points_.valid(a) || !points_.valid(b) || !points_.valid(c)) return false;
    const float first = depth(b) - depth(a);
    const float second = depth(c) - depth(b);
    return std::abs(second - first) <= noise_ + 0.15F * std::min(std::abs(first), std::abs(second));
  }

  const Coordinates& points_;
  float noise_;
  float largest_slope_;
};

}  // namespace

CellConnectivity::CellConnectivity(const Coordinates& points, const SegmentationOptions& options)
    : columns_(points.columns), gaps_(static_cast<std::size_t>(points.size()), 0) {
  const StepJudge judge(points, options);
  PoolVector<unsigned char> steps(static_cast<std::size_t>(columns_));
  for (int row = 0; row < points.rows; ++row) {
    const int first = row * columns_;
    judge.find_small_steps(first, columns_ - 1, 1, steps.data());
    link_small_steps(first, columns_ - 1, 1, kRight, steps.data());
    if (row + 1 == points.rows) continue;
    judge.find_small_steps(first, columns_, columns_, steps.data());
    link_small_steps(first, columns_, columns_, kDown, steps.data());
  }
  const auto is_done = [&](int block) { return all_have(kForwards, block) || !points.any_valid(block); };
  visit_cells(0, points.size(), is_done, [&](int cell) {
    const int gaps = gaps_[static_cast<std::size_t>(cell)];
    if ((gaps & kForwards) == kForwards || !points.valid(cell)) return;
    const int row = cell / columns_;
    const int column = cell % columns_;
    if (right(cell) < 0) link(cell, judge.gap_to_next(cell, 1, columns_ - 1 - column, column), kRight, 1);
    if (down(cell) < 0) link(cell, judge.gap_to_next(cell, columns_, points.rows - 1 - row, row), kDown, columns_);
  });
}

bool CellConnectivity::any_connected(int first) const {
  int any = 0;
  for (int i = 0; i < kBlock; ++i) any |= gaps_[static_cast<std::size_t>(first + i)];
  return any != 0;
}

bool CellConnectivity::all_have(int gaps, int first) const {
  int missing = 0;
  for (int i = 0; i < kBlock; ++i) missing |= ~gaps_[static_cast<std::size_t>(first + i)] & gaps;
  return missing == 0;
}

void CellConnectivity::link_small_steps(int first, int count, int stride, int shift, const unsigned char* is_small) {
  unsigned char* from = gaps_.data() + first;
  unsigned char* to = from + stride;
  for (int i = 0; i < count; ++i) from[i] |= static_cast<unsigned char>(is_small[i] << shift);
  for (int i = 0; i < count; ++i) to[i] |= static_cast<unsigned char>(is_small[i] << (shift + kBackwards));
}

void CellConnectivity::link(int cell, int gap, int shift, int stride) {
  gaps_[static_cast<std::size_t>(cell)] |= static_cast<unsigned char>(gap << shift);
  gaps_[static_cast<std::size_t>(cell + gap * stride)] |= static_cast<unsigned char>(gap << (shift + kBackwards));
}

}  // namespace foresight
