// Beyond the paper: start poses judged by evidence for and against them, the best looking one first.
//
// The paper accepts the first hypothesis whose alpha, beta and gamma pass; measured, that takes wrong poses and unknown
// objects. Here starts (start_search.h) that look well enough are refined, and a refined pose is judged by the
// probability that the compiler's acceptance model gives it. A sure one is accepted at once and its rivals are dropped;
// the others wait until all are known, and then the more probable ones take what they explain.
#pragma once

#include "runtime/pose_check.h"
#include "runtime/scan_context.h"

namespace foresight {

struct TwoWayOptions {
  double accepted = 0.5;        // a pose more probable than this is reported. Limit: (0, 1).
  double sure = 0.95;           // a pose more probable than this ends the search among its rivals. Limit: (0, 1).
  double start_distance = 8.0;  // of data that agree with a start, before localization. Unit: mm. Limit: > 0.
  int most_tries = 3;  // starts of one model refined from the same regions, the best looking ones. Limit: >= 1.
};

// Localization (Section V), and then the pose settled on the planes it touches: localization ends within its steps of a
// millimetre and a degree, planes say it better. sphere: ViewingSphere(80).
// checker: of the same scan, with a distance hardly larger than what localization leaves (settling_options); planes
// farther away are other planes.
[[nodiscard]] Localization localize_and_settle(const CompiledModel& model, int model_index, const Pose& start,
                                               const ScanContext& scan, const LabelledScan& labelled,
                                               const RecognizeOptions& options, PoseChecker& checker);
[[nodiscard]] PoseCheckOptions settling_options(const SensorModel& sensor);

// Fills detections, statistics and times. REQUIRES: check_method passes.
void search_two_way(const ScanContext& scan, const RecognizeOptions& options, const Deadline& deadline,
                    RecognitionResult& result, const TwoWayOptions& two_way = {});

}  // namespace foresight
