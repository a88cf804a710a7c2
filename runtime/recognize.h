// The runtime's order of stages.
#pragma once

#include <array>
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

// Throws DatabaseError naming the file when the method of the options needs what the database does not hold.
void check_method(const RecognizeOptions& options, const Database& database, const std::string& file);

// A reported T_sensor_model, row by row.
[[nodiscard]] Pose pose_of(const std::array<double, 16>& T);

// The options of single stages.
[[nodiscard]] LocalizationOptions localization_options(const RecognizeOptions& options);
[[nodiscard]] VerificationOptions verification_options(const RecognizeOptions& options);

using Deadline = std::optional<std::chrono::steady_clock::time_point>;

// Recognizes on valid input; throws nothing. REQUIRES: check_method passes.
[[nodiscard]] RecognitionResult recognize(const RangeImage& image, const PinholeCamera& camera,
                                          const Database& database, const RecognizeOptions& options,
                                          const Deadline& deadline = {});

// One given pose of one model, refined and verified.
struct RefinedPose {
  Localization localization;
  Verification verification;
};
// Of the CAD model's vertices, along the model's axes. Unit: mm.
struct BoundingBox {
  std::array<double, 3> centre{};
  std::array<double, 3> size{};
};
[[nodiscard]] BoundingBox bounding_box(const CompiledModel& model);

// A refined pose as a detection: pose, box, fractions and score; no rank, faces, regions or covariance yet.
[[nodiscard]] Detection to_detection(const CompiledModel& model, const RefinedPose& refined);

// Fills in the covariance. sensor: its noise. REQUIRES: the detection is of the model.
void add_covariance(const RangeImage& image, const PinholeCamera& camera, const SensorModel& sensor,
                    const CompiledModel& model, Detection& detection);

// Judged by alpha, beta and gamma, whatever the method of the options: a pose that is given has no rivals.
[[nodiscard]] RefinedPose refine_and_verify(const RangeImage& image, const PinholeCamera& camera,
                                            const CompiledModel& model, const Pose& T_sensor_model,
                                            const RecognizeOptions& options);

}  // namespace foresight
