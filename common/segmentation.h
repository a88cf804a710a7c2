// Feature extraction: planar regions by best-first region growing. Compiler and runtime run this very code with the
// very same options, because a prior is a statistic *of the feature extractor* (Section III).
#pragma once

#include <Eigen/Core>
#include <functional>

#include "common/memory_pool.h"
#include "common/range_image.h"
#include "common/sensor_model.h"

namespace foresight {

struct SegmentationOptions {
  double plane_sigma = 0.1;      // standard deviation of a data point about its plane. Unit: mm. Limit: > 0.
  double merge_tolerance = 2.5;  // patches are one plane while neither is farther than this many plane_sigma (rms) from
                                 // their common fit. Limit: > 1.
  double grow_tolerance = 4.0;   // a cell joins a region within this many plane_sigma of its plane. Limit: > 1.
  int seed_block = 3;            // side of the square patches growing starts from. Unit: cells. Limit: 2 to 16.
  int smallest_region = 12;      // regions of fewer cells are dropped. Unit: cells. Limit: >= 3.
  double largest_depth_step = 4.0;  // neighbouring cells farther apart in depth than this many cell spacings are
                                    // connected only where the slope goes on. Limit: > 1.
};

bool operator==(const SegmentationOptions& a, const SegmentationOptions& b);

// Throws UsageError when a field is outside its limits.
void check(const SegmentationOptions& options);

// The one setting per sensor: every option follows from the sensor's noise, quantization and resolution.
[[nodiscard]] SegmentationOptions segmentation_options_for(const SensorModel& sensor);

// A planar patch of the image.
struct Region {
  PoolVector<int> cells;                             // ascending cell indices
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit, towards the sensor
  double offset = 0.0;  // normal . p = offset for p on the plane. Unit: mm. Negative: the sensor is in front.
  double rms = 0.0;     // root mean square distance of the data points. Unit: mm.
};

// Asked between the steps of long work: whether to end it, unfinished. None: never.
using Stop = std::function<bool()>;

// Deterministic; regions ordered by size, largest first (ties: lowest first cell). Stopped: no regions.
[[nodiscard]] PoolVector<Region> segment(const RangeImage& image, const SegmentationOptions& options,
                                         const Stop& stop = {});

// 0 = no region, i + 1 = regions[i]. Size: image cells.
[[nodiscard]] PoolVector<int> label_image(const PoolVector<Region>& regions, int cells);

}  // namespace foresight
