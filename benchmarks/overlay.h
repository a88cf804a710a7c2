// Pictures for eyes: a shaded range image with the edges of posed CAD models drawn over it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "common/camera.h"
#include "common/pose.h"
#include "common/range_image.h"

namespace foresight {

using Colour = std::array<unsigned char, 3>;

// 8-bit RGB, row by row.
struct Picture {
  int rows = 0;
  int columns = 0;
  std::vector<unsigned char> rgb;

  void paint(int row, int column, const Colour& colour);  // nothing outside the picture
};

// Grey by how squarely the surface faces the sensor, and a little by depth; dark blue where there is no data.
[[nodiscard]] Picture shade(const RangeImage& image);

// An edge of a solid between two planar faces.
struct ModelEdge {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  // model frame. Unit: mm.
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 2> normals;  // outward, of the two faces
};

// Edges of a closed triangle mesh whose two triangles turn by more than the angle (radians).
[[nodiscard]] std::vector<ModelEdge> model_edges(std::span<const Eigen::Vector3d> vertices,
                                                 std::span<const std::array<int, 3>> triangles, double angle = 0.0087);

struct LineStyle {
  Colour colour{255, 255, 255};
  int width = 1;          // Unit: cells. Limit: >= 1.
  bool far_side = false;  // whether edges between two faces that look away from the sensor are drawn too
};

// Draws the edges of a posed model. Edges hidden by another part or object are drawn nevertheless: one sees where the
// model is.
void draw_edges(Picture& picture, const PinholeCamera& camera, std::span<const ModelEdge> edges,
                const Pose& T_sensor_model, const LineStyle& style);

// A colour per object that can be told from its neighbours in the list and from white.
[[nodiscard]] Colour object_colour(int index);

void write_picture(const std::string& file, const Picture& picture);

}  // namespace foresight
