// Which regions of the image an accepted object accounts for: the rivals that share one of them are dropped (Section
// V.C).
#pragma once

#include "common/compiled_model.h"
#include "common/memory_pool.h"
#include "common/pose.h"
#include "common/range_image.h"
#include "common/region_attributes.h"

namespace foresight {

struct ExplanationOptions {
  double match_distance = 4.0;  // a data point this near to the template (beyond the template's own grain) is
                                // explained. Unit: mm. Limit: > 0.
  double normal_cosine = 0.8;   // by a template point whose face has a normal within this cosine of the region's
  double smallest_share = 0.5;  // of the region's data points. Limit: (0, 1].
  int most_samples = 48;        // data points looked at in a region, evenly spread over its cells. Limit: >= 1.
};

// Ascending region indices.
// The paper drops hypotheses "which have regions in common with the recognized object"; read here as all the regions
// that the accepted pose explains, not only the two or three that were matched. All template points take part, not only
// those of the aspect: a face of which little shows still explains its region.
[[nodiscard]] PoolVector<int> explained_regions(const CompiledModel& model, const Pose& T_sensor_model,
                                                const RangeImage& image, const PoolVector<DescribedRegion>& regions,
                                                const ExplanationOptions& options = {});

}  // namespace foresight
