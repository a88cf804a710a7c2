// A golden scan: a simulated scan of one object alone at a known pose, small enough to travel in the database. The
// compiler has recognized the object in it; whoever has the database can see whether he still does
// (runtime/selftest.h).
#pragma once

#include <string>

#include "common/camera.h"
#include "common/pose.h"
#include "common/range_image.h"
#include "common/sensor_model.h"

namespace foresight {

// Depths in whole steps, over the least window of the image that holds all data.
//
// depths: the cells of the window, row by row, as runs: how many cells without data, how many with data, and for each
// of these by how many steps its depth exceeds what its neighbours promise; then the next run, until the window is
// full. Promised is the plane through the cells before, above, and above that one (before + above - above that); where
// these have not all data, the line through the two cells before, else the cell before, else the one above, else the
// last cell with data, and 0 for the first. As exponential Golomb codes, bit by bit from each byte's highest; zeros
// fill the last byte. Counts of cells are of order 5; the first byte is the order of the differences, 0 to 15, which
// come in zigzag (0, -1, 1, -2, 2 ...).
struct GoldenScan {
  int first_row = 0;  // of the window, in the image
  int first_column = 0;
  int rows = 0;
  int columns = 0;
  double depth_step = 0.0;  // Unit: mm. Limit: > 0.
  std::string depths;
  Pose T_sensor_model;  // the true one
};

// The sensor's own depth step, so that its depths return bit for bit; a quarter of its noise where that is more, which
// adds 0.3 % to the noise; at least 2^-16 of its farthest distance, 1/64 mm at a metre. Unit: mm.
[[nodiscard]] double golden_depth_step(const SensorModel& sensor);

// Each depth is rounded to whole steps, one at least. REQUIRES: a valid cell; depths positive, up to a kilometre and a
// thousand million steps.
[[nodiscard]] GoldenScan encode_golden_scan(const RangeImage& image, double depth_step, const Pose& T_sensor_model);

// What is wrong with it as a scan of this camera, in words, or nullptr. Looks at all but the pose.
[[nodiscard]] const char* fault_of(const GoldenScan& scan, const PinholeCamera& camera);

// The scan, each point on the ray through its cell's centre. REQUIRES: fault_of(scan, camera) is nullptr.
[[nodiscard]] RangeImage decode_golden_scan(const GoldenScan& scan, const PinholeCamera& camera);

}  // namespace foresight
