// What an eye sees of a CAD model, exactly: segments against triangles, in double precision.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "compiler/cad_model.h"

namespace foresight {

// A model seen from one point. Its triangles are sorted once into the cells of a picture plane before the eye,
// so that each question meets only the triangles that its line of sight can meet.
class EyeView {
 public:
  // REQUIRES: the eye is outside the sphere about the model's bounding box. The model must outlive the view.
  EyeView(const CadModel& model, const Eigen::Vector3d& eye);

  // The eye is on the outer side of the face's plane.
  [[nodiscard]] bool faces_eye(int face) const;

  // Nothing stands between a point of the model's surface and the eye. own_faces: the faces the point lies on,
  // ascending; a plane cannot hide its own points, and rounding must not let it. REQUIRES: one of them faces the eye.
  [[nodiscard]] bool sees(const Eigen::Vector3d& point, std::span<const int> own_faces) const;

 private:
  struct Occluder {
    Eigen::Vector3d corner, first_edge, second_edge;
    int face;
  };
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& point) const;
  [[nodiscard]] Eigen::Vector2i cell_of(const Eigen::Vector2d& place) const;
  void collect_occluders();
  void sort_into_cells();

  const CadModel& model_;
  Eigen::Vector3d eye_;
  Eigen::Vector3d right_, up_, forward_;
  Eigen::Vector2d lowest_, cell_size_;
  int side_ = 1;                     // the picture has side_ x side_ cells
  std::vector<Occluder> occluders_;  // triangles that face the eye
  std::vector<int> first_in_cell_;   // into in_cells_, one more than cells
  std::vector<int> in_cells_;        // occluders, cell after cell
};

}  // namespace foresight
