// How sure a measured share is.
#pragma once

namespace foresight {

struct Interval {
  double low = 0.0;
  double high = 1.0;
};

// The 95 % interval of a share after `hits` of `trials` (Wilson, "Probable inference, the law of succession, and
// statistical inference", JASA 22, 1927). [0, 1] for no trials. REQUIRES: 0 <= hits <= trials.
[[nodiscard]] Interval wilson_interval(long hits, long trials);

}  // namespace foresight
