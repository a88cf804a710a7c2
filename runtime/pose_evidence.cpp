#include "runtime/pose_evidence.h"

#include <algorithm>
#include <cmath>

#include "runtime/rendering.h"
#include "runtime/shadow.h"

namespace foresight {
namespace {

constexpr double kDoubt = 30.0;      // cells against every pose, so that a handful of cells for it makes none certain
constexpr int kFewestCells = 12;     // that say something about a face
constexpr double kMuch = 300.0;      // owned cells at which the amount is a half
constexpr double kFewMissing = 0.1;  // share of cells without data that says half of what all without would
constexpr double kLeftOver = 0.2;    // of a region that is explained but for this share nothing remains for others
constexpr double kLeftByLocalization = 0.8;  // Unit: mm.
constexpr double kJudgedCell = 1.2;          // side; finer ones tell little more. Unit: mm.
constexpr double kLeastDistance = 1.5;       // Unit: mm.

// Whether all eight neighbours show the same surface going on: no outline and no inner edge of depth. largest_step():
// of depth between neighbours of one surface, asked for where they are not of one triangle.
template <typename LargestStep>
bool inner(const Rendering& drawn, int row, int column, const LargestStep& largest_step) {
  if (row < 1 || column < 1 || row + 1 >= drawn.rows || column + 1 >= drawn.columns) return false;
  const auto at = static_cast<std::size_t>(drawn.cell(row, column));
  const std::size_t above = at - static_cast<std::size_t>(drawn.columns);
  const std::size_t below = at + static_cast<std::size_t>(drawn.columns);
  const PoolVector<int>& triangle = drawn.triangle;
  const int own = triangle[at];
  bool one_triangle = triangle[at - 1] == own && triangle[at + 1] == own;
  for (const std::size_t middle : {above, below}) {
    one_triangle =
        one_triangle && triangle[middle - 1] == own && triangle[middle] == own && triangle[middle + 1] == own;
  }
  if (one_triangle) return true;
  const float most = largest_step();
  const auto goes_on = [&](std::size_t cell) {
    return triangle[cell] >= 0 && std::abs(drawn.depth[cell] - drawn.depth[at]) <= most;
  };
  for (const std::size_t middle : {above, at, below}) {
    if (!goes_on(middle - 1) || !goes_on(middle) || !goes_on(middle + 1)) return false;
  }
  return true;
}

// Whether all that a sensor that matches windows takes the cell's depth from is drawn on one plane. A corner of the
// window alone changes little: it reaches as far as the middles of its sides. reach: of the window. Unit: cells.
bool amid_plane(const Rendering& drawn, int row, int column, int reach) {
  if (row < reach || column < reach || row + reach >= drawn.rows || column + reach >= drawn.columns) return false;
  const auto triangle = [&](int r, int c) { return drawn.triangle[static_cast<std::size_t>(drawn.cell(r, c))]; };
  const Eigen::Vector3f& normal = drawn.normal[static_cast<std::size_t>(triangle(row, column))];
  const auto goes_on = [&](int r, int c) {
    constexpr float kSameNormal = 0.98F;
    const int other = triangle(r, c);
    return other >= 0 && drawn.normal[static_cast<std::size_t>(other)].dot(normal) >= kSameNormal;
  };
  for (int away = 1; away <= reach; ++away) {
    if (!goes_on(row - away, column) || !goes_on(row + away, column) || !goes_on(row, column - away) ||
        !goes_on(row, column + away))
      return false;
  }
  return true;
}

// A cell of the image in which the object is drawn.
struct DrawnCell {
  int cell = 0;         // of the image, -1 beyond it
  int triangle = 0;     // of the model
  float depth = 0.0F;   // z of the surface drawn. Unit: mm.
  Eigen::Vector3f ray;  // with z = 1
  float facing = 0.0F;  // -normal . ray, with a ray of z = 1: turns a difference of depth into one across the surface
};

// Those before `behind` say nothing about the surface.
enum class Judgement { beyond, shadowed, missing, front, behind, tilted, explained };

Judgement judge(const DrawnCell& cell, const Eigen::Vector3f& normal, const LabelledScan& scan,
                const EvidenceOptions& options) {
  if (cell.cell < 0) return Judgement::beyond;
  const float depth = scan.depths[static_cast<std::size_t>(cell.cell)];
  if (std::isnan(depth))
    return may_be_in_shadow(cell.depth * cell.ray, normal, scan) ? Judgement::shadowed : Judgement::missing;
  const auto distance = static_cast<float>(options.distance);
  const float across = (depth - cell.depth) * cell.facing;
  if (across > distance) return Judgement::behind;
  if (across < -distance) return Judgement::front;
  if (scan.taken[static_cast<std::size_t>(cell.cell)]) return Judgement::tilted;
  const int region = scan.labels[static_cast<std::size_t>(cell.cell)] - 1;
  if (region < 0 ||
      scan.regions[static_cast<std::size_t>(region)].region.normal.dot(normal.cast<double>()) >= options.normal_cosine)
    return Judgement::explained;
  // A sensor that matches windows draws a step as a ramp. Data near a steep surface and yet, along the ray, well before
  // it are those of the box that stands flush and hides the side of this one.
  const bool before = scan.sensor.matching_window > 1 && depth < cell.depth - distance;
  return before ? Judgement::front : Judgement::tilted;
}

// Calls visit(cell, judgement, inner) for each cell looked at that would show the object, row by row.
template <typename Visit>
void look_at_cells(const CompiledModel& model, const Pose& T_sensor_model, const LabelledScan& scan,
                   const EvidenceOptions& options, const Visit& visit) {
  const Rendering drawn = render(model, T_sensor_model, scan.camera, std::max(scan.image.rows, scan.image.columns));
  const int reach = scan.sensor.matching_window / 2;
  const auto distance = static_cast<float>(options.distance);
  const auto steepest = static_cast<float>(std::pow(std::cos(scan.sensor.largest_incidence), 2));
  for (int row = options.stride / 2; row < drawn.rows; row += options.stride) {
    const int image_row = row + drawn.first_row;
    const bool row_in_image = image_row >= 0 && image_row < scan.image.rows;
    for (int column = options.stride / 2; column < drawn.columns; column += options.stride) {
      const auto at = static_cast<std::size_t>(drawn.cell(row, column));
      const int triangle = drawn.triangle[at];
      if (triangle < 0) continue;
      // A ray with z = 1 meets the surface under -normal . ray = height / depth: the cell lies on the triangle's plane.
      const float facing = drawn.height[static_cast<std::size_t>(triangle)] / drawn.depth[at];
      const int image_column = column + drawn.first_column;
      const Eigen::Vector3f direction = scan.camera.ray(image_row, image_column).cast<float>();
      const float ray = direction.squaredNorm();
      if (facing * facing <= steepest * ray) continue;  // the sensor gives no data here
      const bool in_image = row_in_image && image_column >= 0 && image_column < scan.image.columns;
      const DrawnCell cell = {in_image ? scan.image.cell(image_row, image_column) : -1, triangle, drawn.depth[at],
                              direction, facing};
      const auto largest_step = [&] {
        const float cosine = std::max(facing / std::sqrt(ray), 0.05F);
        return distance + 3.0F * drawn.depth[at] / (static_cast<float>(scan.camera.fx) * cosine);
      };
      const bool whole =
          inner(drawn, row, column, largest_step) && (reach == 0 || amid_plane(drawn, row, column, reach));
      visit(cell, judge(cell, drawn.normal[static_cast<std::size_t>(triangle)], scan, options), whole);
    }
  }
}

// Counts judgements. Cells at outlines count only for what regions the object explains.
class Tally {
 public:
  // Each cell counts for `weight`.
  Tally(std::size_t triangles, std::size_t regions, int weight)
      : weight_(weight), of_triangle_(triangles), inner_of_region_(regions, 0) {
    evidence_.explained_of_region.assign(regions, 0);
  }

