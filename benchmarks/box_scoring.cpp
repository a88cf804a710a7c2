#include "benchmarks/box_scoring.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "runtime/rendering.h"

namespace foresight {
namespace {

// A drawn box over the whole image grid.
class DrawnBox {
 public:
  DrawnBox(const CompiledModel& model, const Pose& T_sensor_model, const RangeImage& image, const PinholeCamera& camera)
      : drawn_(render(model, T_sensor_model, camera)), image_(image), camera_(camera) {}

  [[nodiscard]] bool covers(int cell) const { return place_of(cell).has_value(); }

  // Distance of the cell's data point from the plane drawn there: both lie on one ray. REQUIRES: covered, with data.
  [[nodiscard]] double residual(int cell) const {
    const std::size_t place = *place_of(cell);
    const auto triangle = static_cast<std::size_t>(drawn_.triangle[place]);
    const Eigen::Vector3d ray = camera_.ray(cell / image_.columns, cell % image_.columns);
    const double along = static_cast<double>(image_[cell].z() - drawn_.depth[place]);
    return std::abs(along * drawn_.normal[triangle].cast<double>().dot(ray));
  }

  // Ascending.
  [[nodiscard]] std::vector<int> cells() const {
    std::vector<int> covered;
    for (int row = 0; row < drawn_.rows; ++row) {
      for (int column = 0; column < drawn_.columns; ++column) {
        const int cell = image_.cell(drawn_.first_row + row, drawn_.first_column + column);
        if (covers(cell)) covered.push_back(cell);
      }
    }
    return covered;
  }

 private:
  // In the rendering's window; none where the box is not drawn.
  [[nodiscard]] std::optional<std::size_t> place_of(int cell) const {
    const int row = cell / image_.columns - drawn_.first_row;
    const int column = cell % image_.columns - drawn_.first_column;
    if (row < 0 || row >= drawn_.rows || column < 0 || column >= drawn_.columns) return std::nullopt;
    const auto place = static_cast<std::size_t>(drawn_.cell(row, column));
    return drawn_.triangle[place] >= 0 ? std::optional(place) : std::nullopt;
  }

  Rendering drawn_;
  const RangeImage& image_;
  const PinholeCamera& camera_;
};

DrawnOnCells drawn_on(const DrawnBox& box, const RangeImage& image, const std::vector<int>& cells) {
  std::vector<double> residuals;
  long covered = 0;
  for (const int cell : cells) {
    if (!box.covers(cell)) continue;
    ++covered;
    if (image.valid(cell)) residuals.push_back(box.residual(cell));
  }
  DrawnOnCells result{0.0, std::numeric_limits<double>::infinity()};
  if (!cells.empty()) result.share = static_cast<double>(covered) / static_cast<double>(cells.size());
  if (residuals.empty()) return result;
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  result.residual = *middle;
  return result;
}

struct Pairing {
  double share;
  std::size_t report, mask;
};

// Every report with every mask it explains, the greatest share first.
std::vector<Pairing> explained(const std::vector<DrawnBox>& boxes, const std::vector<ReportedObject>& reported,
                               const RangeImage& image, const std::vector<BoxMask>& masks,
                               const BoxScoringOptions& options) {
  std::vector<Pairing> pairings;
  for (std::size_t r = 0; r < reported.size(); ++r) {
    for (std::size_t m = 0; m < masks.size(); ++m) {
      if (masks[m].object != reported[r].object) continue;
      const DrawnOnCells drawn = drawn_on(boxes[r], image, masks[m].cells);
      if (drawn.share >= options.smallest_share && drawn.residual <= options.largest_residual)
        pairings.push_back({drawn.share, r, m});
    }
  }
  std::stable_sort(pairings.begin(), pairings.end(),
                   [](const Pairing& a, const Pairing& b) { return a.share > b.share; });
  return pairings;
}

// Whether a box lies on a surface, almost clear of the masks.
bool lies_beside(const DrawnBox& box, const BoxScene& scene, const BoxScoringOptions& options) {
  const std::vector<int> cells = box.cells();
  const auto with_data = std::count_if(cells.begin(), cells.end(), [&](int cell) { return scene.image.valid(cell); });
  if (static_cast<double>(with_data) < options.smallest_share * static_cast<double>(cells.size())) return false;
  long masked = 0;
  for (const BoxMask& mask : scene.masks) {
    std::vector<int> common;
    std::set_intersection(cells.begin(), cells.end(), mask.cells.begin(), mask.cells.end(), std::back_inserter(common));
    masked += static_cast<long>(common.size());
  }
  return static_cast<double>(masked) <= options.largest_elsewhere * static_cast<double>(cells.size()) &&
         drawn_on(box, scene.image, cells).residual <= options.largest_residual;
}

}  // namespace

DrawnOnCells drawn_on(const CompiledModel& model, const Pose& T_sensor_model, const RangeImage& image,
                      const PinholeCamera& camera, const std::vector<int>& cells) {
  return drawn_on(DrawnBox(model, T_sensor_model, image, camera), image, cells);
}

BoxVerdicts score_boxes(const BoxScene& scene, const std::vector<ReportedObject>& reported,
                        const BoxScoringOptions& options) {
  std::vector<DrawnBox> boxes;
  for (const ReportedObject& report : reported) {
    boxes.emplace_back(scene.models[static_cast<std::size_t>(report.object)], report.T_sensor_model, scene.image,
                       scene.camera);
  }
  BoxVerdicts verdicts;
  verdicts.report_of_mask.assign(scene.masks.size(), -1);
  std::vector<std::optional<BoxVerdict>> decided(reported.size());
  const std::vector<Pairing> pairings = explained(boxes, reported, scene.image, scene.masks, options);
  for (const Pairing& pairing : pairings) {
    int& holder = verdicts.report_of_mask[pairing.mask];
    if (holder >= 0 || decided[pairing.report]) continue;
    holder = static_cast<int>(pairing.report);
    decided[pairing.report] = BoxVerdict::found;
  }
  for (const Pairing& pairing : pairings) {
    if (!decided[pairing.report]) decided[pairing.report] = BoxVerdict::duplicate;
  }
  for (const Pairing& pairing : explained(boxes, reported, scene.image, scene.uncounted, options)) {
    if (!decided[pairing.report]) decided[pairing.report] = BoxVerdict::unmasked;
  }
  for (std::size_t r = 0; r < reported.size(); ++r) {
    verdicts.reported.push_back(decided[r]                              ? *decided[r]
                                : lies_beside(boxes[r], scene, options) ? BoxVerdict::unmasked
                                                                        : BoxVerdict::invented);
  }
  return verdicts;
}

}  // namespace foresight
