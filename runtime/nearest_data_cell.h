// Nearest data point by the grid of the range image: points near each other lie in cells near each other.
//
// Beyond the paper, whose k-d tree (nearest_data_point.h) knows points only. A grid needs next to no building, and a
// search within a short reach looks at a few dozen cells and blocks of cells. Far searches are the tree's.
#pragma once

#include <limits>

#include "common/camera.h"
#include "common/memory_pool.h"
#include "common/range_image.h"
#include "runtime/nearest_data.h"

namespace foresight {

// Exact up to the rounding of float where the data lie on the camera's rays, each within half a cell of that through
// its own cell. A query that does not lie before the camera finds nothing.
class NearestDataCell final : public NearestData {
 public:
  // Refers to the image. stride: of so many rows, and of so many columns, one takes part. REQUIRES: the camera has the
  // image's size; stride >= 1.
  NearestDataCell(const RangeImage& image, const PinholeCamera& camera, int stride = 1);
  NearestDataCell(const NearestDataCell&) = delete;
  NearestDataCell& operator=(const NearestDataCell&) = delete;

  [[nodiscard]] Answer find(const Eigen::Vector3f& query) const override;
  [[nodiscard]] Answer find(const Eigen::Vector3f& query, int guess) const override;
  [[nodiscard]] Answer find_within(const Eigen::Vector3f& query, float reach, int guess = -1) const override;

 private:
  struct Depths {
    float least = std::numeric_limits<float>::infinity();  // of the cells of a block. Unit: mm.
    float most = -std::numeric_limits<float>::infinity();
  };
  struct Blocks {
    int side = 0;  // Unit: cells.
    int rows = 0;
    int columns = 0;
    PoolVector<Depths> depths;  // row by row
  };
  struct Search;
  [[nodiscard]] static Blocks blocks_of(const RangeImage& image, int side);

  int stride_;
  int columns_;              // of the whole image
  RangeImage thinned_;       // where the stride is not 1
  const RangeImage& image_;  // the cells that take part
  float fx_, fy_, cx_, cy_;
  // A point is this far, by its depth, from a plane of rays one column or row beside it, at least.
  float column_step_, row_step_;
  float aside_;     // by which squares of two such distances together must be multiplied to be a bound
  float anywhere_;  // the same for these two and the difference in depth
  Blocks fine_, coarse_;
};

}  // namespace foresight
