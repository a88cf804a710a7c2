// Logistic regression with a ridge penalty towards expected weights.
#pragma once

#include <Eigen/Core>

namespace foresight {

struct LogisticFit {
  Eigen::VectorXd weights;
  double bias = 0.0;
};

// Maximises the log-likelihood of the labels (1 right, 0 wrong) less ridge / 2 * (weight - expected)^2 of each weight,
// by Newton's method (iteratively reweighted least squares; Hastie, Tibshirani and Friedman, "The Elements of
// Statistical Learning", 2009, Section 4.4.1). features: one row a sample. ridges: of each weight. expected: of each
// weight; empty: zero. REQUIRES: as many labels as rows; both labels occur; ridges > 0.
[[nodiscard]] LogisticFit fit_logistic(const Eigen::MatrixXd& features, const Eigen::VectorXd& labels,
                                       const Eigen::VectorXd& ridges, const Eigen::VectorXd& expected = {});

}  // namespace foresight
