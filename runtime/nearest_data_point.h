// Nearest data point of a range image, eq. (10). The only place that knows FLANN.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "common/range_image.h"

namespace foresight {

// A k-d tree over all valid cells; exact up to the rounding of float. Keeps its own copy of the points. Const methods
// may run in parallel.
class NearestDataPoint {
 public:
  // REQUIRES: at least one valid cell.
  explicit NearestDataPoint(const RangeImage& image);
  ~NearestDataPoint();
  NearestDataPoint(NearestDataPoint&&) noexcept;
  NearestDataPoint& operator=(NearestDataPoint&&) noexcept;

  struct Answer {
    Eigen::Vector3f point;  // the nearest data point
    int cell = 0;           // its cell in the image
    float distance = 0.0F;  // Unit: mm.
    int index = 0;          // names the point in `guess` below; -1: none within reach
  };
  // REQUIRES: a finite query. Of points equally near, the same one every time.
  [[nodiscard]] Answer find(const Eigen::Vector3f& query) const;
  // The same, sooner: the search starts from a point that is likely near, such as the answer to a query near by.
  // Of points equally near, the guess is preferred. REQUIRES: guess is an Answer::index of this object.
  [[nodiscard]] Answer find(const Eigen::Vector3f& query, int guess) const;
  // The same among points nearer than `reach`, sooner where there is none: then the answer is the query itself, at the
  // distance `reach`, with index -1. A guess of -1 is none. REQUIRES: reach > 0.
  [[nodiscard]] Answer find_within(const Eigen::Vector3f& query, float reach, int guess = -1) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace foresight
