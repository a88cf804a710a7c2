#include "runtime/hypothesis_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "tests/runtime/learned_database.h"

namespace foresight {
namespace {

using test::learned_block;
using test::SeenScan;

// The block, its mirror image and the box.
const Database& database() {
  static const Database loaded = [] {
    CompiledModel mirror = test::mirrored(learned_block());
    test::learn(mirror, 60);
    return test::database_of({learned_block(), mirror, test::learned_box()});
  }();
  return loaded;
}

// Three of the objects, one before another, so that some regions are cut.
const SeenScan& scene() {
  static const SeenScan seen([] {
    const CompiledModel& block = database().models()[0];
    const Eigen::Matrix3d turned = rotation_from_vector({0.4, -0.5, 0.2}) * test::box_pose().rotation;
    return test::image_of({{&block, {test::box_pose().rotation, {-25, 0, 860}}},
                           {&block, {turned, {70, 60, 900}}},
                           {&database().models()[2], test::moved(test::box_pose(940), {20, -10, 0}, {0, 0, 0})}});
  }());
  return seen;
}

using Key = std::tuple<int, int, int, int, int>;  // regions, faces, model
Key key_of(const MatchPair& pair) { return {pair.a.region, pair.b.region, pair.a.face, pair.b.face, pair.a.model}; }

// Holds what a queue refers to.
struct Queue {
  const MatchRater rater;
  PoolVector<RegionMatches> matches;
  RegionRelations relations;
  HypothesisQueue queue;

  Queue(const Database& objects, const PoolVector<DescribedRegion>& regions, double least_rating = -1e9,
        const RatingOptions& options = {})
      : rater(objects, options),
        matches(rater.rate(regions)),
        relations(regions),
        queue(matches, regions, objects, rater, relations, least_rating) {}

  PoolVector<MatchPair> all(const std::function<bool(int)>& is_free = [](int) { return true; }) {
    PoolVector<MatchPair> pairs;
    while (const auto pair = queue.next(is_free)) pairs.push_back(*pair);
    return pairs;
  }
};

TEST(RegionRelations, are_those_of_the_regions_in_either_order) {
  const auto& regions = scene().regions;
  RegionRelations relations(regions);
  const int count = static_cast<int>(regions.size());
  ASSERT_GE(count, 7);
  for (int repeat = 0; repeat < 2; ++repeat) {
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) {
        if (a == b) continue;
        const auto low = static_cast<std::size_t>(std::min(a, b));
        const auto high = static_cast<std::size_t>(std::max(a, b));
        EXPECT_EQ(relations.between(a, b), relate(regions[low], regions[high]));
      }
    }
  }
}

TEST(HypothesisQueue, gives_pairs_in_descending_order_of_rating) {
  Queue queue(database(), scene().regions);
  const PoolVector<MatchPair> pairs = queue.all();
  ASSERT_GT(pairs.size(), 100U);
  for (std::size_t i = 1; i < pairs.size(); ++i) EXPECT_LE(pairs[i].rating, pairs[i - 1].rating);
}

TEST(HypothesisQueue, gives_each_pair_that_one_object_may_explain_once) {
  RatingOptions all;
  all.least_rating = -1e9;
  for (const RatingOptions& options : {RatingOptions{}, all}) {
    Queue queue(database(), scene().regions, -1e9, options);
    std::map<Key, double> expected;
    const auto& regions = scene().regions;
    for (std::size_t b = 1; b < regions.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        const RelationVector relation = relate(regions[a], regions[b]);
        const bool cut = queue.rater.is_cut(regions[a]) || queue.rater.is_cut(regions[b]);
        for (const RatedMatch& m : queue.matches[a]) {
          for (const RatedMatch& n : queue.matches[b]) {
            const FacePair* pair = m.model == n.model ? database().pair(m.model, m.face, n.face) : nullptr;
            if (pair == nullptr || m.face == n.face) continue;
            const MatchPair both{m, n, m.rating + n.rating + queue.rater.rate(*pair, relation, cut)};
            expected[key_of(both)] = both.rating;
          }
        }
      }
    }
    ASSERT_GT(expected.size(), 100U);
    std::map<Key, double> found;
    for (const MatchPair& pair : queue.all()) {
      EXPECT_TRUE(found.emplace(key_of(pair), pair.rating).second);
      EXPECT_EQ(pair.a.model, pair.b.model);
    }
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [key, rating] : expected) EXPECT_NEAR(found.at(key), rating, 1e-9);
  }
}

