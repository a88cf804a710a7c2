// What the stages after the field need to know about one scan, and the steps they share.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "common/camera.h"
#include "common/range_image.h"
#include "common/region_attributes.h"
#include "common/viewing_sphere.h"
#include "runtime/database.h"
#include "runtime/hypothesis_cliques.h"
#include "runtime/nearest_data_point.h"
#include "runtime/recognize.h"

namespace foresight {

struct ScanContext {
  const RangeImage& image;
  const PinholeCamera& camera;
  const Database& database;
  const std::vector<DescribedRegion>& regions;
  const HypothesisField& field;
  NearestDataPoint data;
  ViewingSphere sphere{kAspectCells};

  [[nodiscard]] const CompiledModel& model(const ObjectHypothesis& hypothesis) const {
    return database.models()[static_cast<std::size_t>(hypothesis.model)];
  }
  [[nodiscard]] const Match& match(int index) const { return field.matches[static_cast<std::size_t>(index)]; }
};

// Adds the time since the last lap to a stage.
class Stopwatch {
 public:
  void lap(double& stage) {
    const auto now = std::chrono::steady_clock::now();
    stage += std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// The pose of a hypothesis's matches, none where they do not determine one.
[[nodiscard]] std::optional<Pose> estimate_pose(const ScanContext& scan, const ObjectHypothesis& hypothesis);

// Whether the hypothesis rests on a region that is taken.
[[nodiscard]] bool uses_any(const ScanContext& scan, const ObjectHypothesis& hypothesis,
                            const std::vector<bool>& taken);

// Localization and verification of a start, counted and timed in the result.
[[nodiscard]] RefinedPose refine(const ScanContext& scan, const ObjectHypothesis& hypothesis, const Pose& start,
                                 const RecognizeOptions& options, RecognitionResult& result, Stopwatch& watch);

// Which of the equivalent poses of a symmetric object a detection holds.
enum class EquivalentPose { canonical, as_found };

// A refined pose with the hypothesis it came of. rank: from 1. Where the canonical pose is another one than the refined
// one, the faces are those that lie at it where the matched ones lay: faces[i] is in sight as regions[i] either way.
[[nodiscard]] Detection make_detection(const ScanContext& scan, const ObjectHypothesis& hypothesis,
                                       const RefinedPose& refined, int rank,
                                       EquivalentPose pose = EquivalentPose::canonical);

// Whether the limits of the options or the deadline end the search.
[[nodiscard]] bool limits_reached(const RecognizeOptions& options, const Deadline& deadline, RecognitionResult& result);

}  // namespace foresight
