#include "runtime/match_likelihoods.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/random.h"

namespace foresight {
namespace {

constexpr int kBins = 24;

Density density_of(std::vector<float> mass) {
  Density density;
  density.bin_width = 1.0;
  density.mass = std::move(mass);
  return density;
}

// A face whose four attributes all follow one distribution over the values 0 to kBins.
ModelFace face_of(const std::vector<float>& mass, int views_found) {
  ModelFace face;
  face.views_found = views_found;
  if (views_found > 0) face.densities.fill(density_of(mass));
  return face;
}

// A share of the views in one bin, the rest of them in the last.
ModelFace peaked_face(int bin, float share, int views_found) {
  std::vector<float> mass(kBins, 0.0F);
  mass[static_cast<std::size_t>(bin)] = share;
  mass.back() += 1.0F - share;
  return face_of(mass, views_found);
}

Database database_of(std::vector<ModelFace> faces) {
  CompiledModel model;
  model.name = "test";
  model.views = 320;
  model.faces = std::move(faces);
  CompiledDatabase content;
  content.models.push_back(std::move(model));
  return Database(std::move(content));
}

DescribedRegion region_with(double value) {
  DescribedRegion region;
  region.attributes.fill(value);
  return region;
}

// Faces with random distributions that hold zeros.
Database random_database(Random& random, int count) {
  std::vector<ModelFace> faces;
  for (int i = 0; i < count; ++i) {
    std::vector<float> mass(kBins);
    float sum = 0.0F;
    for (float& m : mass) sum += m = random.uniform() < 0.5 ? 0.0F : static_cast<float>(random.uniform());
    mass.front() += 0.01F;
    for (float& m : mass) m /= sum + 0.01F;
    faces.push_back(face_of(mass, random.integer(0, 320)));
  }
  return database_of(std::move(faces));
}

PoolVector<DescribedRegion> random_regions(Random& random, int count) {
  PoolVector<DescribedRegion> regions(static_cast<std::size_t>(count));
  for (DescribedRegion& region : regions) {
    for (double& value : region.attributes) value = random.uniform(0.0, kBins);
  }
  return regions;
}

TEST(MatchLikelihoods, keeps_exactly_the_matches_above_zero_by_region_then_face) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Database database = random_database(random, 30);
    const auto regions = random_regions(random, 10);
    std::vector<std::pair<int, int>> expected;
    for (int i = 0; i < 10; ++i) {
      for (int j = 0; j < static_cast<int>(database.faces().size()); ++j) {
        if (database.likelihood(j, regions[static_cast<std::size_t>(i)].attributes) > 0.0) expected.emplace_back(i, j);
      }
    }
    std::vector<std::pair<int, int>> kept;
    for (const Match& match : match_likelihoods(regions, database, {})) kept.emplace_back(match.region, match.face);
    EXPECT_EQ(kept, expected);
  }
}

TEST(MatchLikelihoods, follows_equations_4_and_5) {
  Random random(2);
  const BackgroundOptions background;
  const Database database = random_database(random, 40);
  const auto regions = random_regions(random, 40);
  const auto matches = match_likelihoods(regions, database, background);
  ASSERT_GT(matches.size(), 50U);
  for (const Match& match : matches) {
    const AttributeVector& attributes = regions[static_cast<std::size_t>(match.region)].attributes;
    double others = background.likelihood * background.prior;
    for (int k = 0; k < static_cast<int>(database.faces().size()); ++k) {
      if (k != match.face) others += database.likelihood(k, attributes) * database.prior(k, background.prior);
    }
    const double off = others / (1.0 - database.prior(match.face, background.prior));
    EXPECT_DOUBLE_EQ(match.log_likelihood_on, std::log(database.likelihood(match.face, attributes)));
    EXPECT_NEAR(match.log_likelihood_off, std::log(off), 1e-12);
  }
}

TEST(MatchLikelihoods, give_every_match_of_a_region_the_same_total_probability) {
  Random random(3);
  const BackgroundOptions background;
  const Database database = random_database(random, 40);
  const auto matches = match_likelihoods(random_regions(random, 40), database, background);
  std::size_t compared = 0;
  for (std::size_t i = 1; i < matches.size(); ++i) {
    if (matches[i].region != matches[i - 1].region) continue;
    const auto total = [&](const Match& match) {
      const double prior = database.prior(match.face, background.prior);
      return std::exp(match.log_likelihood_on) * prior + std::exp(match.log_likelihood_off) * (1.0 - prior);
    };
    EXPECT_NEAR(total(matches[i]) / total(matches[i - 1]), 1.0, 1e-12);
    ++compared;
  }
  EXPECT_GT(compared, 20U);
}

TEST(MatchLikelihoods, lose_nothing_where_one_face_explains_nearly_everything) {
  // Own term 0.35, all others together some 1e-19: the whole sum minus the own term would leave nothing of them.
  BackgroundOptions background;
  background.likelihood = 1e-19;
  const Database database = database_of({peaked_face(3, 1.0F, 100), peaked_face(3, 1e-5F, 100)});
  const auto matches = match_likelihoods({region_with(3.5)}, database, background);
  ASSERT_EQ(matches.size(), 2U);
  const double other = database.likelihood(1, region_with(3.5).attributes) * database.prior(1, background.prior);
  const double expected = (other + 1e-19 * background.prior) / (1.0 - database.prior(0, background.prior));
  EXPECT_NEAR(matches[0].log_likelihood_off, std::log(expected), 1e-12);
}

TEST(MatchLikelihoods, leave_only_the_background_where_no_other_face_fits) {
  const BackgroundOptions background;
  const Database database = database_of({peaked_face(3, 1.0F, 100), peaked_face(9, 1.0F, 100)});
  const auto matches = match_likelihoods({region_with(3.5)}, database, background);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].face, 0);
  const double off = background.likelihood * background.prior / (1.0 - database.prior(0, background.prior));
  EXPECT_NEAR(matches[0].log_likelihood_off, std::log(off), 1e-12);
}

TEST(MatchLikelihoods, are_none_without_regions_or_fitting_faces) {
  const Database database = database_of({peaked_face(3, 1.0F, 100)});
  EXPECT_TRUE(match_likelihoods({}, database, {}).empty());
  EXPECT_TRUE(match_likelihoods({region_with(5.5)}, database, {}).empty());
  EXPECT_TRUE(match_likelihoods({region_with(-4.0), region_with(1e9)}, database, {}).empty());
}

}  // namespace
}  // namespace foresight
