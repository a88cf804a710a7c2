#include "runtime/rated_matches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/runtime/learned_database.h"

namespace foresight {
namespace {

using test::learned_block;
using test::SeenScan;

const Database& database() {
  static const Database loaded = test::database_of({learned_block()});
  return loaded;
}

const RatedMatch* find_match(const RegionMatches& matches, int face) {
  const auto at = std::find_if(matches.begin(), matches.end(), [&](const RatedMatch& m) { return m.face == face; });
  return at == matches.end() ? nullptr : &*at;
}

// A region with these attributes, its outline cut or not.
DescribedRegion region_of(const AttributeVector& attributes, double cut_share = 0.0) {
  DescribedRegion region;
  region.attributes = attributes;
  region.cut_share = cut_share;
  return region;
}

// Attributes in the middle of the fullest bins of a face.
AttributeVector typical(const ModelFace& face) {
  AttributeVector attributes{};
  for (std::size_t k = 0; k < attributes.size(); ++k) {
    const Density& density = face.densities[k];
    const auto fullest = std::max_element(density.mass.begin(), density.mass.end()) - density.mass.begin();
    attributes[k] = density.lower + (density.first_bin + static_cast<double>(fullest) + 0.5) * density.bin_width;
  }
  return attributes;
}

double rating_of(const MatchRater& rater, const DescribedRegion& region, int face) {
  const auto rated = rater.rate({region});
  const RatedMatch* match = find_match(rated[0], face);
  return match == nullptr ? -std::numeric_limits<double>::infinity() : match->rating;
}

// No match is too improbable to be listed.
RatingOptions listing_all() {
  RatingOptions options;
  options.least_rating = -1e9;
  return options;
}

TEST(MatchRater, lists_matches_by_region_and_face_and_only_those_rated_high_enough) {
  Random random(3);
  const MatchRater rater(database());
  int listed = 0;
  for (int view = 0; view < 10; ++view) {
    const SeenScan seen(test::image_of({{&learned_block(), test::random_pose(learned_block(), random)}}));
    const auto rated = rater.rate(seen.regions);
    ASSERT_EQ(rated.size(), seen.regions.size());
    for (std::size_t r = 0; r < rated.size(); ++r) {
      for (std::size_t i = 0; i < rated[r].size(); ++i) {
        EXPECT_EQ(rated[r][i].region, static_cast<int>(r));
        EXPECT_EQ(rated[r][i].model, 0);
        EXPECT_GE(rated[r][i].rating, RatingOptions().least_rating);
        if (i > 0) {
          EXPECT_GT(rated[r][i].face, rated[r][i - 1].face);
        }
        ++listed;
      }
    }
  }
  EXPECT_GT(listed, 20);
}

// The block's faces differ in size, but for a corner cut off one of two opposite ones.
TEST(MatchRater, rates_the_true_face_above_most_others) {
  Random random(4);
  const MatchRater rater(database());
  int regions = 0;
  int listed = 0;
  int positive = 0;
  int first = 0;
  for (int view = 0; view < 40; ++view) {
    const Pose pose = test::random_pose(learned_block(), random);
    const SeenScan seen(test::image_of({{&learned_block(), pose}}));
    const auto rated = rater.rate(seen.regions);
    for (std::size_t r = 0; r < rated.size(); ++r) {
      const auto face = test::face_shown(learned_block(), pose, seen.regions[r]);
      if (!face) continue;
      ++regions;
      const RatedMatch* match = find_match(rated[r], *face);
      if (match == nullptr) continue;
      ++listed;
      positive += match->rating > 0.0 ? 1 : 0;  // it explains more than nothing known does
      first += std::all_of(rated[r].begin(), rated[r].end(),
                           [&](const RatedMatch& other) { return other.rating <= match->rating; })
                   ? 1
                   : 0;
    }
  }
  ASSERT_GT(regions, 80);
  EXPECT_GE(listed, 0.95 * regions);
  EXPECT_GE(positive, 0.9 * regions);
  EXPECT_GE(first, 0.85 * regions);
}

TEST(MatchRater, a_value_never_seen_costs_but_does_not_exclude) {
  const MatchRater rater(database(), listing_all());
  for (int face = 0; face < 7; ++face) {
    const AttributeVector usual = typical(learned_block().faces[static_cast<std::size_t>(face)]);
    const double best = rating_of(rater, region_of(usual), face);
    for (std::size_t k = 0; k < usual.size(); ++k) {
      AttributeVector other = usual;
      other[k] = 1e6;
      const double rating = rating_of(rater, region_of(other), face);
      EXPECT_LT(rating, best - 2.0) << face << " " << k;
      EXPECT_GT(rating, best - 10.0) << face << " " << k;
      other[k] = 0.0;
      EXPECT_LT(rating_of(rater, region_of(other), face), best) << face << " " << k;
      EXPECT_TRUE(std::isfinite(rating_of(rater, region_of(other), face)));
    }
  }
  EXPECT_NE(find_match(rater.rate({region_of({1e6, 1e6, 1e6, 1e6})})[0], 0), nullptr);
  EXPECT_TRUE(MatchRater(database()).rate({region_of({1e6, 1e6, 1e6, 1e6})})[0].empty());
}

TEST(MatchRater, the_least_ratio_bounds_what_one_value_costs) {
  for (const double least : {0.001, 0.01, 0.1}) {
    RatingOptions options = listing_all();
    options.least_ratio = least;
    const MatchRater rater(database(), options);
    const double expected = std::log(7.0 * database().prior(2, 0.0)) + 4.0 * std::log(least);
    EXPECT_NEAR(rating_of(rater, region_of({1e6, 1e6, 1e6, 1e6}), 2), expected, 1e-9);
  }
}

// Less of a face in sight: the whole may be this face no less.
TEST(MatchRater, a_cut_region_fits_its_face_however_little_is_left) {
  const MatchRater rater(database(), listing_all());
  const double cut_share = RatingOptions().cut_share;
  for (int face = 0; face < 7; ++face) {
    const AttributeVector whole = typical(learned_block().faces[static_cast<std::size_t>(face)]);
    for (const double share : {0.7, 0.5, 0.3, 0.1}) {
      AttributeVector part = whole;
      part[kArea] *= share;
      for (const int k : {kMaxSecondMoment, kMinSecondMoment, kMaxDiameter}) {
        part[static_cast<std::size_t>(k)] *= std::sqrt(share);
      }
      const double as_part = rating_of(rater, region_of(part, 2.0 * cut_share), face);
      EXPECT_GT(as_part, std::log(7.0 * database().prior(face, 0.0)) - 1e-9) << face << " " << share;
      if (share <= 0.5) {
        EXPECT_GT(as_part, rating_of(rater, region_of(part), face)) << face << " " << share;
      }
    }
  }
}

TEST(MatchRater, a_cut_region_larger_than_the_face_is_not_of_it) {
  const MatchRater rater(database(), listing_all());
  for (int face = 0; face < 7; ++face) {
    AttributeVector larger = typical(learned_block().faces[static_cast<std::size_t>(face)]);
    const double fits = rating_of(rater, region_of(larger, 0.3), face);
    for (double& attribute : larger) attribute *= 3.0;
    EXPECT_LT(rating_of(rater, region_of(larger, 0.3), face), fits - 5.0) << face;
  }
}

TEST(MatchRater, a_region_is_cut_beyond_the_threshold) {
  RatingOptions options;
  options.cut_share = 0.25;
  const MatchRater rater(database(), options);
  EXPECT_FALSE(rater.is_cut(region_of({}, 0.0)));
  EXPECT_FALSE(rater.is_cut(region_of({}, 0.25)));
  EXPECT_TRUE(rater.is_cut(region_of({}, 0.26)));
  EXPECT_TRUE(MatchRater(database()).is_cut(region_of({}, 0.26)));
  EXPECT_FALSE(MatchRater(database()).is_cut(region_of({}, 0.01)));
}

TEST(MatchRater, a_pair_as_it_was_seen_is_rated_above_one_that_was_not) {
  const MatchRater rater(database());
  for (const FacePair& pair : learned_block().pairs) {
    const ModelFace& a = learned_block().faces[static_cast<std::size_t>(pair.first)];
    const ModelFace& b = learned_block().faces[static_cast<std::size_t>(pair.second)];
    const double angle = std::acos(a.normal.dot(b.normal));
    const Density& distances = pair.densities[kMaxDistance];
    const double distance = distances.lower + (distances.first_bin + 0.5 * static_cast<double>(distances.mass.size())) *
                                                  distances.bin_width;
    const double usual = rater.rate(pair, {angle, distance}, false);
    EXPECT_GT(usual, 0.0);
    EXPECT_LT(rater.rate(pair, {angle + (angle < 1.5 ? 0.6 : -0.6), distance}, false), usual - 2.0);
    EXPECT_LT(rater.rate(pair, {angle, 1000.0}, false), usual - 2.0);
    // Parts of faces may lie nearer together, and are as far from lying elsewhere as wholes.
    EXPECT_GT(rater.rate(pair, {angle, 0.3 * distance}, true), rater.rate(pair, {angle, 0.3 * distance}, false));
    EXPECT_LT(rater.rate(pair, {angle, 1000.0}, true), usual - 2.0);
  }
}

TEST(MatchRater, no_pair_is_rated_above_its_bound) {
  const MatchRater rater(database());
  double highest = -1e9;
  for (const FacePair& pair : learned_block().pairs) {
    for (double angle = 0.0; angle < 3.14; angle += 0.05) {
      for (double distance = 0.0; distance < 120.0; distance += 1.0) {
        for (const bool cut : {false, true}) {
          const double rating = rater.rate(pair, {angle, distance}, cut);
          ASSERT_LE(rating, rater.highest_pair_rating() + 1e-9);
          highest = std::max(highest, rating);
        }
      }
    }
  }
  EXPECT_GT(highest, 0.5 * rater.highest_pair_rating());
}

TEST(MatchRater, other_objects_in_the_database_change_no_order) {
  CompiledModel twin = learned_block();
  twin.name = "twin";
  const Database two = test::database_of({learned_block(), twin});
  const AttributeVector usual = typical(learned_block().faces[3]);
  const auto alone = MatchRater(database(), listing_all()).rate({region_of(usual)})[0];
  const auto both = MatchRater(two, listing_all()).rate({region_of(usual)})[0];
  ASSERT_EQ(both.size(), 2 * alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(both[i].model, 0);
    EXPECT_EQ(both[i + alone.size()].model, 1);
    EXPECT_NEAR(both[i].rating, alone[i].rating, 1e-9);
    EXPECT_NEAR(both[i + alone.size()].rating, alone[i].rating, 1e-9);
  }
}

}  // namespace
}  // namespace foresight
