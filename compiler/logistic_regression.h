// Logistic regression with a ridge penalty towards expected weights.
#pragma once

#include <Eigen/Core>

namespace foresight {

struct LogisticFit {
  Eigen::VectorXd weights;
  double bias = 0.0;
};

// Maximises the log-likelihood of the labels (1 right, 0 wrong), both classes weighing the same in all, less
// ridge / 2 * |weights - expected|^2, by Newton's method (iteratively reweighted least squares; Hastie, Tibshirani and
// Friedman, "The Elements of Statistical Learning", 2009, Section 4.4.1). features: one row a sample. expected: of each
// weight; empty: zero. REQUIRES: as many labels as rows; both labels occur; ridge > 0.
[[nodiscard]] LogisticFit fit_logistic(const Eigen::MatrixXd& features, const Eigen::VectorXd& labels, double ridge,
                                       const Eigen::VectorXd& expected = {});

}  // namespace foresight
