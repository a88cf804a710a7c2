#include "benchmarks/hypothesis_search.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "benchmarks/search_cost.h"
#include "runtime/highest_confidence_first.h"
#include "runtime/match_likelihoods.h"

namespace foresight {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

double area_of(const DescribedRegion& region) { return region.attributes[kArea]; }

// Place of each region in the order of size, largest first.
std::vector<int> size_ranks(const PoolVector<DescribedRegion>& regions) {
  std::vector<int> order(regions.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return area_of(regions[at(a)]) > area_of(regions[at(b)]); });
  std::vector<int> ranks(regions.size());
  for (std::size_t place = 0; place < order.size(); ++place) ranks[at(order[place])] = static_cast<int>(place);
  return ranks;
}

// Sorts hypotheses by a key computed once for each; equals stay in their order.
template <typename Key, typename KeyOf>
void sort_by(PoolVector<ObjectHypothesis>& hypotheses, const KeyOf& key_of) {
  std::vector<std::pair<Key, std::size_t>> keys;
  keys.reserve(hypotheses.size());
  for (std::size_t i = 0; i < hypotheses.size(); ++i) keys.emplace_back(key_of(hypotheses[i]), i);
  std::sort(keys.begin(), keys.end());
  PoolVector<ObjectHypothesis> sorted;
  sorted.reserve(hypotheses.size());
  for (const auto& [key, i] : keys) sorted.push_back(std::move(hypotheses[i]));
  hypotheses = std::move(sorted);
}

}  // namespace

Clique HypothesisList::clique(std::size_t i, const Database& database, int first_model) const {
  Clique clique{first_model + hypotheses[i].model, {}};
  for (const int index : hypotheses[i].matches) {
    const Match& match = field.matches[at(index)];
    clique.matches.push_back({match.region, database.faces()[at(match.face)].face});
  }
  std::sort(clique.matches.begin(), clique.matches.end());
  return clique;
}

std::vector<int> HypothesisList::regions(std::size_t i) const {
  std::vector<int> result;
  for (const int index : hypotheses[i].matches) result.push_back(field.matches[at(index)].region);
  return result;
}

HypothesisList likely_hypotheses(const PoolVector<DescribedRegion>& regions, const Database& database,
                                 Pruning pruning) {
  const BackgroundOptions background = background_for(database.content().density);
  HypothesisList list;
  list.field =
      build_hypothesis_field(regions, match_likelihoods(regions, database, background), database, background, {});
  const PoolVector<Label> labels = pruning == Pruning::none ? PoolVector<Label>(list.field.matches.size(), kOn)
                                                            : highest_confidence_first(list.field);
  list.hypotheses = hypothesis_cliques(list.field, database, labels);
  return list;
}

void sort_by_region_size(HypothesisList& list, const PoolVector<DescribedRegion>& regions) {
  sort_by<double>(list.hypotheses, [&](const ObjectHypothesis& hypothesis) {
    double area = 0.0;
    for (const int match : hypothesis.matches) area += area_of(regions[at(list.field.matches[at(match)].region)]);
    return -area;
  });
}

HypothesisList tree_hypotheses(const PoolVector<DescribedRegion>& regions, const Database& database,
                               const std::vector<const CadGeometry*>& geometry, const CadBounds& bounds,
                               Random random) {
  HypothesisList list;
  list.field = cad_field(regions, database, geometry, bounds);
  list.hypotheses = hypothesis_cliques(list.field, database, PoolVector<Label>(list.field.matches.size(), kOn));

  const std::vector<int> ranks = size_ranks(regions);
  const std::vector<std::size_t> places = random_order(database.models().size(), random);
  using Step = std::array<int, 3>;  // of the path from the root: region, model, face, each by its place
  constexpr int kEnd = std::numeric_limits<int>::max();
  sort_by<std::array<Step, 3>>(list.hypotheses, [&](const ObjectHypothesis& hypothesis) {
    std::array<Step, 3> path;
    path.fill({kEnd, kEnd, kEnd});
    for (std::size_t k = 0; k < hypothesis.matches.size(); ++k) {
      const Match& match = list.field.matches[at(hypothesis.matches[k])];
      path[k] = {ranks[at(match.region)], static_cast<int>(places[at(hypothesis.model)]), match.face};
    }
    std::sort(path.begin(), path.end());
    return path;
  });
  return list;
}

}  // namespace foresight
