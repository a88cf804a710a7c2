// Pairs of matches that one object may explain, best rated first, made only as they are asked for.
//
// The paper lists all cliques and sorts them. In clutter, where parts of faces match much, there are 10^5 and more.
#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "common/memory_pool.h"
#include "runtime/rated_matches.h"

namespace foresight {

struct MatchPair {
  RatedMatch a;  // of one model, of two regions and two faces
  RatedMatch b;
  double rating = 0.0;  // of both matches and of the pair
};

// How regions stand to each other, computed when first asked for.
class RegionRelations {
 public:
  explicit RegionRelations(const PoolVector<DescribedRegion>& regions);
  [[nodiscard]] const RelationVector& between(int a, int b);

 private:
  const PoolVector<DescribedRegion>& regions_;
  PoolVector<std::optional<RelationVector>> known_;  // lower triangle
};

// Best first by a heap of bounds: two regions may be rated no higher than their best matches and the best pair there
// is; two regions and a model no higher than their best matches of that model. What leads is taken apart until it is a
// pair.
class HypothesisQueue {
 public:
  // All must outlive the queue. least_rating: of the pairs it gives. most: so many pairs are asked for at most. Of two
  // regions and a model no more are kept, and of all that wait the best 65536 for sure: an object of hundreds of like
  // faces would else fill the memory with pairs that nobody comes to. Limit: >= 0.
  HypothesisQueue(const PoolVector<RegionMatches>& matches, const PoolVector<DescribedRegion>& regions,
                  const Database& database, const MatchRater& rater, RegionRelations& relations, double least_rating,
                  int most = std::numeric_limits<int>::max());

  // None when there are no more pairs of regions that are free, or when it is stopped. A region that is not free once
  // must not become so again: its pairs may be gone.
  [[nodiscard]] std::optional<MatchPair> next(const std::function<bool(int)>& is_free, const Stop& stop = {});
  // The pairs of two regions, the best first, at most so many; whether `next` gave them before or not.
  [[nodiscard]] PoolVector<MatchPair> pairs_of(int region_a, int region_b, int most) const;

 private:
  // A run of one region's matches with one model.
  struct Run {
    int model = 0;
    std::size_t first = 0;
    std::size_t last = 0;  // behind it
    double best = 0.0;
  };
  struct Node {
    double bound = 0.0;
    int a = 0;  // regions
    int b = 0;
    int model = -1;    // -1: any
    int match_a = -1;  // among the matches of the region; -1: any
    int match_b = -1;
    bool operator<(const Node& other) const;
  };
  void split_by_model(const Node& node);
  void split_by_match(const Node& node);
  void push(const Node& node);
  // Calls visit for each pair of matches of the node's regions and model.
  template <typename Visit>
  void visit_matches(const Node& node, const Visit& visit) const;
  [[nodiscard]] MatchPair pair_of(const Node& node) const;

  const PoolVector<RegionMatches>& matches_;
  const PoolVector<DescribedRegion>& regions_;
  const Database& database_;
  const MatchRater& rater_;
  RegionRelations& relations_;
  double least_rating_;
  std::size_t most_;
  PoolVector<PoolVector<Run>> runs_;  // by region, models ascending
  PoolVector<Node> nodes_;            // a heap, the highest bound first
  std::size_t most_nodes_ = 0;
  PoolVector<Node> pairs_;  // scratch: of the node taken apart
};

}  // namespace foresight
