#include "benchmarks/scene_picture.h"

namespace foresight {
namespace {

constexpr int kWideLine = 3;  // Unit: pixels.

Picture enlarge(const Picture& small, int pixels) {
  Picture large{small.rows * pixels, small.columns * pixels, {}};
  large.rgb.resize(small.rgb.size() * static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels));
  for (int row = 0; row < large.rows; ++row) {
    for (int column = 0; column < large.columns; ++column) {
      const auto from = 3 * (static_cast<std::size_t>(row / pixels) * static_cast<std::size_t>(small.columns) +
                             static_cast<std::size_t>(column / pixels));
      large.paint(row, column, {small.rgb[from], small.rgb[from + 1], small.rgb[from + 2]});
    }
  }
  return large;
}

// The camera of the enlarged picture: the centre of a cell becomes the centre of its block of pixels.
PinholeCamera enlarge(const PinholeCamera& camera, int pixels) {
  const auto centre = [&](double cell) { return (cell + 0.5) * pixels - 0.5; };
  return {camera.rows * pixels, camera.columns * pixels, camera.fx * pixels,
          camera.fy * pixels,   centre(camera.cx),       centre(camera.cy)};
}

}  // namespace

Picture draw_scene(const RangeImage& image, const PinholeCamera& camera, std::span<const CadModel> models,
                   std::span<const TrueObject> truth, std::span<const ReportedObject> reported, int pixels) {
  Picture picture = enlarge(shade(image), pixels);
  const PinholeCamera large = enlarge(camera, pixels);
  const auto draw = [&](int object, const Pose& pose, const LineStyle& style) {
    const CadModel& model = models[static_cast<std::size_t>(object)];
    draw_edges(picture, large, model_edges(model.vertices, model.triangles), pose, style);
  };
  for (const ReportedObject& report : reported) {
    if (report.object >= 0)
      draw(report.object, report.T_sensor_model, {object_colour(report.object), kWideLine, false});
  }
  for (const TrueObject& object : truth) draw(object.object, object.poses.front(), {{255, 255, 255}, 1, false});
  return picture;
}

}  // namespace foresight
