// What the sensor would see of an object alone: its CAD surface drawn at a pose.
#pragma once

#include <Eigen/Core>

#include "common/camera.h"
#include "common/compiled_model.h"
#include "common/memory_pool.h"
#include "common/pose.h"

namespace foresight {

// A window of the image grid, and of the grid continued beyond the image. A cell that shows nothing has depth 0.
struct Rendering {
  int first_row = 0;  // of the window, in the image; negative above it
  int first_column = 0;
  int rows = 0;
  int columns = 0;
  PoolVector<float> depth;             // z of the nearest surface, row by row. Unit: mm.
  PoolVector<int> triangle;            // of the model, -1 where nothing is shown
  PoolVector<Eigen::Vector3f> normal;  // by triangle, sensor frame, outward
  PoolVector<float> height;            // by triangle: of the camera over its plane; > 0 where it is drawn. Unit: mm.

  [[nodiscard]] int cell(int row, int column) const { return row * columns + column; }
};

// Draws the triangles that face the camera, the nearest one in each cell: a depth buffer. Exact at the cells' centres,
// where the sensor's rays pass. Empty when any vertex lies behind the camera or all of it outside what is drawn.
// beyond: so many cells are drawn on each side of the image, too, where the object reaches there. Limit: >= 0.
[[nodiscard]] Rendering render(const CompiledModel& model, const Pose& T_sensor_model, const PinholeCamera& camera,
                               int beyond = 0);

// Of the cells that either shows, the share that show the same: both depths are there and differ by no more than this.
// distance: Unit: mm. reach: how far aside in the image the same depth may be, for sensors that match windows of cells.
[[nodiscard]] double same_share(const Rendering& a, const Rendering& b, double distance, int reach = 0);

}  // namespace foresight
