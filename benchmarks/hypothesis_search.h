// The searches that the `search` experiment compares: which hypotheses, in which order.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "benchmarks/cad_constraints.h"
#include "benchmarks/hypothesis_tester.h"
#include "common/random.h"
#include "runtime/hypothesis_cliques.h"

namespace foresight {

enum class Search {
  likely,             // the paper: highest confidence first, then least energy first
  likely_random,      // the same hypotheses in random order
  likely_size,        // the same, largest total region area first
  unpruned,           // all cliques of N+, least energy first
  tree_loose,         // constrained interpretation tree, CAD values as upper bounds, depth first by region size
  tree_loose_random,  // its hypotheses in random order
  tree_two_sided,     // the same two with CAD values as bounds on both sides
  tree_two_sided_random,
};
inline constexpr std::array<const char*, 8> kSearchNames = {
    "most likely first", "random order",        "largest regions first", "no HCF",
    "tree, loose",       "tree, loose, random", "tree, two-sided",       "tree, two-sided, random"};

// Hypotheses of one scan for one database.
struct HypothesisList {
  HypothesisField field;
  PoolVector<ObjectHypothesis> hypotheses;  // in the order of the search

  [[nodiscard]] Clique clique(std::size_t i, const Database& database, int first_model) const;
  [[nodiscard]] std::vector<int> regions(std::size_t i) const;
};

// The paper's hypotheses, least energy first.
[[nodiscard]] HypothesisList likely_hypotheses(const PoolVector<DescribedRegion>& regions, const Database& database,
                                               Pruning pruning);

// Largest total area of the regions first; equals stay in their order.
void sort_by_region_size(HypothesisList& list, const PoolVector<DescribedRegion>& regions);

// The interpretation tree to depth three. Its levels are the regions, largest first; a branch gives the next region a
// face of any model, or none. A node at depth three is a hypothesis, and a node at depth two without a consistent third
// match anywhere, as in Section IV.B. Depth first. Which model comes first must not depend on the place in the
// database, so the models are shuffled by `random`.
[[nodiscard]] HypothesisList tree_hypotheses(const PoolVector<DescribedRegion>& regions, const Database& database,
                                             const std::vector<const CadGeometry*>& geometry, const CadBounds& bounds,
                                             Random random);

}  // namespace foresight
