// Which regions of the image an accepted object accounts for: the rivals that share one of them are dropped (Section V.C).
#pragma once

#include <vector>

#include "common/compiled_model.h"
#include "common/pose.h"
#include "common/region_attributes.h"
#include "common/viewing_sphere.h"
#include "runtime/nearest_data_point.h"

namespace foresight {

struct ExplanationOptions {
  double match_distance = 4.0;   // as in verification. Unit: mm. Limit: > 0.
  double normal_cosine = 0.8;    // a template point explains a region whose normal is within this cosine of its own
  double smallest_share = 0.5;   // of the region's area that template points must cover, one spacing squared each. Limit: (0, 1].
};

// Ascending region indices. region_of_cell: label_image() of the regions (0 = none, i + 1 = region i).
// The paper drops hypotheses "which have regions in common with the recognized object"; read here as all the regions that
// the accepted pose explains, not only the two or three that were matched.
[[nodiscard]] std::vector<int> explained_regions(const CompiledModel& model, const ViewingSphere& sphere,
                                                 const Pose& T_sensor_model, const std::vector<DescribedRegion>& regions,
                                                 const std::vector<int>& region_of_cell, const NearestDataPoint& data,
                                                 const ExplanationOptions& options = {});

}  // namespace foresight
