// The runtime's order of stages.
#pragma once

#include <chrono>
#include <optional>

#include "common/camera.h"
#include "common/pose.h"
#include "common/range_image.h"
#include "runtime/database.h"
#include "runtime/foresight.h"
#include "runtime/localization.h"
#include "runtime/verification.h"

namespace foresight {

void check(const RecognizeOptions& options);  // throws UsageError

using Deadline = std::optional<std::chrono::steady_clock::time_point>;

// Recognizes on valid input; throws nothing.
[[nodiscard]] RecognitionResult recognize(const RangeImage& image, const PinholeCamera& camera, const Database& database,
                                          const RecognizeOptions& options, const Deadline& deadline = {});


// One given pose of one model, refined and verified.
struct RefinedPose {
  Localization localization;
  Verification verification;
};
// A refined pose as a detection: pose, fractions and score; no rank, faces or regions yet.
[[nodiscard]] Detection to_detection(const CompiledModel& model, const RefinedPose& refined);

[[nodiscard]] RefinedPose refine_and_verify(const RangeImage& image, const PinholeCamera& camera, const CompiledModel& model,
                                            const Pose& T_sensor_model, const RecognizeOptions& options);

}  // namespace foresight