  void add(int triangle, Judgement judgement, int region, bool inner) {
    const bool explained = judgement == Judgement::explained;
    if (explained && region >= 0) evidence_.explained_of_region[static_cast<std::size_t>(region)] += weight_;
    if (!inner) return;
    evidence_.drawn += weight_;
    evidence_.beyond += judgement == Judgement::beyond ? weight_ : 0;
    evidence_.shadowed += judgement == Judgement::shadowed ? weight_ : 0;
    evidence_.missing += judgement == Judgement::missing ? weight_ : 0;
    evidence_.front += judgement == Judgement::front ? weight_ : 0;
    evidence_.behind += judgement == Judgement::behind ? weight_ : 0;
    evidence_.tilted += judgement == Judgement::tilted ? weight_ : 0;
    if (judgement < Judgement::behind) return;
    Cells& cells = of_triangle_[static_cast<std::size_t>(triangle)];
    cells.judged += weight_;
    if (!explained) return;
    cells.explained += weight_;
    evidence_.explained += weight_;
    if (region >= 0) {
      inner_of_region_[static_cast<std::size_t>(region)] += weight_;
    } else {
      evidence_.owned += weight_;
    }
  }

  // triangle_faces: empty where unknown; then each triangle is a face.
  [[nodiscard]] PoseEvidence sum(const PoolVector<int>& free_cells, const std::vector<int>& triangle_faces) {
    PoolVector<Cells> of_face(of_triangle_.size());
    for (std::size_t t = 0; t < of_triangle_.size(); ++t) {
      Cells& face = of_face[triangle_faces.empty() ? t : static_cast<std::size_t>(triangle_faces[t])];
      face.judged += of_triangle_[t].judged;
      face.explained += of_triangle_[t].explained;
    }
    for (const Cells& face : of_face) {
      evidence_.largest = std::max(evidence_.largest, face.explained);
      if (face.judged < kFewestCells) continue;
      ++evidence_.faces;
      evidence_.faces_found += 2 * face.explained >= face.judged ? 1 : 0;
    }
    for (std::size_t r = 0; r < free_cells.size(); ++r) {
      const double cells = std::max(1, free_cells[r]);
      evidence_.owned += inner_of_region_[r] * std::min(1.0, evidence_.explained_of_region[r] / cells);
    }
    return std::move(evidence_);
  }

