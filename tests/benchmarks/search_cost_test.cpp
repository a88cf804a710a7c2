#include "benchmarks/search_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace foresight {
namespace {

// Hypotheses that are what their letters say: . fails, a is accepted but wrong, R is right, - gives no pose.
std::vector<HypothesisTest> outcomes(const std::string& letters) {
  std::vector<HypothesisTest> tests;
  for (const char letter : letters) tests.push_back({letter != '-', letter == 'a' || letter == 'R', letter == 'R', {}});
  return tests;
}

TestHypothesis test_of(const std::vector<HypothesisTest>& tests) {
  return [&tests](std::size_t i) -> const HypothesisTest& { return tests[i]; };
}

TEST(FirstHits, in_order_count_the_tests_up_to_the_right_one) {
  const auto tests = outcomes("..-a.R.R");
  const FirstHits hits = first_hits_in_order(tests.size(), 100, test_of(tests));
  EXPECT_EQ(hits.end, SearchEnd::found);
  EXPECT_EQ(hits.to_right, 5.0);  // the one without a pose costs no test
  EXPECT_EQ(hits.to_accepted, 3.0);
}

TEST(FirstHits, in_order_say_how_the_search_ended) {
  const auto none = outcomes("..a.");
  EXPECT_EQ(first_hits_in_order(4, 100, test_of(none)).end, SearchEnd::exhausted);
  EXPECT_EQ(first_hits_in_order(4, 100, test_of(none)).to_right, 4.0);
  const auto late = outcomes("....R");
  EXPECT_EQ(first_hits_in_order(5, 4, test_of(late)).end, SearchEnd::censored);
  EXPECT_EQ(first_hits_in_order(5, 4, test_of(late)).to_right, 4.0);
  EXPECT_EQ(first_hits_in_order(5, 5, test_of(late)).end, SearchEnd::found);
  EXPECT_EQ(first_hits_in_order(0, 5, test_of(late)).end, SearchEnd::exhausted);
}

TEST(RandomOrder, is_a_permutation_that_depends_on_the_seed) {
  const std::vector<std::size_t> order = random_order(50, Random(1));
  EXPECT_EQ(std::set<std::size_t>(order.begin(), order.end()).size(), 50U);
  EXPECT_EQ(*std::max_element(order.begin(), order.end()), 49U);
  EXPECT_EQ(order, random_order(50, Random(1)));
  EXPECT_NE(order, random_order(50, Random(2)));
  EXPECT_TRUE(random_order(0, Random(1)).empty());
}

TEST(FirstHits, in_random_order_of_one_batch_are_the_closed_form) {
  const auto tests = outcomes("..R.aR-....");  // 10 with a pose, 2 right, 3 accepted
  const FirstHits hits = first_hits_in_random_order(random_order(tests.size(), Random(3)), 100, 50, test_of(tests));
  EXPECT_EQ(hits.end, SearchEnd::found);
  EXPECT_NEAR(hits.to_right, 11.0 / 3.0, 1e-12);
  EXPECT_NEAR(hits.to_accepted, 11.0 / 4.0, 1e-12);
}

TEST(FirstHits, in_random_order_have_the_closed_form_as_their_mean_whatever_the_batch) {
  const auto tests = outcomes("......R...a....R....R.........");  // (30 + 1) / (3 + 1)
  for (const int batch : {1, 4, 8}) {
    double sum = 0.0;
    constexpr int kTrials = 20000;
    for (int i = 0; i < kTrials; ++i) {
      const auto order = random_order(tests.size(), Random(9, static_cast<std::uint64_t>(i)));
      sum += first_hits_in_random_order(order, 1000, batch, test_of(tests)).to_right;
    }
    EXPECT_NEAR(sum / kTrials, 31.0 / 4.0, 0.15) << "batch " << batch;  // about three standard errors
  }
}

TEST(FirstHits, in_random_order_spend_no_more_than_allowed) {
  const auto tests = outcomes(std::string(40, '.'));
  int run = 0;
  const TestHypothesis counted = [&](std::size_t i) -> const HypothesisTest& {
    ++run;
    return tests[i];
  };
  const FirstHits hits = first_hits_in_random_order(random_order(40, Random(1)), 13, 8, counted);
  EXPECT_EQ(hits.end, SearchEnd::censored);
  EXPECT_EQ(hits.to_right, 13.0);
  EXPECT_EQ(run, 13);
  EXPECT_EQ(first_hits_in_random_order(random_order(40, Random(1)), 100, 8, counted).end, SearchEnd::exhausted);
}

TEST(FullSearch, drops_the_rivals_of_what_it_accepts) {
  std::vector<HypothesisTest> tests = outcomes(".a..R");
  tests[1].explained = {2, 3};
  const std::vector<std::vector<int>> regions = {{0, 1}, {1, 2}, {3, 4}, {4, 5}, {2, 5}};
  std::vector<std::size_t> order(5);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto regions_of = [&](std::size_t i) { return regions[i]; };
  const FullSearch search = full_search(order, 100, test_of(tests), regions_of);
  EXPECT_EQ(search.tests, 3);  // the third and the fifth share a region with the second
  EXPECT_FALSE(search.censored);
  EXPECT_TRUE(full_search(order, 2, test_of(tests), regions_of).censored);
  EXPECT_FALSE(full_search(order, 3, test_of(tests), regions_of).censored);
}

}  // namespace
}  // namespace foresight
