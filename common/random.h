// Seeded random numbers that are the same with every compiler and library (the std distributions are not).
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace foresight {

// SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  // An independent stream for item `index` of the work seeded with `seed`: the result cannot depend on the order of the items.
  Random(std::uint64_t seed, std::uint64_t index);

  [[nodiscard]] std::uint64_t next();
  [[nodiscard]] double uniform();                             // [0, 1)
  [[nodiscard]] double uniform(double low, double high);      // [low, high)
  [[nodiscard]] int integer(int low, int high);               // low..high, both included
  [[nodiscard]] double gaussian();                            // mean 0, standard deviation 1
  [[nodiscard]] Eigen::Vector3d direction();                  // uniform on the unit sphere
  [[nodiscard]] Eigen::Matrix3d rotation();                   // uniform over all rotations

 private:
  std::uint64_t state_;
};

}  // namespace foresight
