// The unit sphere of viewing directions, divided by subdividing an icosahedron: 20 * 4^k triangular cells.
// 320 = 20 * 16 sample views (Section III) and 80 = 20 * 4 aspects (Section V.A) are two levels of one geodesic
// division.
#pragma once

#include <Eigen/Core>
#include <array>

#include "common/memory_pool.h"

namespace foresight {

class ViewingSphere {
 public:
  // cells: 20 * 4^k. Throws UsageError for any other number or for more than 20480.
  explicit ViewingSphere(int cells);

  [[nodiscard]] int size() const { return static_cast<int>(centres_.size()); }
  // Unit vector from the object towards the sensor. Cells 4*i .. 4*i+3 of a level lie in cell i of the coarser level.
  [[nodiscard]] const Eigen::Vector3d& centre(int cell) const { return centres_[static_cast<std::size_t>(cell)]; }
  // The cell a direction falls into; directions on an edge belong to the lower index. REQUIRES: direction != 0.
  [[nodiscard]] int cell_of(const Eigen::Vector3d& direction) const;

 private:
  using Sides = std::array<Eigen::Vector3d, 3>;  // of a triangle: planes through the origin, normals inward
  PoolVector<PoolVector<Sides>> levels_;         // levels_[0]: the 20 triangles of the icosahedron
  PoolVector<Eigen::Vector3d> centres_;
};

}  // namespace foresight
