#include "compiler/logistic_regression.h"

#include <Eigen/Cholesky>
#include <cassert>
#include <cmath>

namespace foresight {
namespace {

constexpr int kMostSteps = 100;
constexpr double kSmallestStep = 1e-9;

// The penalised negative log-likelihood. theta, expected: weights, then bias.
double loss(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& sample_weights, double ridge,
            const Eigen::VectorXd& expected, const Eigen::VectorXd& theta) {
  double sum = 0.5 * ridge * (theta - expected).head(theta.size() - 1).squaredNorm();
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double margin = (2.0 * y[i] - 1.0) * x.row(i).dot(theta);
    // log(1 + exp(-margin)), without overflow
    sum += sample_weights[i] * (margin > 0.0 ? std::log1p(std::exp(-margin)) : std::log1p(std::exp(margin)) - margin);
  }
  return sum;
}

}  // namespace

LogisticFit fit_logistic(const Eigen::MatrixXd& features, const Eigen::VectorXd& labels, double ridge,
                         const Eigen::VectorXd& expected) {
  assert(features.rows() == labels.size() && ridge > 0.0);
  const Eigen::Index n = features.rows();
  const Eigen::Index k = features.cols();
  const double right = labels.sum();
  assert(right > 0.0 && right < static_cast<double>(n));
  Eigen::VectorXd sample_weights(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    sample_weights[i] = 0.5 * static_cast<double>(n) / (labels[i] > 0.5 ? right : static_cast<double>(n) - right);
  }
  Eigen::MatrixXd x(n, k + 1);
  x << features, Eigen::VectorXd::Ones(n);
  assert(expected.size() == 0 || expected.size() == k);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(k + 1);
  if (expected.size() > 0) theta.head(k) = expected;
  const Eigen::VectorXd centre = theta;
  double now = loss(x, labels, sample_weights, ridge, centre, theta);
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::VectorXd p = (1.0 / (1.0 + (-(x * theta)).array().exp())).matrix();
    Eigen::VectorXd gradient = x.transpose() * (sample_weights.array() * (p - labels).array()).matrix();
    gradient.head(k) += ridge * (theta - centre).head(k);
    const Eigen::VectorXd curvature = (sample_weights.array() * p.array() * (1.0 - p.array())).matrix();
    Eigen::MatrixXd hessian = x.transpose() * curvature.asDiagonal() * x;
    hessian.diagonal().head(k).array() += ridge;
    hessian(k, k) += 1e-9;  // the bias has no penalty; all p may be 0 or 1
    Eigen::VectorXd change = -hessian.ldlt().solve(gradient);
    // Newton's step may overshoot where the classes are far apart: halve it until the loss falls.
    double next = loss(x, labels, sample_weights, ridge, centre, theta + change);
    while (!(next <= now) && change.norm() > kSmallestStep) {
      change *= 0.5;
      next = loss(x, labels, sample_weights, ridge, centre, theta + change);
    }
    if (change.norm() <= kSmallestStep) break;
    theta += change;
    now = next;
  }
  return {theta.head(k), theta[k]};
}

}  // namespace foresight
