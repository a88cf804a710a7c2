// The runtime's order of stages.
#pragma once

#include <chrono>
#include <optional>

#include "common/camera.h"
#include "common/pose.h"
#include "common/range_image.h"
#include "runtime/database.h"
#include "runtime/detection.h"
#include "runtime/foresight.h"
#include "runtime/localization.h"
#include "runtime/recognition.h"
#include "runtime/verification.h"

namespace foresight {

void check(const RecognizeOptions& options);  // throws UsageError

// Throws DatabaseError naming the file when the method of the options needs what the database does not hold.
void check_method(const RecognizeOptions& options, const Database& database, const std::string& file);

// The options of single stages.
[[nodiscard]] LocalizationOptions localization_options(const RecognizeOptions& options);
[[nodiscard]] VerificationOptions verification_options(const RecognizeOptions& options);

using Deadline = std::optional<std::chrono::steady_clock::time_point>;

// Recognizes on valid input; throws nothing. What it needs on the way comes from the pool of the calling thread's
// PoolScope, else from the heap. REQUIRES: check_method passes.
[[nodiscard]] RecognitionResult recognize(const RangeImage& image, const PinholeCamera& camera,
                                          const Database& database, const RecognizeOptions& options,
                                          const Deadline& deadline = {});
// The same, in place of what the result holds; memory of results is used again.
void recognize(const RangeImage& image, const PinholeCamera& camera, const Database& database,
               const RecognizeOptions& options, const Deadline& deadline, RecognitionResult& result,
               SpareDetections& spare);

// Judged by alpha, beta and gamma, whatever the method of the options: a pose that is given has no rivals.
[[nodiscard]] RefinedPose refine_and_verify(const RangeImage& image, const PinholeCamera& camera,
                                            const CompiledModel& model, const Pose& T_sensor_model,
                                            const RecognizeOptions& options);

}  // namespace foresight
