#include "runtime/hypothesis_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/random.h"
#include "common/relation_attributes.h"

namespace foresight {
namespace {

constexpr double kLargest = 100.0;  // of attributes and distances in these tests

Density random_density(Random& random, double upper, double empty_share) {
  Density density;
  density.bin_width = upper / 10.0;
  density.mass.resize(10);
  float sum = 0.01F;
  for (float& m : density.mass) sum += m = random.uniform() < empty_share ? 0.0F : static_cast<float>(random.uniform());
  density.mass.front() += 0.01F;
  for (float& m : density.mass) m /= sum;
  return density;
}

Database random_database(Random& random, int models, int faces) {
  CompiledDatabase content;
  for (int m = 0; m < models; ++m) {
    CompiledModel model;
    model.name = "model " + std::to_string(m);
    model.views = 320;
    for (int f = 0; f < faces; ++f) {
      ModelFace face;
      face.views_found = random.integer(0, 5) == 0 ? 0 : random.integer(1, 320);
      if (face.views_found > 0) {
        for (Density& density : face.densities) density = random_density(random, kLargest, 0.1);
      }
      model.faces.push_back(face);
    }
    for (int a = 0; a < faces; ++a) {
      for (int b = a + 1; b < faces; ++b) {
        const auto found = [&](int f) { return model.faces[static_cast<std::size_t>(f)].views_found > 0; };
        if (!found(a) || !found(b) || random.uniform() < 0.3) continue;
        model.pairs.push_back(
            {a,
             b,
             10,
             {random_density(random, std::numbers::pi + 0.01, 0.3), random_density(random, 3.0 * kLargest, 0.3)}});
      }
    }
    content.models.push_back(std::move(model));
  }
  return Database(std::move(content));
}

PoolVector<DescribedRegion> random_regions(Random& random, int count) {
  PoolVector<DescribedRegion> regions(static_cast<std::size_t>(count));
  for (DescribedRegion& region : regions) {
    for (double& value : region.attributes) value = random.uniform(0.0, kLargest);
    region.region.normal = random.direction();
    region.centroid = random.uniform(0.0, kLargest) * random.direction();
    for (int i = 0; i < 3; ++i) region.hull.push_back(region.centroid + random.uniform(1.0, 20.0) * random.direction());
  }
  return regions;
}

struct Example {
  Database database;
  PoolVector<DescribedRegion> regions;
  HypothesisField field;
};

Example random_example(std::uint64_t seed, PriorSign sign = PriorSign::minus_log) {
  Random random(seed);
  Database database = random_database(random, 4, 8);
  auto regions = random_regions(random, 8);
  Potentials potentials;
  potentials.prior_sign = sign;
  const auto matches = match_likelihoods(regions, database, {});
  auto field = build_hypothesis_field(regions, matches, database, {}, potentials);
  return {std::move(database), std::move(regions), std::move(field)};
}

// Eq. (2) and the rules beside it, written down once more for one pair.
bool expected_support(const Example& example, const Match& a, const Match& b) {
  const FaceIndex face_a = example.database.faces()[static_cast<std::size_t>(a.face)];
  const FaceIndex face_b = example.database.faces()[static_cast<std::size_t>(b.face)];
  if (a.region == b.region || face_a.model != face_b.model || face_a.face == face_b.face) return false;
  const FacePair* pair = example.database.pair(face_a.model, face_a.face, face_b.face);
  if (pair == nullptr) return false;
  const RelationVector relation =
      relate(example.regions[static_cast<std::size_t>(a.region)], example.regions[static_cast<std::size_t>(b.region)]);
  return pair->densities[kOrientation].probability(relation[kOrientation]) > 0.0 &&
         pair->densities[kMaxDistance].probability(relation[kMaxDistance]) > 0.0;
}

TEST(HypothesisField, supports_are_exactly_the_pairs_of_equation_2_ascending_and_mutual) {
  std::size_t pairs = 0;
  std::size_t refused = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Example example = random_example(seed);
    const auto& matches = example.field.matches;
    for (std::size_t a = 0; a < matches.size(); ++a) {
      PoolVector<int> expected;
      for (std::size_t b = 0; b < matches.size(); ++b) {
        if (expected_support(example, matches[a], matches[b])) expected.push_back(static_cast<int>(b));
      }
      EXPECT_EQ(example.field.supports[a], expected);
      pairs += expected.size();
      refused += matches.size() - expected.size();
    }
  }
  EXPECT_GT(pairs, 100U);
  EXPECT_GT(refused, 100U);
}

TEST(HypothesisField, contradictions_are_all_matches_of_a_region) {
  const Example example = random_example(3);
  ASSERT_EQ(example.field.by_region.size(), example.regions.size());
  std::vector<int> all;
  for (std::size_t region = 0; region < example.field.by_region.size(); ++region) {
    for (const int match : example.field.by_region[region]) {
      EXPECT_EQ(example.field.matches[static_cast<std::size_t>(match)].region, static_cast<int>(region));
      all.push_back(match);
    }
  }
  ASSERT_EQ(all.size(), example.field.matches.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], static_cast<int>(i));
}

