#include "runtime/robust_loss.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace foresight {
namespace {

class AnyLoss : public testing::TestWithParam<Loss> {};
INSTANTIATE_TEST_SUITE_P(RobustLoss, AnyLoss,
                         testing::Values(Loss::lorentzian, Loss::tukey, Loss::huber, Loss::gaussian));

// Both sides of 0 and of the constants, and far away.
std::vector<double> errors() {
  std::vector<double> all;
  for (int i = -400; i <= 400; ++i) all.push_back(0.0251 * i);
  for (const double far : {50.0, 1e3, 1e6}) all.insert(all.end(), {far, -far});
  return all;
}

TEST_P(AnyLoss, is_zero_at_zero) {
  EXPECT_EQ(rho(GetParam(), 0.0), 0.0);
  EXPECT_EQ(psi(GetParam(), 0.0), 0.0);
}

TEST_P(AnyLoss, has_psi_as_its_derivative) {
  for (const double u : errors()) {
    const double h = 1e-5 * std::max(1.0, std::abs(u));
    const double difference = (rho(GetParam(), u + h) - rho(GetParam(), u - h)) / (2.0 * h);
    EXPECT_NEAR(psi(GetParam(), u), difference, 1e-5 * std::max(1.0, std::abs(u))) << u;
  }
}

TEST_P(AnyLoss, has_a_weight_that_times_u_is_psi) {
  for (const double u : errors()) {
    EXPECT_NEAR(weight(GetParam(), u) * u, psi(GetParam(), u), 1e-12 * std::abs(u)) << u;
  }
}

TEST_P(AnyLoss, has_weight_one_at_zero_as_its_limit) {
  EXPECT_EQ(weight(GetParam(), 0.0), 1.0);
  EXPECT_NEAR(psi(GetParam(), 1e-6) / 1e-6, 1.0, 1e-9);
}

TEST_P(AnyLoss, is_even_and_its_psi_odd) {
  for (const double u : errors()) {
    EXPECT_EQ(rho(GetParam(), u), rho(GetParam(), -u));
    EXPECT_EQ(psi(GetParam(), u), -psi(GetParam(), -u));
    EXPECT_EQ(weight(GetParam(), u), weight(GetParam(), -u));
  }
}

TEST_P(AnyLoss, never_falls_with_the_size_of_the_error) {
  for (double u = 0.0; u < 20.0; u += 0.01) EXPECT_LE(rho(GetParam(), u), rho(GetParam(), u + 0.01)) << u;
}

TEST_P(AnyLoss, never_weighs_a_larger_error_more) {
  for (double u = 0.0; u < 20.0; u += 0.01) EXPECT_GE(weight(GetParam(), u), weight(GetParam(), u + 0.01)) << u;
}

TEST(RobustLoss, lorentzian_is_equation_8) {
  EXPECT_DOUBLE_EQ(rho(Loss::lorentzian, 2.0), std::log(3.0));
  EXPECT_DOUBLE_EQ(psi(Loss::lorentzian, 2.0), 2.0 / 3.0);
}

TEST(RobustLoss, lorentzian_and_tukey_let_outliers_go) {
  for (const Loss loss : {Loss::lorentzian, Loss::tukey}) {
    double largest = 0.0;
    for (double u = 0.0; u < 10.0; u += 0.01) largest = std::max(largest, psi(loss, u));
    EXPECT_LT(psi(loss, 100.0), 0.05 * largest);
  }
}

TEST(RobustLoss, tukey_is_level_beyond_its_constant) {
  const double level = kTukeyConstant * kTukeyConstant / 6.0;
  for (const double u : {kTukeyConstant, kTukeyConstant + 1.0, 1e6}) {
    EXPECT_DOUBLE_EQ(rho(Loss::tukey, u), level);
    EXPECT_EQ(psi(Loss::tukey, u + 1e-9), 0.0);
  }
  EXPECT_LT(rho(Loss::tukey, kTukeyConstant - 0.5), level);
}

TEST(RobustLoss, huber_is_gaussian_up_to_its_constant_and_straight_beyond) {
  EXPECT_EQ(rho(Loss::huber, 1.3), rho(Loss::gaussian, 1.3));
  EXPECT_NEAR(rho(Loss::huber, kHuberConstant + 1e-9), rho(Loss::gaussian, kHuberConstant), 1e-8);
  EXPECT_DOUBLE_EQ(psi(Loss::huber, 2.0), kHuberConstant);
  EXPECT_DOUBLE_EQ(psi(Loss::huber, 1e6), kHuberConstant);
}

}  // namespace
}  // namespace foresight