TEST(HypothesisQueue, ends_where_the_ratings_asked_for_end) {
  Queue every(database(), scene().regions);
  const PoolVector<MatchPair> pairs = every.all();
  const auto above = [&](double least) {
    return static_cast<std::size_t>(
        std::count_if(pairs.begin(), pairs.end(), [&](const MatchPair& pair) { return pair.rating >= least; }));
  };
  for (const double least : {-2.0, 0.0, 4.0, 8.0, 1e3}) {
    const PoolVector<MatchPair> best = Queue(database(), scene().regions, least).all();
    EXPECT_EQ(best.size(), above(least)) << least;
    for (const MatchPair& pair : best) EXPECT_GE(pair.rating, least);
  }
  EXPECT_GT(above(0.0), above(8.0));
}

TEST(HypothesisQueue, keeps_one_order) {
  Queue first(database(), scene().regions);
  Queue second(database(), scene().regions);
  const PoolVector<MatchPair> a = first.all();
  const PoolVector<MatchPair> b = second.all();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(key_of(a[i]), key_of(b[i]));
    ASSERT_EQ(a[i].rating, b[i].rating);
  }
}

TEST(HypothesisQueue, leaves_out_regions_that_are_not_free) {
  Queue queue(database(), scene().regions);
  const PoolVector<MatchPair> pairs = queue.all();
  const int taken = pairs.front().a.region;
  const auto has_taken = [taken](const MatchPair& pair) { return pair.a.region == taken || pair.b.region == taken; };
  Queue without(database(), scene().regions);
  const PoolVector<MatchPair> left = without.all([taken](int region) { return region != taken; });
  EXPECT_TRUE(std::none_of(left.begin(), left.end(), has_taken));
  EXPECT_EQ(static_cast<std::ptrdiff_t>(left.size()),
            static_cast<std::ptrdiff_t>(pairs.size()) - std::count_if(pairs.begin(), pairs.end(), has_taken));
}

TEST(HypothesisQueue, gives_the_pairs_of_two_regions_at_any_time) {
  Queue queue(database(), scene().regions, 1.0);
  const PoolVector<MatchPair> pairs = queue.all();
  const int a = pairs.front().a.region;
  const int b = pairs.front().b.region;
  std::vector<Key> expected;
  for (const MatchPair& pair : pairs) {
    if (pair.a.region == a && pair.b.region == b) expected.push_back(key_of(pair));
  }
  ASSERT_GE(expected.size(), 4U);
  for (const auto& [first, second] : {std::pair(a, b), std::pair(b, a)}) {
    const PoolVector<MatchPair> found = queue.queue.pairs_of(first, second, 1000);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(key_of(found[i]), expected[i]);
  }
  const PoolVector<MatchPair> best = queue.queue.pairs_of(a, b, 3);
  ASSERT_EQ(best.size(), 3U);
  EXPECT_EQ(key_of(best[2]), expected[2]);
  EXPECT_TRUE(queue.queue.pairs_of(a, b, 0).empty());
}

// Twins are rated alike everywhere: the first one of the database leads.
TEST(HypothesisQueue, of_equal_ratings_the_lower_model_comes_first) {
  CompiledModel twin = learned_block();
  twin.name = "twin";
  const Database twins = test::database_of({learned_block(), twin});
  Queue queue(twins, scene().regions);
  std::set<Key> of_first;
  int of_second = 0;
  for (const MatchPair& pair : queue.all()) {
    Key key = key_of(pair);
    if (std::get<4>(key) == 0) {
      of_first.insert(key);
      continue;
    }
    ++of_second;
    std::get<4>(key) = 0;
    EXPECT_TRUE(of_first.contains(key));
  }
  EXPECT_EQ(static_cast<std::size_t>(of_second), of_first.size());
}

TEST(HypothesisQueue, is_empty_without_two_matched_regions) {
  EXPECT_TRUE(Queue(database(), {}).all().empty());
  EXPECT_TRUE(Queue(database(), {scene().regions[0]}).all().empty());
  // Regions that no face is like.
  PoolVector<DescribedRegion> unknown(3, scene().regions[0]);
  for (DescribedRegion& region : unknown) {
    region.attributes.fill(1e6);
    region.cut_share = 0.0;
  }
  EXPECT_TRUE(Queue(database(), unknown).all().empty());
}

}  // namespace
}  // namespace foresight
