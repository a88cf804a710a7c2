#include "benchmarks/overlay.h"

#include <gtest/gtest.h>

#include "tests/benchmarks/solids.h"

namespace foresight {
namespace {

constexpr Colour kRed = {255, 0, 0};

Colour colour_at(const Picture& picture, int row, int column) {
  const auto first = 3 * static_cast<std::size_t>(row * picture.columns + column);
  return {picture.rgb[first], picture.rgb[first + 1], picture.rgb[first + 2]};
}

Picture black(const PinholeCamera& camera) {
  return {camera.rows, camera.columns,
          std::vector<unsigned char>(static_cast<std::size_t>(3 * camera.rows * camera.columns), 0)};
}

std::vector<ModelEdge> box_edges() {
  const CadModel model = test::cuboid(60, 60, 60);
  return model_edges(model.vertices, model.triangles);
}

TEST(ModelEdges, of_a_cube_are_twelve) { EXPECT_EQ(box_edges().size(), 12U); }

TEST(Overlay, draws_edges_where_the_camera_projects_them) {
  const PinholeCamera camera;
  Picture picture = black(camera);
  draw_edges(picture, camera, box_edges(), {Eigen::Matrix3d::Identity(), {0, 0, 900}}, {kRed, 1, false});
  const Eigen::Vector2d corner = camera.project({30, 30, 870});
  EXPECT_EQ(colour_at(picture, static_cast<int>(std::lround(corner.y())), static_cast<int>(std::lround(corner.x()))),
            kRed);
  EXPECT_EQ(colour_at(picture, camera.rows / 2, camera.columns / 2), (Colour{0, 0, 0}));
}

TEST(Overlay, draws_the_far_side_only_when_asked) {
  const PinholeCamera camera;
  const Pose pose{Eigen::Matrix3d::Identity(), {0, 0, 900}};
  const Eigen::Vector2d middle = camera.project({0, 30, 930});  // of a far edge, inside the near outline
  const auto drawn = [&](bool far_side) {
    Picture picture = black(camera);
    draw_edges(picture, camera, box_edges(), pose, {kRed, 1, far_side});
    return colour_at(picture, static_cast<int>(std::lround(middle.y())), static_cast<int>(std::lround(middle.x()))) ==
           kRed;
  };
  EXPECT_TRUE(drawn(true));
  EXPECT_FALSE(drawn(false));
}

TEST(Overlay, survives_models_beside_behind_and_around_the_sensor) {
  const PinholeCamera camera;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(5000, 0, 900), Eigen::Vector3d(0, 0, -900), Eigen::Vector3d(0, 0, 0)}) {
    Picture picture = black(camera);
    draw_edges(picture, camera, box_edges(), {Eigen::Matrix3d::Identity(), place}, {kRed, 3, true});
    EXPECT_EQ(picture.rgb.size(), static_cast<std::size_t>(3 * camera.rows * camera.columns));
  }
}

TEST(Overlay, shades_surfaces_grey_and_holes_otherwise) {
  RangeImage image(40, 50);
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 25; ++column) {
      image[image.cell(row, column)] = Eigen::Vector3f(static_cast<float>(column), static_cast<float>(row), 900.0F);
    }
  }
  const Picture picture = shade(image);
  const Colour surface = colour_at(picture, 20, 10);
  EXPECT_TRUE(surface[0] == surface[1] && surface[1] == surface[2]);
  EXPECT_NE(colour_at(picture, 20, 40), surface);
}

}  // namespace
}  // namespace foresight
