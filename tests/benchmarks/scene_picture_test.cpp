#include "benchmarks/scene_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/benchmarks/solids.h"

namespace foresight {
namespace {

const Pose kAhead{Eigen::Matrix3d::Identity(), {0, 0, 900}};

bool shows(const Picture& picture, const Colour& colour) {
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    if (Colour{picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]} == colour) return true;
  }
  return false;
}

TEST(ScenePicture, draws_reports_in_colour_and_the_truth_in_white) {
  const PinholeCamera camera;
  const RangeImage image(camera.rows, camera.columns);
  const std::vector<CadModel> models = {test::cuboid(60, 60, 60), test::cuboid(40, 40, 40)};
  const std::vector<TrueObject> truth = {{0, {kAhead}, 1.0}};
  const std::vector<ReportedObject> reported = {{1, kAhead}, {-1, kAhead}};
  const Picture both = draw_scene(image, camera, models, truth, reported);
  EXPECT_TRUE(shows(both, {255, 255, 255}));
  EXPECT_TRUE(shows(both, object_colour(1)));
  EXPECT_FALSE(shows(both, object_colour(0)));
  EXPECT_FALSE(shows(draw_scene(image, camera, models, {}, reported), {255, 255, 255}));
}

TEST(ScenePicture, enlarged_shows_edges_at_the_same_place) {
  const PinholeCamera camera;
  constexpr int kPixels = 4;
  const std::vector<CadModel> models = {test::cuboid(60, 60, 60)};
  const std::vector<TrueObject> truth = {{0, {kAhead}, 1.0}};
  const Picture picture = draw_scene(RangeImage(camera.rows, camera.columns), camera, models, truth, {}, kPixels);
  ASSERT_EQ(picture.rows, kPixels * camera.rows);
  ASSERT_EQ(picture.columns, kPixels * camera.columns);
  const Eigen::Vector2d corner = camera.project({30, 30, 870});
  const auto pixel = [](double cell) { return static_cast<std::size_t>(std::lround((cell + 0.5) * kPixels - 0.5)); };
  const std::size_t first = 3 * (pixel(corner.y()) * static_cast<std::size_t>(picture.columns) + pixel(corner.x()));
  EXPECT_EQ(picture.rgb[first], 255);
}

}  // namespace
}  // namespace foresight
