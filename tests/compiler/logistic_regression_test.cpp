#include "compiler/logistic_regression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/random.h"

namespace foresight {
namespace {

struct Samples {
  Eigen::MatrixXd features;
  Eigen::VectorXd labels;
};

// Two clouds in the plane about +-(distance, distance) / 2: the right ones first.
Samples clusters(int right, int wrong, double distance, double spread = 1.0) {
  Random random(3);
  Samples samples{Eigen::MatrixXd(right + wrong, 2), Eigen::VectorXd(right + wrong)};
  for (int i = 0; i < right + wrong; ++i) {
    samples.labels[i] = i < right ? 1.0 : 0.0;
    for (int k = 0; k < 2; ++k) {
      samples.features(i, k) = (i < right ? 0.5 : -0.5) * distance + spread * random.gaussian();
    }
  }
  return samples;
}

// Every sample of the one class is the mirror image of one of the other; each wrong one occurs `times`.
Samples mirrored(int pairs, int times) {
  const Samples half = clusters(pairs, 1, 1.0);
  Samples samples{Eigen::MatrixXd(pairs * (1 + times), 2), Eigen::VectorXd::Zero(pairs * (1 + times))};
  samples.features.topRows(pairs) = half.features.topRows(pairs);
  samples.labels.head(pairs).setOnes();
  for (int t = 0; t < times; ++t) {
    samples.features.middleRows(pairs * (1 + t), pairs) = -half.features.topRows(pairs);
  }
  return samples;
}

LogisticFit fit(const Samples& samples, double ridge) {
  return fit_logistic(samples.features, samples.labels, Eigen::VectorXd::Constant(samples.features.cols(), ridge));
}

Eigen::VectorXd probabilities(const Samples& samples, const LogisticFit& fit) {
  const Eigen::ArrayXd sums = (samples.features * fit.weights).array() + fit.bias;
  return (1.0 / (1.0 + (-sums).exp())).matrix();
}

// The penalised loss, written once more.
double loss(const Samples& samples, const Eigen::VectorXd& weights, double bias, double ridge) {
  double sum = 0.5 * ridge * weights.squaredNorm();
  for (Eigen::Index i = 0; i < samples.labels.size(); ++i) {
    const double margin = samples.features.row(i).dot(weights) + bias;
    const bool is_right = samples.labels[i] > 0.5;
    sum += std::log1p(std::exp(is_right ? -margin : margin));
  }
  return sum;
}

TEST(LogisticRegression, separates_two_clusters) {
  const Samples samples = clusters(60, 80, 8.0);
  const Eigen::VectorXd p = probabilities(samples, fit(samples, 0.01));
  for (Eigen::Index i = 0; i < p.size(); ++i) EXPECT_EQ(p[i] > 0.5, samples.labels[i] > 0.5) << i;
}

TEST(LogisticRegression, no_step_from_the_optimum_lowers_the_loss) {
  for (const double ridge : {1e-3, 0.1, 10.0}) {
    const Samples samples = clusters(50, 90, 1.5);
    const LogisticFit best = fit(samples, ridge);
    constexpr double kStep = 1e-4;
    for (int k = 0; k < 3; ++k) {
      const auto moved = [&](double step) {
        Eigen::VectorXd weights = best.weights;
        if (k < 2) weights[k] += step;
        return loss(samples, weights, best.bias + (k == 2 ? step : 0.0), ridge);
      };
      EXPECT_NEAR((moved(kStep) - moved(-kStep)) / (2.0 * kStep), 0.0, 1e-5) << "parameter " << k;
      EXPECT_GT(moved(0.05), moved(0.0));
      EXPECT_GT(moved(-0.05), moved(0.0));
    }
  }
}

TEST(LogisticRegression, more_ridge_gives_smaller_weights) {
  const Samples samples = clusters(50, 50, 2.0);
  double last = 1e300;
  for (const double ridge : {1e-4, 1e-2, 1.0, 100.0, 1e6}) {
    const double norm = fit(samples, ridge).weights.norm();
    EXPECT_LT(norm, last) << ridge;
    last = norm;
  }
  EXPECT_LT(last, 1e-3);
}

// What is rare is improbable: the mean probability of the samples is the share of the right ones.
TEST(LogisticRegression, gives_the_samples_as_much_probability_as_right_ones_there_are) {
  for (const int times : {1, 3, 25}) {
    const Samples samples = mirrored(40, times);
    EXPECT_NEAR(probabilities(samples, fit(samples, 0.1)).mean(), 1.0 / (1.0 + times), 1e-6) << times;
  }
}

// A weight with a ridge of its own: one that leaves no choice beside one that asks for little.
TEST(LogisticRegression, holds_one_weight_and_leaves_the_other) {
  const Samples samples = clusters(60, 60, 2.0);
  const Eigen::Vector2d expected(5.0, 0.0);
  const LogisticFit held = fit_logistic(samples.features, samples.labels, Eigen::Vector2d(1e9, 1e-3), expected);
  EXPECT_NEAR(held.weights[0], 5.0, 1e-5);
  EXPECT_GT(std::abs(held.weights[1] - fit(samples, 1e-3).weights[1]), 0.1);  // makes up for the other
}

TEST(LogisticRegression, stays_finite_for_classes_far_apart) {
  for (const double distance : {10.0, 1e3, 1e6}) {
    const Samples samples = clusters(30, 2, distance);
    const LogisticFit far = fit(samples, 0.003);
    EXPECT_TRUE(far.weights.allFinite() && std::isfinite(far.bias)) << distance;
    const Eigen::VectorXd p = probabilities(samples, far);
    for (Eigen::Index i = 0; i < p.size(); ++i) EXPECT_EQ(p[i] > 0.5, samples.labels[i] > 0.5) << distance;
  }
}

TEST(LogisticRegression, takes_no_weight_from_a_feature_that_never_changes) {
  Samples samples = clusters(30, 30, 3.0);
  samples.features.col(1).setConstant(0.7);
  const LogisticFit constant = fit(samples, 0.1);
  EXPECT_NEAR(constant.weights[1], 0.0, 1e-6);  // the bias says the same without penalty
  EXPECT_GT(constant.weights[0], 0.1);
}

// With a penalty no data outweigh, the weights are what was expected; with hardly any, what the data say.
TEST(LogisticRegression, keeps_to_expected_weights_as_far_as_the_ridge_asks) {
  Eigen::MatrixXd features(6, 1);
  features << 0.0, 0.2, 0.6, 0.4, 0.8, 1.0;
  Eigen::VectorXd labels(6);
  labels << 0.0, 0.0, 0.0, 1.0, 1.0, 1.0;
  const Eigen::VectorXd expected = Eigen::VectorXd::Constant(1, -7.0);
  const auto weight = [&](double ridge, const Eigen::VectorXd& towards) {
    return fit_logistic(features, labels, Eigen::VectorXd::Constant(1, ridge), towards).weights[0];
  };
  EXPECT_NEAR(weight(1e6, expected), -7.0, 1e-3);
  EXPECT_NEAR(weight(1e-6, expected), weight(1e-6, {}), 1e-2);
}

}  // namespace
}  // namespace foresight
