// Beyond the paper: start poses judged by evidence for and against them, the best looking one first.
//
// The paper accepts the first hypothesis whose alpha, beta and gamma pass; measured, that takes wrong poses and unknown
// objects. Here starts (start_search.h) that look well enough are refined, and a refined pose is judged by the
// probability that the compiler's acceptance model gives it. A sure one is accepted at once and its rivals are dropped;
// the others wait until all are known, and then the more probable ones take what they explain.
#pragma once

#include "runtime/scan_context.h"

namespace foresight {

struct TwoWayOptions {
  double accepted = 0.5;  // a pose more probable than this is reported. Limit: (0, 1).
  double sure = 0.9;      // a pose more probable than this ends the search among its rivals. Limit: (0, 1).
  // No two objects stand in one another: of neither's surface may more than this share lie inside the other, deeper
  // than so many times the distance at which data agree, for either pose may be off.
  double most_inside = 0.02;  // Limit: 0 to 1.
  double penetration = 2.0;   // Limit: > 0.
  int most_tries = 3;         // starts of one model refined from the same regions, the best looking ones. Limit: >= 1.
  // Alternatives: of the starts that rest on the same regions so many, the best looking ones, are refined as well;
  // those that are accepted and would show the same in this share of the cells are what the view cannot tell apart.
  int most_rivals = 12;  // Limit: >= 0.
  // Starts are tried as soon as they look this well, each time after so many more hypotheses; each time it is twice as
  // many, and less is asked of their looks. What is left is tried when all hypotheses have been looked at.
  int first_stretch = 48;      // Limit: >= 1.
  double eager_quality = 0.8;  // Limit: 0 to 1.
  double eager_step = 0.1;     // Limit: >= 0.
  double least_eager = 0.4;    // Limit: 0 to 1.
  double same_view = 0.95;     // Limit: 0 to 1.
  double same_distance = 5.0;  // of depths that are the same. Unit: mm. Limit: > 0.
};

// Fills detections, statistics and times. REQUIRES: check_method passes.
void search_two_way(const ScanContext& scan, const RecognizeOptions& options, const Deadline& deadline,
                    Recognition& result, const TwoWayOptions& two_way = {});

}  // namespace foresight
