// How many hypotheses a search tests until it comes upon a right one, and until it has nothing left to test.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "common/random.h"

namespace foresight {

// What became of one hypothesis.
struct HypothesisTest {
  bool tested = false;         // its matches gave a pose: only these are counted
  bool accepted = false;       // by alpha, beta and gamma, Section V.C
  bool right = false;          // accepted, and the pose is right (pose_scoring.h)
  std::vector<int> explained;  // where accepted: the regions it takes from its rivals, ascending
};

// The test of hypothesis i; the same one every time.
using TestHypothesis = std::function<const HypothesisTest&(std::size_t i)>;

// Where a search came to an end.
enum class SearchEnd {
  found,      // at a right hypothesis
  exhausted,  // all hypotheses were tested, none was right
  censored,   // the most tests allowed were spent before
};

struct FirstHits {
  SearchEnd end = SearchEnd::exhausted;
  double to_right = 0.0;     // tests up to and with the first right one; all those spent where none was found
  double to_accepted = 0.0;  // the same for the first accepted one, right or wrong
};

// Hypotheses 0, 1, 2, ... in their order. REQUIRES: most >= 1.
[[nodiscard]] FirstHits first_hits_in_order(std::size_t count, int most, const TestHypothesis& test);

// A random permutation of 0 ... count - 1.
[[nodiscard]] std::vector<std::size_t> random_order(std::size_t count, Random random);

// Expectation over all random orders. Of N hypotheses with K right ones the first right one is expected at place
// (N + 1) / (K + 1); that asks for a test of every hypothesis. The first m of one random order with k > 0 right ones
// among them serve as well: given which m they are, every order of them is equally likely and the first right one is
// expected at (m + 1) / (k + 1), so the mean over scenes is that of all orders. Tests go on in batches of `batch` until
// one holds a right hypothesis. to_accepted: in the same way.
[[nodiscard]] FirstHits first_hits_in_random_order(const std::vector<std::size_t>& order, int most, int batch,
                                                   const TestHypothesis& test);

struct FullSearch {
  int tests = 0;
  bool censored = false;  // `most` tests were spent before the end
};

// Tests until the list is exhausted when an accepted hypothesis drops all rivals that share a region with it, as in
// Section V.C. regions(i): of hypothesis i.
[[nodiscard]] FullSearch full_search(const std::vector<std::size_t>& order, int most, const TestHypothesis& test,
                                     const std::function<std::vector<int>(std::size_t i)>& regions);

}  // namespace foresight
