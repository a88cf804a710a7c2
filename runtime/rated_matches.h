// How much an image speaks for region i showing face j, and for two such matches being one object: log-likelihood
// ratios of the compiled statistics against a background that knows nothing (Section III, eqs. (4) and (5), beyond the
// paper).
//
// Unlike the product of eq. (4) a ratio never is zero: one attribute outside of what 320 views showed makes a match
// improbable, not impossible. And attributes of a region that something cuts off are lower bounds.
#pragma once

#include "common/memory_pool.h"
#include "common/region_attributes.h"
#include "common/relation_attributes.h"
#include "runtime/database.h"

namespace foresight {

struct RatingOptions {
  double cut_share = 0.08;     // regions with more of their boundary cut are parts of faces. Limit: 0 to 1.
  double least_ratio = 0.01;   // of a probability to that of the background: what training never showed. Limit: > 0.
  double least_rating = -3.0;  // of a match worth thinking of
};

struct RatedMatch {
  int region = 0;
  int model = 0;
  int face = 0;         // of the model
  double rating = 0.0;  // log P(f|M) P(M) / P(f|background), P(M) against that of all faces alike
};

// Matches of one region, by model and then by face.
using RegionMatches = PoolVector<RatedMatch>;

class MatchRater {
 public:
  explicit MatchRater(const Database& database, const RatingOptions& options = {});

  // By region. Stopped: the first regions only.
  [[nodiscard]] PoolVector<RegionMatches> rate(const PoolVector<DescribedRegion>& regions, const Stop& stop = {}) const;
  // The same for two matches of one model, given how their regions stand to each other. cut: either region is.
  [[nodiscard]] double rate(const FacePair& pair, const RelationVector& relation, bool cut) const;
  // No two matches are rated higher together.
  [[nodiscard]] double highest_pair_rating() const { return highest_pair_rating_; }
  [[nodiscard]] bool is_cut(const DescribedRegion& region) const { return region.cut_share > options_.cut_share; }

 private:
  const Database& database_;
  RatingOptions options_;
  AttributeVector ranges_{};  // the background: any value from 0 to the largest that any loaded face was seen with
  double distance_range_ = 0.0;
  double highest_pair_rating_ = 0.0;
};

}  // namespace foresight
