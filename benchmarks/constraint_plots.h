// Pictures in the manner of the paper's Figs. 2 and 6.
#pragma once

#include <string>

#include "benchmarks/constraint_samples.h"
#include "benchmarks/plot.h"

namespace foresight {

// One attribute: its histograms in the sample views and in the held-out ones, the compiled distribution, both normal
// distributions, the CAD value and the bounds about it. Everything in shares of one drawn bin; the drawn bins are finer
// than the compiled ones, which span all faces of a model. held_out: what the held-out samples are called.
[[nodiscard]] Plot attribute_plot(const AttributeSamples& attribute, const std::string& title,
                                  const std::string& held_out);

}  // namespace foresight
