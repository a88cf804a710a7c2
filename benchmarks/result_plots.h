// Plots of summaries of recognition.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/plot.h"
#include "benchmarks/summary.h"

namespace foresight {

// Right poses in percent with their 95 % intervals: by set along x, a curve a method. Sets that count no object leave a
// gap.
[[nodiscard]] Plot right_pose_plot(const std::string& title, const std::vector<SummaryRow>& rows);

}  // namespace foresight
