// Right or wrong without true poses: what a box drawn at a reported pose explains of instance masks.
#pragma once

#include <vector>

#include "benchmarks/box_scans.h"
#include "benchmarks/pose_scoring.h"
#include "common/compiled_model.h"

namespace foresight {

struct BoxScoringOptions {
  double smallest_share = 0.8;     // of a mask's cells that the drawn box covers. Limit: (0, 1].
  double largest_residual = 5.0;   // median distance of the data from the drawn surface. Unit: mm. Limit: > 0.
  double largest_elsewhere = 0.2;  // of a drawn box's cells that lie in masks, for a box on none. Limit: [0, 1).
};

// What a box drawn at a pose comes to on some cells of a scan.
struct DrawnOnCells {
  double share = 0.0;     // of the cells that the box covers
  double residual = 0.0;  // |data - drawn depth| across the drawn surface, median over covered cells with data;
                          // infinite without any. Unit: mm.
};
[[nodiscard]] DrawnOnCells drawn_on(const CompiledModel& model, const Pose& T_sensor_model, const RangeImage& image,
                                    const PinholeCamera& camera, const std::vector<int>& cells);

enum class BoxVerdict {
  found,      // explains a mask of this frame, the best of all reports on it
  duplicate,  // explains a mask that a better report has
  unmasked,   // explains a mask that is not counted here, or lies on data almost clear of masks: to be looked at
  invented,   // the rest
};

// One frame with its masks; the scan is the same for both kinds.
struct BoxScene {
  const RangeImage& image;
  const PinholeCamera& camera;
  const std::vector<CompiledModel>& models;
  const std::vector<BoxMask>& masks;      // counted
  const std::vector<BoxMask>& uncounted;  // of boxes that are known to be there but are no masks of this frame
};

struct BoxVerdicts {
  std::vector<BoxVerdict> reported;  // one a report
  std::vector<int> report_of_mask;   // index of the report that found it, -1 = missed
};

// A report explains a mask of its object when it covers at least smallest_share of its cells with a residual of at most
// largest_residual there. Each mask takes one report and each report one mask, the greatest share first.
[[nodiscard]] BoxVerdicts score_boxes(const BoxScene& scene, const std::vector<ReportedObject>& reported,
                                      const BoxScoringOptions& options = {});

}  // namespace foresight
