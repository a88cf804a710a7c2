// Nearest data point of a range image, eq. (10), however it is searched for.
#pragma once

#include <Eigen/Core>

namespace foresight {

// Const methods may run in parallel.
class NearestData {
 public:
  struct Answer {
    Eigen::Vector3f point;  // the nearest data point
    int cell = 0;           // its cell in the image
    float distance = 0.0F;  // Unit: mm.
    int index = 0;          // names the point in `guess` below; -1: none within reach
  };
  virtual ~NearestData() = default;

  // REQUIRES: a finite query. Of points equally near, the same one every time.
  [[nodiscard]] virtual Answer find(const Eigen::Vector3f& query) const = 0;
  // The same, sooner: the search starts from a point that is likely near, such as the answer to a query near by.
  // Of points equally near, the guess is preferred. REQUIRES: guess is an Answer::index of this object.
  [[nodiscard]] virtual Answer find(const Eigen::Vector3f& query, int guess) const = 0;
  // The same among points nearer than `reach`, sooner where there is none: then the answer is the query itself, at the
  // distance `reach`, with index -1. A guess of -1 is none. REQUIRES: reach > 0.
  [[nodiscard]] virtual Answer find_within(const Eigen::Vector3f& query, float reach, int guess = -1) const = 0;
};

}  // namespace foresight