 private:
  struct Cells {
    int judged = 0;
    int explained = 0;
  };
  int weight_;
  PoseEvidence evidence_;
  PoolVector<Cells> of_triangle_;
  PoolVector<int> inner_of_region_;
};

}  // namespace

double agreeing_distance(const SensorModel& sensor) {
  return std::max(kLeastDistance, kLeftByLocalization + 3.0 * sensor.depth_sigma());
}

EvidenceOptions judging_options(const SensorModel& sensor) {
  EvidenceOptions options;
  options.distance = agreeing_distance(sensor);
  options.stride = std::max(1, static_cast<int>(kJudgedCell / sensor.cell_size()));
  return options;
}

LabelledScan label_scan(const RangeImage& image, const PinholeCamera& camera, const SensorModel& sensor,
                        const PoolVector<DescribedRegion>& regions) {
  LabelledScan scan{image,
                    camera,
                    sensor,
                    regions,
                    PoolVector<float>(image.points.size()),
                    PoolVector<int>(image.points.size(), 0),
                    PoolVector<bool>(image.points.size(), false),
                    {}};
  for (std::size_t cell = 0; cell < image.points.size(); ++cell) {
    scan.depths[cell] = image.points[cell].z();
    if (scan.depths[cell] < scan.nearest) scan.nearest = scan.depths[cell];
  }
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (const int cell : regions[r].region.cells)
      scan.labels[static_cast<std::size_t>(cell)] = static_cast<int>(r) + 1;
    scan.free_cells.push_back(static_cast<int>(regions[r].region.cells.size()));
  }
  return scan;
}

