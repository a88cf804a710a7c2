// What a search finds in a scan, by the database's indices and in the scan's memory (common/memory_pool.h);
// detection.h says it in the caller's.
#pragma once

#include <array>

#include "common/memory_pool.h"
#include "common/pose.h"
#include "runtime/foresight.h"
#include "runtime/localization.h"
#include "runtime/verification.h"

namespace foresight {

// One given pose of one model, refined and verified.
struct RefinedPose {
  Localization localization;
  Verification verification;
};

// As Alternative.
struct FoundAlternative {
  int model = 0;
  Pose T_sensor_model;
  double score = 0.0;
};

// As Detection.
struct FoundObject {
  int model = 0;
  RefinedPose pose;
  double score = 0.0;
  int rank = 0;
  std::array<double, 36> covariance{};
  PoolVector<int> faces;
  PoolVector<int> regions;
  PoolVector<FoundAlternative> alternatives;
};

// As RecognitionResult.
struct Recognition {
  bool complete = true;
  PoolVector<FoundObject> objects;
  Statistics statistics;
  StageTimes milliseconds;
};

}  // namespace foresight
