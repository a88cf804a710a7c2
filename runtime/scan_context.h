// What the stages after the field need to know about one scan, and the steps they share.
#pragma once

#include <chrono>

#include "common/camera.h"
#include "common/memory_pool.h"
#include "common/range_image.h"
#include "common/region_attributes.h"
#include "common/viewing_sphere.h"
#include "runtime/database.h"
#include "runtime/nearest_data.h"
#include "runtime/recognize.h"

namespace foresight {

struct ScanContext {
  const RangeImage& image;
  const PinholeCamera& camera;
  const Database& database;
  const PoolVector<DescribedRegion>& regions;
  const NearestData& data;
  ViewingSphere sphere{kAspectCells};
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

// Localization and verification of a start, counted and timed in the result.
[[nodiscard]] RefinedPose refine(const ScanContext& scan, const CompiledModel& model, const Pose& start,
                                 const RecognizeOptions& options, Recognition& result, Stopwatch& watch);

// Whether the limits of the options or the deadline end the search.
[[nodiscard]] bool limits_reached(const RecognizeOptions& options, const Deadline& deadline, Recognition& result);

}  // namespace foresight