bool is_taken(const LabelledScan& scan, int region) {
  const auto r = static_cast<std::size_t>(region);
  return 2 * static_cast<std::size_t>(scan.free_cells[r]) <= scan.regions[r].region.cells.size();
}

std::array<double, kEvidenceFeatureCount> evidence_features(const PoseEvidence& evidence) {
  const double drawn = std::max(1, evidence.drawn);
  const int unseen = evidence.front + evidence.beyond + evidence.shadowed;
  const double open = std::max(1, evidence.drawn - unseen);
  std::array<double, kEvidenceFeatureCount> features{};
  features[kOwnedShare] = evidence.owned / (kDoubt + evidence.explained + evidence.behind + evidence.tilted);
  features[kContradictedShare] = (evidence.behind + evidence.tilted) / open;
  features[kMissing] = evidence.missing / (kFewMissing * open + evidence.missing);
  features[kHiddenShare] = unseen / drawn;
  features[kFoundFaces] = evidence.faces_found / (1.0 + evidence.faces);
  features[kAmount] = evidence.owned / (kMuch + evidence.owned);
  features[kOtherSurfaces] =
      evidence.explained > 0 ? 1.0 - static_cast<double>(evidence.largest) / evidence.explained : 0.0;
  features[kHiddenBehindOne] = features[kHiddenShare] * (1.0 - features[kOtherSurfaces]);
  return features;
}

double log_odds_right(const AcceptanceModel& model, const std::array<double, kEvidenceFeatureCount>& features) {
  double sum = model.bias;
  for (std::size_t i = 0; i < features.size(); ++i) sum += model.weights[i] * features[i];
  return sum;
}

double probability_right(const AcceptanceModel& model, const std::array<double, kEvidenceFeatureCount>& features) {
  return 1.0 / (1.0 + std::exp(-log_odds_right(model, features)));
}

double probability_right(const AcceptanceModel& model, const PoseEvidence& evidence) {
  return probability_right(model, evidence_features(evidence));
}

PoseEvidence gather_evidence(const CompiledModel& model, const Pose& T_sensor_model, const LabelledScan& scan,
                             const EvidenceOptions& options) {
  Tally tally(model.triangles.size(), scan.regions.size(), options.stride * options.stride);
  look_at_cells(model, T_sensor_model, scan, options, [&](const DrawnCell& cell, Judgement judgement, bool inner) {
    const int region = cell.cell < 0 ? -1 : scan.labels[static_cast<std::size_t>(cell.cell)] - 1;
    tally.add(cell.triangle, judgement, region, inner);
  });
  return tally.sum(scan.free_cells, model.triangle_faces);
}

void take(LabelledScan& scan, int cell) {
  const auto at = static_cast<std::size_t>(cell);
  if (scan.taken[at]) return;
  scan.taken[at] = true;
  if (scan.labels[at] > 0) --scan.free_cells[static_cast<std::size_t>(scan.labels[at] - 1)];
}

void take_explained(const CompiledModel& model, const Pose& T_sensor_model, const EvidenceOptions& options,
                    LabelledScan& scan) {
  EvidenceOptions each = options;
  each.stride = 1;
  PoolVector<int> explained;
  look_at_cells(model, T_sensor_model, scan, each, [&](const DrawnCell& cell, Judgement judgement, bool) {
    if (judgement == Judgement::explained) explained.push_back(cell.cell);
  });
  for (const int cell : explained) take(scan, cell);
  for (std::size_t r = 0; r < scan.regions.size(); ++r) {
    const PoolVector<int>& cells = scan.regions[r].region.cells;
    if (scan.free_cells[r] > kLeftOver * static_cast<double>(cells.size())) continue;
    for (const int cell : cells) take(scan, cell);
  }
}

}  // namespace foresight
