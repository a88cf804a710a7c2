#include "common/region_boundary.h"

#include <array>
#include <cmath>

namespace foresight {
namespace {

struct Step {
  int row;
  int column;
};
constexpr std::array<Step, 4> kSteps = {{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};

class BoundaryReader {
 public:
  BoundaryReader(const std::vector<Region>& regions, const RangeImage& image, const PinholeCamera& camera,
                 const BoundaryOptions& options)
      : image_(image), camera_(camera), options_(options), labels_(label_image(regions, image.size())) {}

  [[nodiscard]] double cut_share(const Region& region, int label) const {
    int steps = 0;
    int cut = 0;
    for (const int cell : region.cells) {
      for (const Step& step : kSteps) {
        if (label_at(cell / image_.columns + step.row, cell % image_.columns + step.column) == label) continue;
        ++steps;
        cut += goes_on_unseen(region, label, cell, step) ? 1 : 0;
      }
    }
    return steps > 0 ? static_cast<double>(cut) / steps : 0.0;
  }

 private:
  [[nodiscard]] bool inside(int row, int column) const {
    return row >= 0 && row < image_.rows && column >= 0 && column < image_.columns;
  }
  // -1 outside the image.
  [[nodiscard]] int label_at(int row, int column) const {
    return inside(row, column) ? labels_[static_cast<std::size_t>(image_.cell(row, column))] : -1;
  }

  [[nodiscard]] bool goes_on_unseen(const Region& region, int label, int cell, const Step& step) const {
    int row = cell / image_.columns + step.row;
    int column = cell % image_.columns + step.column;
    if (!inside(row, column)) return true;
    bool gap = false;
    while (inside(row, column) && label_at(row, column) == 0) {
      gap = true;
      row += step.row;
      column += step.column;
    }
    if (!inside(row, column)) return false;
    // The same region again: a hole in it. What hides a hole has no region, and hides little.
    if (label_at(row, column) == label) return false;
    const Eigen::Vector3d ray = camera_.ray(row, column);
    const double facing = -region.normal.dot(ray);
    if (!(facing > 0.0)) return false;  // the region's plane is not in sight there
    const double plane_depth = -region.offset / facing;
    const double depth = image_[image_.cell(row, column)].z();
    const double tolerance = options_.depth_step * depth / camera_.fx;
    if (depth < plane_depth - tolerance) return true;
    return gap && depth < plane_depth + tolerance;
  }

  const RangeImage& image_;
  const PinholeCamera& camera_;
  const BoundaryOptions& options_;
  std::vector<int> labels_;
};

}  // namespace

std::vector<double> cut_shares(const std::vector<Region>& regions, const RangeImage& image, const PinholeCamera& camera,
                               const BoundaryOptions& options) {
  const BoundaryReader reader(regions, image, camera, options);
  std::vector<double> shares;
  shares.reserve(regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    shares.push_back(reader.cut_share(regions[r], static_cast<int>(r) + 1));
  }
  return shares;
}

}  // namespace foresight
