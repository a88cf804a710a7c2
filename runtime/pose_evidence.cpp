#include "runtime/pose_evidence.h"

#include <algorithm>
#include <cmath>

#include "runtime/rendering.h"

namespace foresight {
namespace {

// Whether all eight neighbours show the same surface going on: no outline and no inner edge of depth.
bool inner(const Rendering& drawn, int row, int column, double step) {
  if (row < 1 || column < 1 || row + 1 >= drawn.rows || column + 1 >= drawn.columns) return false;
  const float depth = drawn.depth[static_cast<std::size_t>(drawn.cell(row, column))];
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = column - 1; c <= column + 1; ++c) {
      const auto cell = static_cast<std::size_t>(drawn.cell(r, c));
      if (drawn.triangle[cell] < 0 || std::abs(drawn.depth[cell] - depth) > step) return false;
    }
  }
  return true;
}

// Whether a region that lies on the drawn surface is none of it.
bool contradicts(const LabelledScan& scan, std::size_t region, const Eigen::Vector3d& normal,
                 const EvidenceOptions& options) {
  return scan.taken[region] || scan.regions[region].region.normal.dot(normal) < options.normal_cosine;
}

}  // namespace

LabelledScan label_scan(const RangeImage& image, const PinholeCamera& camera, const SensorModel& sensor,
                        const std::vector<DescribedRegion>& regions) {
  LabelledScan scan{image,
                    camera,
                    sensor,
                    regions,
                    std::vector<int>(image.points.size(), 0),
                    std::vector<bool>(regions.size(), false)};
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (const int cell : regions[r].region.cells)
      scan.labels[static_cast<std::size_t>(cell)] = static_cast<int>(r) + 1;
  }
  return scan;
}

std::array<double, kEvidenceFeatureCount> evidence_features(const PoseEvidence& evidence) {
  const double drawn = std::max(1, evidence.drawn);
  std::array<double, kEvidenceFeatureCount> features{};
  features[kOwnedShare] = evidence.owned / std::max(1, evidence.drawn - evidence.front);
  features[kContradictedShare] = (evidence.behind + evidence.tilted) / drawn;
  features[kMissingShare] = evidence.missing / drawn;
  features[kHiddenShare] = evidence.front / drawn;
  features[kLogExplained] = 0.1 * std::log1p(evidence.explained);
  features[kFoundFaces] = static_cast<double>(evidence.faces_found) / std::max(1, evidence.faces);
  return features;
}

double probability_right(const AcceptanceModel& model, const PoseEvidence& evidence) {
  const auto features = evidence_features(evidence);
  double sum = model.bias;
  for (std::size_t i = 0; i < features.size(); ++i) sum += model.weights[i] * features[i];
  return 1.0 / (1.0 + std::exp(-sum));
}

PoseEvidence gather_evidence(const CompiledModel& model, const Pose& T_sensor_model, const LabelledScan& scan,
                             const EvidenceOptions& options) {
  PoseEvidence evidence;
  evidence.explained_of_region.assign(scan.regions.size(), 0);
  const Rendering drawn = render(model, T_sensor_model, scan.camera);
  const double steepest = std::cos(scan.sensor.largest_incidence);
  std::vector<std::array<int, 2>> of_triangle(model.triangles.size(), {0, 0});  // drawn, explained
  std::vector<int> explained_inner(scan.regions.size(), 0);
  double squares = 0.0;
  for (int row = 0; row < drawn.rows; ++row) {
    for (int column = 0; column < drawn.columns; ++column) {
      const auto at = static_cast<std::size_t>(drawn.cell(row, column));
      const int triangle = drawn.triangle[at];
      if (triangle < 0) continue;
      const Eigen::Vector3f& normal = drawn.normal[static_cast<std::size_t>(triangle)];
      const Eigen::Vector3d ray = scan.camera.ray(row + drawn.first_row, column + drawn.first_column);
      const double facing = -normal.cast<double>().dot(ray);  // times |ray|: the cosine of incidence
      if (facing <= steepest * ray.norm()) continue;          // the sensor gives no data here
      const int cell = scan.image.cell(row + drawn.first_row, column + drawn.first_column);
      // A cell's own depth changes by this much across its sides.
      const double slope = drawn.depth[at] / scan.camera.fx / std::max(facing, 0.05);
      const bool counts = inner(drawn, row, column, options.distance + 3.0 * slope);
      if (counts) {
        ++evidence.drawn;
        ++of_triangle[static_cast<std::size_t>(triangle)][0];
      }
      if (!scan.image.valid(cell)) {
        if (counts) ++evidence.missing;
        continue;
      }
      const double across = (static_cast<double>(scan.image[cell].z()) - drawn.depth[at]) * facing;  // along -normal
      if (std::abs(across) > options.distance) {
        if (counts) ++(across > 0.0 ? evidence.behind : evidence.front);
        continue;
      }
      const int region = scan.labels[static_cast<std::size_t>(cell)] - 1;
      if (region >= 0 && contradicts(scan, static_cast<std::size_t>(region), normal.cast<double>(), options)) {
        if (counts) ++evidence.tilted;
        continue;
      }
      if (region >= 0) ++evidence.explained_of_region[static_cast<std::size_t>(region)];
      if (!counts) continue;
      ++evidence.explained;
      ++of_triangle[static_cast<std::size_t>(triangle)][1];
      squares += across * across;
      if (region >= 0) {
        ++explained_inner[static_cast<std::size_t>(region)];
      } else {
        evidence.owned += 1.0;
      }
    }
  }
  for (std::size_t r = 0; r < scan.regions.size(); ++r) {
    const double cells = static_cast<double>(scan.regions[r].region.cells.size());
    evidence.owned += explained_inner[r] * std::min(1.0, evidence.explained_of_region[r] / cells);
  }
  for (const auto& [shown, explained] : of_triangle) {
    if (shown < 12) continue;
    ++evidence.faces;
    evidence.faces_found += 2 * explained >= shown ? 1 : 0;
  }
  if (evidence.explained > 0) evidence.residual = std::sqrt(squares / evidence.explained);
  return evidence;
}

}  // namespace foresight
