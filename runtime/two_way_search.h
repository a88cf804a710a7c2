// Beyond the paper: hypotheses judged by evidence for and against them, the best one first.
//
// The paper accepts the first hypothesis whose alpha, beta and gamma pass; measured, that takes wrong poses and unknown
// objects. Here each hypothesis is looked at where its matches put it (a depth buffer, tenths of a millisecond), only
// those that overlap the data are refined, and a refined pose is judged by the probability that the compiler's
// acceptance model gives it. A sure one is accepted at once and its rivals are dropped; the others wait until all are
// known, and then the more probable ones take what they explain.
#pragma once

#include "runtime/scan_context.h"

namespace foresight {

struct TwoWayOptions {
  double accepted = 0.5;        // a pose more probable than this is reported. Limit: (0, 1).
  double sure = 0.95;           // a pose more probable than this ends the search among its rivals. Limit: (0, 1).
  double start_distance = 8.0;  // of data that overlap, before localization. Unit: mm. Limit: > 0.
  double same_distance = 4.0;   // starts this near, and
  double same_angle = 0.035;    // turned by less than 2 degrees, are tried once. Unit: mm, rad. Limit: > 0.
};

// Fills detections, statistics and times. REQUIRES: the models of the database have acceptance models.
void search_two_way(const ScanContext& scan, const std::vector<ObjectHypothesis>& hypotheses,
                    const RecognizeOptions& options, const Deadline& deadline, RecognitionResult& result,
                    const TwoWayOptions& two_way = {});

}  // namespace foresight
