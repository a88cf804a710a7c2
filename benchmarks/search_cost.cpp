#include "benchmarks/search_cost.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <set>

namespace foresight {

FirstHits first_hits_in_order(std::size_t count, int most, const TestHypothesis& test) {
  assert(most >= 1);
  int tests = 0;
  FirstHits hits;
  bool accepted = false;
  const auto ended = [&](SearchEnd end) {
    hits.end = end;
    hits.to_right = tests;
    if (!accepted) hits.to_accepted = tests;
    return hits;
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (tests == most) return ended(SearchEnd::censored);
    const HypothesisTest& result = test(i);
    if (!result.tested) continue;
    ++tests;
    if (result.accepted && !accepted) {
      accepted = true;
      hits.to_accepted = tests;
    }
    if (result.right) return ended(SearchEnd::found);
  }
  return ended(SearchEnd::exhausted);
}

std::vector<std::size_t> random_order(std::size_t count, Random random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = 0; i + 1 < count; ++i) {
    std::swap(order[i], order[i + static_cast<std::size_t>(random.integer(0, static_cast<int>(count - i) - 1))]);
  }
  return order;
}

FirstHits first_hits_in_random_order(const std::vector<std::size_t>& order, int most, int batch,
                                     const TestHypothesis& test) {
  assert(most >= 1 && batch >= 1);
  FirstHits hits;
  bool any_accepted = false;
  int before = 0;  // tests of finished batches
  std::size_t next = 0;
  while (true) {
    int tests = 0, right = 0, accepted = 0;
    for (; next < order.size() && tests < std::min(batch, most - before); ++next) {
      const HypothesisTest& result = test(order[next]);
      tests += result.tested ? 1 : 0;
      accepted += result.accepted ? 1 : 0;
      right += result.right ? 1 : 0;
    }
    const auto expected = [&](int hit) { return before + (tests + 1.0) / (hit + 1.0); };
    if (accepted > 0 && !any_accepted) {
      any_accepted = true;
      hits.to_accepted = expected(accepted);
    }
    if (right > 0) {
      hits.end = SearchEnd::found;
      hits.to_right = expected(right);
      return hits;
    }
    before += tests;
    if (next == order.size() || before == most) break;
  }
  hits.end = next == order.size() ? SearchEnd::exhausted : SearchEnd::censored;
  hits.to_right = before;
  if (!any_accepted) hits.to_accepted = before;
  return hits;
}

FullSearch full_search(const std::vector<std::size_t>& order, int most, const TestHypothesis& test,
                       const std::function<std::vector<int>(std::size_t i)>& regions) {
  FullSearch search;
  std::set<int> taken;
  for (const std::size_t i : order) {
    const std::vector<int> own = regions(i);
    if (std::any_of(own.begin(), own.end(), [&](int region) { return taken.contains(region); })) continue;
    if (search.tests == most) {
      search.censored = true;
      return search;
    }
    const HypothesisTest& result = test(i);
    search.tests += result.tested ? 1 : 0;
    if (!result.accepted) continue;
    taken.insert(own.begin(), own.end());
    taken.insert(result.explained.begin(), result.explained.end());
  }
  return search;
}

}  // namespace foresight
