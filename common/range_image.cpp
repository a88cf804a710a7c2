#include "common/range_image.h"

#include <algorithm>

namespace foresight {

RangeImage::RangeImage(int rows_, int columns_)
    : rows(rows_),
      columns(columns_),
      points(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_),
             Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN())) {}

int count_valid(const RangeImage& image) {
  return static_cast<int>(std::count_if(image.points.begin(), image.points.end(),
                                        [](const Eigen::Vector3f& point) { return !std::isnan(point.z()); }));
}

}  // namespace foresight