TEST(HypothesisField, unaries_add_prior_and_likelihood_with_either_sign) {
  for (const PriorSign sign : {PriorSign::minus_log, PriorSign::plus_log_as_printed}) {
    const Example example = random_example(4, sign);
    const double factor = sign == PriorSign::minus_log ? -1.0 : 1.0;
    for (std::size_t i = 0; i < example.field.matches.size(); ++i) {
      const Match& match = example.field.matches[i];
      const double prior = example.database.prior(match.face, BackgroundOptions{}.prior);
      EXPECT_NEAR(example.field.unary[i][kOn], factor * std::log(prior) - match.log_likelihood_on, 1e-12);
      EXPECT_NEAR(example.field.unary[i][kOff], factor * std::log(1.0 - prior) - match.log_likelihood_off, 1e-12);
    }
  }
}

TEST(HypothesisField, unaries_differ_by_the_posterior_log_odds_with_the_minus_sign) {
  // Bayes: P(M|R) / P(not M|R) = P(R|M) P(M) / (P(R|not M) (1 - P(M))), the reason for the minus.
  const Example example = random_example(5);
  for (std::size_t i = 0; i < example.field.matches.size(); ++i) {
    const Match& match = example.field.matches[i];
    const double prior = example.database.prior(match.face, BackgroundOptions{}.prior);
    const double odds = std::exp(match.log_likelihood_on - match.log_likelihood_off) * prior / (1.0 - prior);
    EXPECT_NEAR(example.field.unary[i][kOff] - example.field.unary[i][kOn], std::log(odds), 1e-12);
  }
}

TEST(HypothesisField, is_empty_without_regions) {
  Random random(6);
  const Database database = random_database(random, 1, 3);
  const HypothesisField field = build_hypothesis_field({}, {}, database, {}, {});
  EXPECT_TRUE(field.matches.empty() && field.unary.empty() && field.supports.empty() && field.by_region.empty());
  EXPECT_EQ(energy(field, {}), 0.0);
}

// The potential of one pair as the paper prints the table.
double pair_energy(const HypothesisField& field, std::size_t a, std::size_t b, const PoolVector<Label>& labels) {
  const Potentials& v = field.potentials;
  const bool on_a = labels[a] == kOn;
  const bool on_b = labels[b] == kOn;
  if (field.matches[a].region == field.matches[b].region) {
    return on_a && on_b ? v.contradiction_on_on : on_a != on_b ? v.contradiction_on_off : 0.0;
  }
  const auto& neighbours = field.supports[a];
  if (!std::binary_search(neighbours.begin(), neighbours.end(), static_cast<int>(b))) return 0.0;
  return on_a && on_b ? v.support_on_on : !on_a && !on_b ? v.support_off_off : 0.0;
}

TEST(Energy, sums_every_unary_and_every_unordered_pair_once) {
  Random random(7);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Example example = random_example(seed);
    const std::size_t count = example.field.matches.size();
    PoolVector<Label> labels(count);
    for (Label& label : labels) label = random.uniform() < 0.5 ? kOn : kOff;
    double expected = 0.0;
    for (std::size_t a = 0; a < count; ++a) {
      expected += example.field.unary[a][labels[a]];
      for (std::size_t b = a + 1; b < count; ++b) expected += pair_energy(example.field, a, b, labels);
    }
    EXPECT_NEAR(energy(example.field, labels), expected, 1e-8);
  }
}

TEST(Energy, of_two_matches_is_the_table_of_the_paper) {
  HypothesisField field;
  field.unary = {{0.0, 0.0}, {0.0, 0.0}};
  field.matches.resize(2);
  field.matches[1].region = 1;
  field.by_region = {{0}, {1}};
  field.supports = {{1}, {0}};
  EXPECT_EQ(energy(field, {kOn, kOn}), -60.0);
  EXPECT_EQ(energy(field, {kOff, kOff}), 40.0);
  EXPECT_EQ(energy(field, {kOn, kOff}), 0.0);
  field.matches[1].region = 0;
  field.by_region = {{0, 1}};
  field.supports = {{}, {}};
  EXPECT_EQ(energy(field, {kOn, kOn}), 60.0);
  EXPECT_EQ(energy(field, {kOff, kOff}), 0.0);
  EXPECT_EQ(energy(field, {kOn, kOff}), -10.0);
  EXPECT_EQ(energy(field, {kOff, kOn}), -10.0);
}

}  // namespace
}  // namespace foresight
