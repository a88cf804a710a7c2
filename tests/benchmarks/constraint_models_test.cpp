#include "benchmarks/constraint_models.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/random.h"

namespace foresight {
namespace {

constexpr double kWidth = 2.0;

// Half of the samples near 20, half near 60: what no normal distribution is.
std::vector<double> two_humps() {
  Random random(5);
  std::vector<double> samples;
  for (int i = 0; i < 400; ++i) samples.push_back((i % 2 == 0 ? 20.0 : 60.0) + random.gaussian());
  return samples;
}

AttributeKnowledge knowledge_of(const std::vector<double>& samples) {
  const DensityOptions options{50, 0.0};
  const Density density = samples.empty() ? Density{} : estimate_density(samples, 0.0, kWidth * 50, options);
  return {samples, density, 65.0, 1.5, false};
}

double total(const Constraint& constraint) {
  double sum = 0.0;
  for (int bin = 0; bin < 100; ++bin) sum += constraint.probability((bin + 0.5) * kWidth, kWidth);
  return sum;
}

TEST(ConstraintModels, have_bins_that_sum_to_one) {
  const std::vector<double> samples = two_humps();
  const auto constraints = constraints_for(knowledge_of(samples));
  for (std::size_t c = 0; c < kConstraintCount; ++c) {
    // The fitted normal's tail reaches below 0.
    EXPECT_NEAR(total(constraints[c]), 1.0, c == 1 ? 0.05 : 1e-6) << kConstraintNames[c];
  }
}

TEST(ConstraintModels, keep_all_samples_they_were_made_from_when_histograms) {
  const std::vector<double> samples = two_humps();
  const auto constraints = constraints_for(knowledge_of(samples));
  for (const double sample : samples) EXPECT_TRUE(constraints[0].keeps(sample));
  EXPECT_FALSE(constraints[0].keeps(40.0)) << "between the humps";
  EXPECT_TRUE(constraints[1].keeps(40.0)) << "the fitted normal is highest there";
}

TEST(ConstraintModels, fit_the_mean_and_the_standard_deviation) {
  const std::vector<double> samples = {10.0, 12.0, 14.0};
  const Constraint fitted = constraints_for(knowledge_of(samples))[1];
  EXPECT_DOUBLE_EQ(fitted.mean, 12.0);
  EXPECT_DOUBLE_EQ(fitted.sigma, 2.0);
  EXPECT_TRUE(fitted.keeps(12.0 + 2.9 * 2.0));
  EXPECT_FALSE(fitted.keeps(12.0 + 3.1 * 2.0));
}

TEST(ConstraintModels, bound_by_the_cad_value) {
  const std::vector<double> samples = two_humps();
  const auto constraints = constraints_for(knowledge_of(samples));
  const auto kept = [&](std::size_t c, double value) { return constraints[c].keeps(value); };
  EXPECT_TRUE(kept(2, 69.0) && !kept(2, 70.0)) << "65 + 3 * 1.5";
  EXPECT_TRUE(kept(3, 0.0) && kept(3, 65.0) && !kept(3, 65.1));
  EXPECT_TRUE(kept(4, 69.0) && !kept(4, 70.0));
  EXPECT_TRUE(kept(5, 52.1) && kept(5, 71.4) && !kept(5, 51.9) && !kept(5, 71.6));
}

TEST(ConstraintModels, bound_an_angle_on_both_sides) {
  AttributeKnowledge knowledge = knowledge_of({});
  knowledge.cad_value = 0.0;
  knowledge.cad_sigma = 0.1;
  knowledge.angle = true;
  const auto constraints = constraints_for(knowledge);
  for (const std::size_t c : {3, 4, 5}) {
    EXPECT_TRUE(constraints[c].keeps(0.29)) << kConstraintNames[c];
    EXPECT_FALSE(constraints[c].keeps(0.31)) << kConstraintNames[c];
  }
}

TEST(ConstraintModels, without_samples_keep_nothing_but_by_cad) {
  const auto constraints = constraints_for(knowledge_of({}));
  for (const std::size_t c : {0, 1}) {
    EXPECT_FALSE(constraints[c].keeps(65.0)) << kConstraintNames[c];
    EXPECT_EQ(constraints[c].probability(65.0, kWidth), 0.0) << kConstraintNames[c];
  }
  EXPECT_TRUE(constraints[2].keeps(65.0));
}

TEST(ConstraintModels, with_one_sample_fit_the_spread_of_a_measurement) {
  const std::vector<double> samples = {30.0};
  const Constraint fitted = constraints_for(knowledge_of(samples))[1];
  EXPECT_DOUBLE_EQ(fitted.mean, 30.0);
  EXPECT_DOUBLE_EQ(fitted.sigma, 1.5);
}

}  // namespace
}  // namespace foresight
