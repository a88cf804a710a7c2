// Nearest data point by a k-d tree, as in the paper. The only place that knows FLANN.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "common/range_image.h"
#include "runtime/nearest_data.h"

namespace foresight {

// A k-d tree over all valid cells; exact up to the rounding of float. Keeps its own copy of the points.
class NearestDataPoint final : public NearestData {
 public:
  // REQUIRES: at least one valid cell.
  explicit NearestDataPoint(const RangeImage& image);
  ~NearestDataPoint() override;
  NearestDataPoint(NearestDataPoint&&) noexcept;
  NearestDataPoint& operator=(NearestDataPoint&&) noexcept;

  [[nodiscard]] Answer find(const Eigen::Vector3f& query) const override;
  [[nodiscard]] Answer find(const Eigen::Vector3f& query, int guess) const override;
  [[nodiscard]] Answer find_within(const Eigen::Vector3f& query, float reach, int guess = -1) const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace foresight
