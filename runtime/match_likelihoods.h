// Matches between regions and model faces with their likelihoods, eqs. (4) and (5).
#pragma once

#include "common/memory_pool.h"
#include "common/region_attributes.h"
#include "runtime/database.h"

namespace foresight {

struct BackgroundOptions {
  double prior = 0.3;            // P(B), Section IV.A. Limit: (0, 1).
  double likelihood = 0.000003;  // P(R|B), Section IV.A. Limit: > 0.
};

// The paper's 0.000003 is 24^-4: a background that is uniform over four attributes of 24 bins. For densities of another
// number of bins P(R|B) is that number to the power -4.
[[nodiscard]] BackgroundOptions background_for(const DensityOptions& densities);

// Region R explained by face M: one ON/OFF variable of the field.
struct Match {
  int region = 0;
  int face = 0;                   // index into Database::faces()
  double log_likelihood_on = 0;   // log P(R|M), eq. (4)
  double log_likelihood_off = 0;  // log P(R|not M), eq. (5)
};

// Every match with P(R|M) > 0, ordered by region, then face. The number of possible matches is regions * faces.
[[nodiscard]] PoolVector<Match> match_likelihoods(const PoolVector<DescribedRegion>& regions, const Database& database,
                                                  const BackgroundOptions& options);

}  // namespace foresight
