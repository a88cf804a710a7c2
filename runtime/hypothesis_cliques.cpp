#include "runtime/hypothesis_cliques.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>
#include <span>
#include <tuple>

namespace foresight {
namespace {

// N+ among the active matches alone: ascending neighbours of each match, empty for inactive ones.
PoolVector<PoolVector<int>> active_supports(const HypothesisField& field, const PoolVector<Label>& labels) {
  PoolVector<PoolVector<int>> result(field.matches.size());
  for (std::size_t a = 0; a < result.size(); ++a) {
    if (labels[a] != kOn) continue;
    std::copy_if(field.supports[a].begin(), field.supports[a].end(), std::back_inserter(result[a]),
                 [&](int b) { return labels[static_cast<std::size_t>(b)] == kOn; });
  }
  return result;
}

ObjectHypothesis make_hypothesis(const HypothesisField& field, const Database& database, std::span<const int> matches) {
  const auto face = static_cast<std::size_t>(field.matches[static_cast<std::size_t>(matches.front())].face);
  ObjectHypothesis hypothesis;
  hypothesis.model = database.faces()[face].model;
  hypothesis.matches.assign(matches.begin(), matches.end());
  // The paper's "contribution to the posterior energy function" read as the terms of eq. (3) inside the clique.
  const auto pairs = static_cast<double>(matches.size() * (matches.size() - 1) / 2);
  for (const int match : matches) hypothesis.energy += field.unary[static_cast<std::size_t>(match)][kOn];
  hypothesis.energy += pairs * field.potentials.support_on_on;
  return hypothesis;
}

}  // namespace

PoolVector<ObjectHypothesis> hypothesis_cliques(const HypothesisField& field, const Database& database,
                                                const PoolVector<Label>& labels) {
  assert(labels.size() == field.matches.size());
  const PoolVector<PoolVector<int>> supports = active_supports(field, labels);
  PoolVector<ObjectHypothesis> hypotheses;
  PoolVector<int> thirds;  // matches that make a 3-clique of the pair (a, b)
  for (int a = 0; a < static_cast<int>(supports.size()); ++a) {
    const PoolVector<int>& of_a = supports[static_cast<std::size_t>(a)];
    for (auto next = std::upper_bound(of_a.begin(), of_a.end(), a); next != of_a.end(); ++next) {
      const int b = *next;
      const PoolVector<int>& of_b = supports[static_cast<std::size_t>(b)];
      thirds.clear();
      std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(thirds));
      if (thirds.empty()) hypotheses.push_back(make_hypothesis(field, database, std::array{a, b}));
      // Thirds below b have made their clique already, from its two lower matches.
      for (auto c = std::upper_bound(thirds.begin(), thirds.end(), b); c != thirds.end(); ++c) {
        hypotheses.push_back(make_hypothesis(field, database, std::array{a, b, *c}));
      }
    }
  }
  std::sort(hypotheses.begin(), hypotheses.end(), [](const ObjectHypothesis& left, const ObjectHypothesis& right) {
    return std::tie(left.energy, left.matches) < std::tie(right.energy, right.matches);
  });
  return hypotheses;
}

}  // namespace foresight
