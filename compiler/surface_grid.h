// The surface of a CAD model in cubes: how far is it from a point?
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "compiler/cad_model.h"

namespace foresight {

class SurfaceGrid {
 public:
  // Answers up to the reach. Unit: mm. REQUIRES: reach > 0.
  SurfaceGrid(const CadModel& model, double reach);

  // From the point to the nearest part of the surface whose outward normal has at least this cosine with the given one;
  // infinity where there is none within the reach. Unit: mm.
  [[nodiscard]] double distance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double least_cosine) const;

 private:
  struct Facet {
    std::array<Eigen::Vector3d, 3> corners;
    Eigen::Vector3d normal;  // of its face
    Eigen::Vector3d across;  // of the triangle itself, zero where it has no area
  };
  void enter(int facet);
  [[nodiscard]] Eigen::Array3i cube_of(const Eigen::Vector3d& point) const;
  [[nodiscard]] std::size_t index(int x, int y, int z) const;

  std::vector<Facet> facets_;
  double reach_;
  double side_ = 0.0;                                 // of a cube. Unit: mm.
  Eigen::Vector3d lowest_ = Eigen::Vector3d::Zero();  // corner of the first cube
  Eigen::Array3i counts_ = Eigen::Array3i::Zero();
  std::vector<std::vector<int>> cubes_;  // facets within the reach of some point of the cube, ascending
};

}  // namespace foresight
