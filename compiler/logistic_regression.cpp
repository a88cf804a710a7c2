#include "compiler/logistic_regression.h"

#include <Eigen/Cholesky>
#include <cassert>
#include <cmath>

namespace foresight {
namespace {

constexpr int kMostSteps = 100;
constexpr double kSmallestStep = 1e-9;

// The penalised negative log-likelihood. theta, expected: weights, then bias.
double loss(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& ridges,
            const Eigen::VectorXd& expected, const Eigen::VectorXd& theta) {
  double sum = 0.5 * ridges.dot((theta - expected).head(ridges.size()).cwiseAbs2());
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double margin = (2.0 * y[i] - 1.0) * x.row(i).dot(theta);
    // log(1 + exp(-margin)), without overflow
    sum += margin > 0.0 ? std::log1p(std::exp(-margin)) : std::log1p(std::exp(margin)) - margin;
  }
  return sum;
}

}  // namespace

LogisticFit fit_logistic(const Eigen::MatrixXd& features, const Eigen::VectorXd& labels, const Eigen::VectorXd& ridges,
                         const Eigen::VectorXd& expected) {
  const Eigen::Index n = features.rows();
  const Eigen::Index k = features.cols();
  assert(labels.size() == n && labels.sum() > 0.0 && labels.sum() < static_cast<double>(n));
  assert(ridges.size() == k && ridges.minCoeff() > 0.0);
  Eigen::MatrixXd x(n, k + 1);
  x << features, Eigen::VectorXd::Ones(n);
  assert(expected.size() == 0 || expected.size() == k);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(k + 1);
  if (expected.size() > 0) theta.head(k) = expected;
  const Eigen::VectorXd centre = theta;
  double now = loss(x, labels, ridges, centre, theta);
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::VectorXd p = (1.0 / (1.0 + (-(x * theta)).array().exp())).matrix();
    Eigen::VectorXd gradient = x.transpose() * (p - labels);
    gradient.head(k) += ridges.cwiseProduct((theta - centre).head(k));
    const Eigen::VectorXd curvature = (p.array() * (1.0 - p.array())).matrix();
    Eigen::MatrixXd hessian = x.transpose() * curvature.asDiagonal() * x;
    hessian.diagonal().head(k) += ridges;
    hessian(k, k) += 1e-9;  // the bias has no penalty; all p may be 0 or 1
    Eigen::VectorXd change = -hessian.ldlt().solve(gradient);
    // Newton's step may overshoot where the classes are far apart: halve it until the loss falls.
    double next = loss(x, labels, ridges, centre, theta + change);
    while (!(next <= now) && change.norm() > kSmallestStep) {
      change *= 0.5;
      next = loss(x, labels, ridges, centre, theta + change);
    }
    if (change.norm() <= kSmallestStep) break;
    theta += change;
    now = next;
  }
  return {theta.head(k), theta[k]};
}

}  // namespace foresight
