// From rated matches to start poses worth refining, the best looking first.
//
// Beyond the paper, which refines hypotheses in the order of their energy: the energy knows attributes, not the image.
// Here hypotheses come best rated first, each is looked at where it puts the object, and what is seen there orders
// them.
#pragma once

#include <vector>

#include "common/pose.h"
#include "runtime/database.h"
#include "runtime/pose_evidence.h"

namespace foresight {

struct StartPose {
  int model = 0;
  Pose T_sensor_model;
  double quality = 0.0;      // PoseCheck::quality
  std::vector<int> regions;  // that the hypothesis matched: one, two or three
};

struct StartSearchOptions {
  int most_pairs = 4000;       // hypotheses of two or three regions looked at. Limit: >= 0.
  double least_rating = 0.0;   // of these
  int most_thirds = 2;         // third regions tried for a pair
  double same_distance = 4.0;  // starts this near, and
  double same_angle = 0.035;   // turned by less than 2 degrees, are one. Unit: mm, rad. Limit: > 0.
};

struct StartSearchCounts {
  long matches = 0;     // rated high enough
  long hypotheses = 0;  // pairs, triples and single regions
  long checks = 0;      // poses looked at
};

// Best quality first. REQUIRES: the models know the faces of their triangles.
[[nodiscard]] std::vector<StartPose> find_starts(const Database& database, const LabelledScan& scan,
                                                 const StartSearchOptions& options, StartSearchCounts& counts);

}  // namespace foresight
