// Localization as the two-way method does it: the paper's (Section V), and then the pose settled on planes.
#pragma once

#include "runtime/pose_check.h"
#include "runtime/pose_evidence.h"
#include "runtime/scan_context.h"

namespace foresight {

// Of data that agree with a start pose, before localization. Unit: mm.
inline constexpr double kStartDistance = 8.0;

// How a scan is looked at to settle a pose: planes farther away than what localization leaves are other planes.
[[nodiscard]] PoseCheckOptions settling_options(const SensorModel& sensor);

// How a start that is near is localized: by data within a short reach and a share of the template points, for the
// planes do the rest. Searches for far data are most of the time at wrong starts.
[[nodiscard]] LocalizationOptions near_localization_options(const RecognizeOptions& options);

// The pose moved onto the planes it touches, a few times over.
[[nodiscard]] Pose settle(const ScanContext& scan, int model, Pose pose, PoseChecker& settling);

struct SettledPose {
  Localization localization;
  PoseEvidence evidence;  // at its pose, of data within agreeing_distance
};

// Localization ends within its steps of a millimetre and a degree; the planes of regions, fitted to hundreds of cells,
// know better. The settled pose is taken where the scan agrees with it more.
// settling: of this scan, with settling_options. stop: what is left to do is left out.
[[nodiscard]] SettledPose localize_and_settle(const ScanContext& scan, const LabelledScan& labelled, int model,
                                              const Pose& start, const RecognizeOptions& options, PoseChecker& settling,
                                              const Stop& stop = {});

}  // namespace foresight
