#include "runtime/hypothesis_queue.h"

#include <algorithm>
#include <tuple>

namespace foresight {

namespace {

constexpr std::size_t kMostWaiting = 131072;  // nodes; beyond, the worse half goes

}  // namespace

RegionRelations::RegionRelations(const PoolVector<DescribedRegion>& regions)
    : regions_(regions), known_(regions.size() * (regions.size() + 1) / 2) {}

const RelationVector& RegionRelations::between(int a, int b) {
  const auto high = static_cast<std::size_t>(std::max(a, b));
  const auto low = static_cast<std::size_t>(std::min(a, b));
  std::optional<RelationVector>& relation = known_[high * (high - 1) / 2 + low];
  if (!relation) relation = relate(regions_[low], regions_[high]);
  return *relation;
}

// The highest bound leads; of equal ones the lowest regions and matches, so that the order is the same everywhere.
bool HypothesisQueue::Node::operator<(const Node& other) const {
  return std::tuple(bound, -a, -b, -model, -match_a, -match_b) <
         std::tuple(other.bound, -other.a, -other.b, -other.model, -other.match_a, -other.match_b);
}

HypothesisQueue::HypothesisQueue(const PoolVector<RegionMatches>& matches, const PoolVector<DescribedRegion>& regions,
                                 const Database& database, const MatchRater& rater, RegionRelations& relations,
                                 double least_rating, int most)
    : matches_(matches),
      regions_(regions),
      database_(database),
      rater_(rater),
      relations_(relations),
      least_rating_(least_rating),
      most_(static_cast<std::size_t>(most)),
      runs_(matches.size()),
      most_nodes_(most == std::numeric_limits<int>::max() ? std::numeric_limits<std::size_t>::max()
                                                          : std::max<std::size_t>(kMostWaiting, 4 * most_)) {
  PoolVector<double> best(matches.size(), 0.0);
  for (std::size_t r = 0; r < matches.size(); ++r) {
    for (std::size_t i = 0; i < matches[r].size(); ++i) {
      const RatedMatch& match = matches[r][i];
      if (runs_[r].empty() || runs_[r].back().model != match.model) {
        runs_[r].push_back({match.model, i, i, match.rating});
      }
      Run& run = runs_[r].back();
      run.last = i + 1;
      run.best = std::max(run.best, match.rating);
    }
    for (const Run& run : runs_[r]) best[r] = &run == &runs_[r].front() ? run.best : std::max(best[r], run.best);
  }
  for (std::size_t b = 1; b < matches.size(); ++b) {
    if (matches[b].empty()) continue;
    for (std::size_t a = 0; a < b; ++a) {
      if (matches[a].empty()) continue;
      push({best[a] + best[b] + rater.highest_pair_rating(), static_cast<int>(a), static_cast<int>(b)});
    }
  }
}

void HypothesisQueue::push(const Node& node) {
  nodes_.push_back(node);
  std::push_heap(nodes_.begin(), nodes_.end());
  if (nodes_.size() <= most_nodes_) return;
  const auto half = nodes_.begin() + static_cast<std::ptrdiff_t>(nodes_.size() / 2);
  std::nth_element(nodes_.begin(), half, nodes_.end(), [](const Node& x, const Node& y) { return y < x; });
  nodes_.erase(half, nodes_.end());
  std::make_heap(nodes_.begin(), nodes_.end());
}

void HypothesisQueue::split_by_model(const Node& node) {
  const PoolVector<Run>& of_a = runs_[static_cast<std::size_t>(node.a)];
  const PoolVector<Run>& of_b = runs_[static_cast<std::size_t>(node.b)];
  for (auto a = of_a.begin(), b = of_b.begin(); a != of_a.end() && b != of_b.end();) {
    if (a->model == b->model) {
      push({a->best + b->best + rater_.highest_pair_rating(), node.a, node.b, a->model});
      ++a;
      ++b;
    } else if (a->model < b->model) {
      ++a;
    } else {
      ++b;
    }
  }
}

template <typename Visit>
void HypothesisQueue::visit_matches(const Node& node, const Visit& visit) const {
  const auto run_of = [&](int region) {
    const PoolVector<Run>& runs = runs_[static_cast<std::size_t>(region)];
    const auto run = std::lower_bound(runs.begin(), runs.end(), node.model,
                                      [](const Run& other, int model) { return other.model < model; });
    return run != runs.end() && run->model == node.model ? *run : Run{};
  };
  const RegionMatches& of_a = matches_[static_cast<std::size_t>(node.a)];
  const RegionMatches& of_b = matches_[static_cast<std::size_t>(node.b)];
  const RelationVector& relation = relations_.between(node.a, node.b);
  const bool cut = rater_.is_cut(regions_[static_cast<std::size_t>(node.a)]) ||
                   rater_.is_cut(regions_[static_cast<std::size_t>(node.b)]);
  const Run run_a = run_of(node.a);
  const Run run_b = run_of(node.b);
  for (std::size_t i = run_a.first; i < run_a.last; ++i) {
    for (std::size_t j = run_b.first; j < run_b.last; ++j) {
      if (of_a[i].rating + of_b[j].rating + rater_.highest_pair_rating() < least_rating_) continue;
      const FacePair* pair = database_.pair(node.model, of_a[i].face, of_b[j].face);
      if (pair == nullptr) continue;
      visit(Node{of_a[i].rating + of_b[j].rating + rater_.rate(*pair, relation, cut), node.a, node.b, node.model,
                 static_cast<int>(i), static_cast<int>(j)});
    }
  }
}

MatchPair HypothesisQueue::pair_of(const Node& node) const {
  return {matches_[static_cast<std::size_t>(node.a)][static_cast<std::size_t>(node.match_a)],
          matches_[static_cast<std::size_t>(node.b)][static_cast<std::size_t>(node.match_b)], node.bound};
}

void HypothesisQueue::split_by_match(const Node& node) {
  pairs_.clear();
  visit_matches(node, [this](const Node& pair) {
    if (pair.bound >= least_rating_) pairs_.push_back(pair);
  });
  if (pairs_.size() > most_) {
    std::nth_element(pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(most_), pairs_.end(),
                     [](const Node& x, const Node& y) { return y < x; });
    pairs_.resize(most_);
  }
  for (const Node& pair : pairs_) push(pair);
}

std::optional<MatchPair> HypothesisQueue::next(const std::function<bool(int)>& is_free, const Stop& stop) {
  constexpr int kAtOnce = 16;  // nodes between two questions whether to stop
  for (int taken = 1; !nodes_.empty() && nodes_.front().bound >= least_rating_; ++taken) {
    if (taken % kAtOnce == 0 && stop && stop()) return std::nullopt;
    std::pop_heap(nodes_.begin(), nodes_.end());
    const Node node = nodes_.back();
    nodes_.pop_back();
    if (!is_free(node.a) || !is_free(node.b)) continue;
    if (node.match_a >= 0) return pair_of(node);
    if (node.model >= 0) {
      split_by_match(node);
    } else {
      split_by_model(node);
    }
  }
  return std::nullopt;
}

PoolVector<MatchPair> HypothesisQueue::pairs_of(int region_a, int region_b, int most) const {
  PoolVector<Node> nodes;
  for (const Run& run : runs_[static_cast<std::size_t>(region_a)]) {
    visit_matches({0.0, std::min(region_a, region_b), std::max(region_a, region_b), run.model}, [&](const Node& node) {
      if (node.bound >= least_rating_) nodes.push_back(node);
    });
  }
  std::sort(nodes.begin(), nodes.end(), [](const Node& x, const Node& y) { return y < x; });
  nodes.resize(std::min(nodes.size(), static_cast<std::size_t>(most)));
  PoolVector<MatchPair> pairs;
  for (const Node& node : nodes) pairs.push_back(pair_of(node));
  return pairs;
}

}  // namespace foresight
