#include "common/cell_connectivity.h"

#include <algorithm>
#include <cmath>

namespace foresight {
namespace {

// Decides whether neighbouring cells hold together.
class StepJudge {
 public:
  StepJudge(const RangeImage& image, const SegmentationOptions& options)
      : image_(image),
        noise_(static_cast<float>(4.0 * options.plane_sigma)),
        largest_slope_(static_cast<float>(options.largest_depth_step)) {}

  // Cells to the next valid one along a row or column within `room`, 0 when there is none or a depth step lies between.
  // behind: how many cells lie before this one on its row or column.
  [[nodiscard]] int gap_to_next(int cell, int stride, int room, int behind) const {
    for (int gap = 1; gap <= std::min(2, room); ++gap) {
      const int next = cell + gap * stride;
      if (!image_.valid(next)) continue;
      if (small_step(cell, next)) return gap;
      if (!grazing_step(cell, next)) return 0;
      const bool before = behind >= gap && continues(cell - gap * stride, cell, next);
      const bool after = room >= 2 * gap && continues(cell, next, next + gap * stride);
      return before || after ? gap : 0;
    }
    return 0;
  }

 private:
  // Small steps always hold together; steps as large as a surface seen at a grazing angle makes them, only where the
  // slope goes on.
  [[nodiscard]] bool small_step(int a, int b) const { return within_slope(a, b, largest_slope_); }
  [[nodiscard]] bool grazing_step(int a, int b) const {
    constexpr float kGrazingSlope = 20.0F;  // tan 87 degrees
    return within_slope(a, b, kGrazingSlope);
  }
  [[nodiscard]] bool within_slope(int a, int b, float slope) const {
    const Eigen::Vector3f step = image_[b] - image_[a];
    const float depth = std::abs(step.z()) - noise_;
    return depth <= 0.0F || depth * depth <= slope * slope * step.head<2>().squaredNorm();
  }

  // Three cells in a row whose two steps in depth agree.
  [[nodiscard]] bool continues(int a, int b, int c) const {
    if (!image_.valid(a) || !image_.valid(b) || !image_.valid(c)) return false;
    const float first = image_[b].z() - image_[a].z();
    const float second = image_[c].z() - image_[b].z();
    return std::abs(second - first) <= noise_ + 0.15F * std::min(std::abs(first), std::abs(second));
  }

  const RangeImage& image_;
  float noise_;
  float largest_slope_;
};

}  // namespace

CellConnectivity::CellConnectivity(const RangeImage& image, const SegmentationOptions& options)
    : columns_(image.columns), gaps_(static_cast<std::size_t>(image.size()), 0) {
  const StepJudge judge(image, options);
  const auto link = [&](int cell, int gap, int shift, int stride) {
    gaps_[static_cast<std::size_t>(cell)] |= static_cast<unsigned char>(gap << shift);
    gaps_[static_cast<std::size_t>(cell + gap * stride)] |= static_cast<unsigned char>(gap << (shift + 4));
  };
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const int cell = image.cell(row, column);
      if (!image.valid(cell)) continue;
      if (const int gap = judge.gap_to_next(cell, 1, image.columns - 1 - column, column); gap > 0)
        link(cell, gap, 0, 1);
      if (const int gap = judge.gap_to_next(cell, image.columns, image.rows - 1 - row, row); gap > 0)
        link(cell, gap, 2, image.columns);
    }
  }
}

}  // namespace foresight
