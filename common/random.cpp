#include "common/random.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace foresight {

Random::Random(std::uint64_t seed, std::uint64_t index) : state_(seed) {
  // Two scrambled draws keep the streams of neighbouring seeds and indices apart.
  state_ = next() ^ (index * 0xD1342543DE82EF95ULL);
  state_ = next();
}

std::uint64_t Random::next() {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

double Random::uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

int Random::integer(int low, int high) {
  const auto span = static_cast<double>(high) - static_cast<double>(low) + 1.0;
  return low + static_cast<int>(std::floor(uniform() * span));
}

double Random::gaussian() {
  // Box and Muller, one of the pair: no state beside the counter.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

Eigen::Vector3d Random::direction() {
  const double z = uniform(-1.0, 1.0);
  const double angle = uniform(0.0, 2.0 * std::numbers::pi);
  const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

Eigen::Matrix3d Random::rotation() {
  // Shoemake, "Uniform random rotations", Graphics Gems III, 1992.
  const double u = uniform();
  const double a = uniform(0.0, 2.0 * std::numbers::pi);
  const double b = uniform(0.0, 2.0 * std::numbers::pi);
  const Eigen::Quaterniond q(std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
                             std::sqrt(u) * std::sin(b));
  return q.normalized().toRotationMatrix();
}

}  // namespace foresight
