#include "benchmarks/rivals/rival_verification.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace foresight {
namespace {

enum class Finding { matched, violating, missing, hidden };

struct Evidence {
  std::vector<int> matched;  // cells, one a matched point
  int facing = 0;
  int contradicting = 0;

  [[nodiscard]] double share() const {
    const double decided = static_cast<double>(matched.size()) + contradicting;
    return decided > 0.0 ? static_cast<double>(matched.size()) / decided : 0.0;
  }
};

struct Tolerances {
  double distance = 0.0;
  float normal_cosine = 0.0F;
};

// Half a cell can lie between a point and the cell it falls into: near edges a neighbour may be the one that shows it.
// Sets `cell` to the one that matches.
Finding look_up(const RivalScene& scene, const Eigen::Vector3d& point, const Eigen::Vector3f& normal,
                const Tolerances& tolerances, int& cell) {
  cell = scene.camera.cell_of(point);
  if (cell < 0) return Finding::hidden;
  const RangeImage& image = *scene.image;
  const int row = cell / image.columns;
  const int column = cell % image.columns;
  bool in_front = false;
  bool behind = false;
  bool near = false;
  for (int r = std::max(0, row - 1); r <= std::min(image.rows - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(image.columns - 1, column + 1); ++c) {
      const int other = image.cell(r, c);
      if (!image.valid(other)) continue;
      const double ahead = static_cast<double>(image[other].z()) - point.z();
      if (ahead > tolerances.distance) {
        in_front = true;
      } else if (ahead < -tolerances.distance || scene.background[static_cast<std::size_t>(other)]) {
        behind = true;  // on the table, too: where an object stands on it, the two cannot be told apart
      } else if (scene.normals[static_cast<std::size_t>(other)].dot(normal) >= tolerances.normal_cosine) {
        cell = other;
        return Finding::matched;
      } else {
        near = true;
      }
    }
  }
  if (behind) return Finding::hidden;
  return in_front || near ? Finding::violating : Finding::missing;
}

Evidence evidence_for(const RivalScene& scene, const SensorModel& sensor, const OrientedPoints& model,
                      const Pose& T_sensor_model, const Tolerances& tolerances) {
  const OrientedPoints facing = facing_points(model, T_sensor_model);
  const Eigen::Matrix3f rotation = T_sensor_model.rotation.cast<float>();
  Evidence evidence;
  evidence.facing = static_cast<int>(facing.size());
  for (std::size_t i = 0; i < facing.size(); ++i) {
    const Eigen::Vector3d point = T_sensor_model * facing.points[i].cast<double>();
    int cell = -1;
    if (point.z() <= 0.0) continue;
    switch (look_up(scene, point, rotation * facing.normals[i], tolerances, cell)) {
      case Finding::matched:
        evidence.matched.push_back(cell);
        break;
      case Finding::violating:
        ++evidence.contradicting;
        break;
      case Finding::missing:
        if (!sensor.background) ++evidence.contradicting;
        break;
      case Finding::hidden:
        break;
    }
  }
  return evidence;
}

int not_explained(const Evidence& evidence, const std::vector<bool>& explained) {
  return static_cast<int>(std::count_if(evidence.matched.begin(), evidence.matched.end(),
                                        [&](int cell) { return !explained[static_cast<std::size_t>(cell)]; }));
}

// The cells around the matched ones, as far as model points lie apart.
void explain(const Evidence& evidence, const RangeImage& image, int reach, std::vector<bool>& explained) {
  for (const int cell : evidence.matched) {
    const int row = cell / image.columns;
    const int column = cell % image.columns;
    for (int r = std::max(0, row - reach); r <= std::min(image.rows - 1, row + reach); ++r) {
      for (int c = std::max(0, column - reach); c <= std::min(image.columns - 1, column + reach); ++c) {
        explained[static_cast<std::size_t>(image.cell(r, c))] = true;
      }
    }
  }
}

}  // namespace

std::vector<ReportedPose> poses_to_report(const RivalScene& scene, const SensorModel& sensor,
                                          const std::vector<OrientedPoints>& models,
                                          const std::vector<PoseCandidate>& candidates,
                                          const RivalVerificationOptions& options) {
  const Tolerances tolerances{std::max(options.distance, options.sigmas * sensor.depth_sigma()),
                              static_cast<float>(std::cos(options.normal_angle))};
  std::vector<Evidence> evidence;
  std::vector<int> open;  // candidates that may be reported
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const OrientedPoints& model = models[static_cast<std::size_t>(candidates[i].object)];
    evidence.push_back(evidence_for(scene, sensor, model, candidates[i].T_sensor_model, tolerances));
    const double visible = static_cast<double>(evidence[i].matched.size()) / std::max(1, evidence[i].facing);
    if (evidence[i].share() >= options.smallest_share && visible >= options.smallest_visible) {
      open.push_back(static_cast<int>(i));
    }
  }

  std::vector<ReportedPose> reported;
  std::vector<bool> explained(static_cast<std::size_t>(scene.image->size()), false);
  while (!open.empty()) {
    const auto of = [&](int i) -> const Evidence& { return evidence[static_cast<std::size_t>(i)]; };
    std::erase_if(open, [&](int i) {
      return not_explained(of(i), explained) < options.smallest_new * static_cast<double>(of(i).matched.size());
    });
    int best = -1;
    double most = 0.0;
    for (const int i : open) {
      const double merit = not_explained(of(i), explained) - options.contradiction * of(i).contradicting;
      if (merit > most) {
        most = merit;
        best = i;
      }
    }
    if (best < 0) break;
    reported.push_back({best, of(best).share()});
    explain(of(best), *scene.image, 1, explained);
    std::erase(open, best);
  }
  return reported;
}

}  // namespace foresight
