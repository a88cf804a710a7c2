#include "common/segmentation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "common/errors.h"
#include "common/region_attributes.h"
#include "tests/images.h"

namespace foresight {
namespace {

using test::box_sides;
using test::facing;
using test::Rectangle;
using test::render;

SensorModel quiet_sensor() { return {}; }

SensorModel noisy_sensor() {
  SensorModel sensor;
  sensor.depth_noise = 0.5;
  return sensor;
}

std::vector<Rectangle> box_at(const Eigen::Vector3d& size, const Eigen::Matrix3d& rotation,
                              const Eigen::Vector3d& position) {
  std::vector<Rectangle> sides;
  for (const Rectangle& side : box_sides(size)) sides.push_back(moved(side, Pose{rotation, position}));
  return sides;
}

// A corner view: three sides well visible.
Eigen::Matrix3d corner_view() { return rotation_from_vector({0.6, 0, 0}) * rotation_from_vector({0, 0.75, 0}); }

TEST(Segmentation, one_plane_is_one_region_of_all_its_cells) {
  const SensorModel sensor = quiet_sensor();
  const RangeImage image = render({facing({0, 0, 900}, 120, 80)}, sensor.camera);
  const auto regions = segment(image, segmentation_options_for(sensor));
  ASSERT_EQ(regions.size(), 1U);
  EXPECT_EQ(static_cast<int>(regions[0].cells.size()), count_valid(image));
  EXPECT_NEAR(regions[0].normal.z(), -1.0, 1e-6);
  EXPECT_NEAR(regions[0].offset, -900.0, 0.01);
}

class SegmentationOfABox : public ::testing::TestWithParam<double> {};

TEST_P(SegmentationOfABox, finds_its_three_visible_sides_and_nothing_else) {
  SensorModel sensor;
  sensor.depth_noise = GetParam();
  const auto sides = box_at({100, 70, 50}, corner_view(), {10, -5, 900});
  const RangeImage image = render(sides, sensor.camera, sensor.depth_noise);
  const auto regions = segment(image, segmentation_options_for(sensor));
  ASSERT_EQ(regions.size(), 3U);
  std::size_t covered = 0;
  for (const Region& region : regions) {
    covered += region.cells.size();
    double best = 0;
    for (const Rectangle& side : sides)
      best = std::max(best, std::abs(side.a.cross(side.b).normalized().dot(region.normal)));
    EXPECT_GT(best, std::cos(0.02));
  }
  EXPECT_GT(static_cast<double>(covered), 0.97 * count_valid(image));
}
INSTANTIATE_TEST_SUITE_P(Noise, SegmentationOfABox, ::testing::Values(0.0, 0.2, 0.5, 1.0));

TEST(Segmentation, regions_are_disjoint_and_ordered_by_size) {
  const SensorModel sensor = noisy_sensor();
  const auto regions = segment(render(box_at({100, 70, 50}, corner_view(), {0, 0, 900}), sensor.camera, 0.5),
                               segmentation_options_for(sensor));
  std::set<int> seen;
  std::size_t total = 0;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    EXPECT_TRUE(std::is_sorted(regions[i].cells.begin(), regions[i].cells.end()));
    seen.insert(regions[i].cells.begin(), regions[i].cells.end());
    total += regions[i].cells.size();
    if (i > 0) {
      EXPECT_GE(regions[i - 1].cells.size(), regions[i].cells.size());
    }
  }
  EXPECT_EQ(seen.size(), total);
}

TEST(Segmentation, normals_face_the_sensor_and_offsets_are_negative) {
  const SensorModel sensor = noisy_sensor();
  for (const Region& region : segment(render(box_at({90, 60, 60}, corner_view(), {0, 0, 880}), sensor.camera, 0.5),
                                      segmentation_options_for(sensor))) {
    EXPECT_NEAR(region.normal.norm(), 1.0, 1e-9);
    EXPECT_LT(region.offset, 0.0);
    EXPECT_LE(region.rms,
              segmentation_options_for(sensor).merge_tolerance * segmentation_options_for(sensor).plane_sigma * 2);
  }
}

TEST(Segmentation, a_step_of_many_sigma_parts_two_parallel_planes) {
  const SensorModel sensor = quiet_sensor();
  const RangeImage image = render({facing({-30, 0, 900}, 60, 80), facing({30, 0, 895}, 60, 80)}, sensor.camera);
  EXPECT_EQ(segment(image, segmentation_options_for(sensor)).size(), 2U);
}

TEST(Segmentation, a_narrow_strip_between_wide_planes_is_found) {
  const SensorModel sensor = quiet_sensor();
  // A 6 mm bevel at 45 degrees between two planes: 4 to 5 cells wide.
  const std::vector<Rectangle> roof = {{{-60, -40, 900}, {60, 0, 0}, {0, 80, 0}},
                                       {{0, -40, 900}, {6, 0, 6}, {0, 80, 0}},
                                       {{6, -40, 906}, {0.001, 0, 60}, {0, 80, 0}},
                                       {{6, -40, 906}, {60, 0, 0}, {0, 80, 0}}};
  EXPECT_EQ(segment(render(roof, sensor.camera), segmentation_options_for(sensor)).size(), 3U);
}

TEST(Segmentation, an_occluder_splits_a_plane_into_two_regions) {
  const SensorModel sensor = quiet_sensor();
  const RangeImage image = render({facing({0, 0, 900}, 160, 60), facing({0, 0, 800}, 20, 120)}, sensor.camera);
  EXPECT_EQ(segment(image, segmentation_options_for(sensor)).size(), 3U);
}

TEST(Segmentation, parts_of_a_face_behind_a_bar_lie_on_one_plane) {
  for (const SensorModel& sensor : {quiet_sensor(), noisy_sensor()}) {
    const RangeImage image =
        render({facing({0, 0, 900}, 160, 60), facing({0, 0, 800}, 20, 120)}, sensor.camera, sensor.depth_noise);
    const auto regions = segment(image, segmentation_options_for(sensor));
    ASSERT_EQ(regions.size(), 3U);
    int behind = 0;
    for (const Region& region : regions) {
      if (std::abs(region.offset + 900.0) > 20.0) continue;
      ++behind;
      EXPECT_NEAR(region.offset, -900.0, 1.0);
      EXPECT_GT(-region.normal.z(), std::cos(0.01));
    }
    EXPECT_EQ(behind, 2);
  }
}

class SegmentationOfAPlane : public ::testing::TestWithParam<double> {};

TEST_P(SegmentationOfAPlane, finds_it_whole) {
  SensorModel sensor;
  sensor.depth_noise = GetParam();
  const Rectangle slanted =
      moved(facing({0, 0, 0}, 150, 110), Pose{rotation_from_vector({0.3, -0.5, 0.2}), {5, 0, 900}});
  const RangeImage image = render({slanted}, sensor.camera, sensor.depth_noise);
  const auto regions = segment(image, segmentation_options_for(sensor));
  ASSERT_EQ(regions.size(), 1U);
  EXPECT_GT(static_cast<double>(regions[0].cells.size()), 0.99 * count_valid(image));
  EXPECT_GT(std::abs(slanted.a.cross(slanted.b).normalized().dot(regions[0].normal)), std::cos(0.002));
}
INSTANTIATE_TEST_SUITE_P(Noise, SegmentationOfAPlane, ::testing::Values(0.0, 0.2, 0.5, 1.0, 2.0));

TEST(Segmentation, a_face_two_cells_wide_is_found) {
  const SensorModel sensor = quiet_sensor();
  const double cell = sensor.cell_size();
  for (const double shift : {0.0, 0.3, 0.6}) {  // of the grid against the face, in cells
    const double left = shift * cell;
    // The top of a rib that stands out of a wall.
    const std::vector<Rectangle> rib = {facing({0, 0, 900}, 120, 80), facing({left, 0, 890}, 2.2 * cell, 80)};
    const auto regions = segment(render(rib, sensor.camera), segmentation_options_for(sensor));
    ASSERT_EQ(regions.size(), 3U) << "shift " << shift;
    EXPECT_GT(-regions[2].normal.z(), std::cos(0.02));
    EXPECT_GE(regions[2].cells.size(), 100U);
  }
}

// Two planes that meet at the image's middle column, each turned away by an angle; a convex edge for a positive one.
std::vector<Rectangle> dihedral(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{{0, -60, 900}, {70 * c, 0, 70 * s}, {0, 120, 0}}, {{0, -60, 900}, {-70 * c, 0, 70 * s}, {0, 120, 0}}};
}

class SegmentationOfADihedral : public ::testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(SegmentationOfADihedral, borders_lie_within_a_cell_of_the_crease) {
  const auto [angle, noise] = GetParam();
  SensorModel sensor;
  sensor.depth_noise = noise;
  const RangeImage image = render(dihedral(angle), sensor.camera, noise);
  const auto regions = segment(image, segmentation_options_for(sensor));
  ASSERT_EQ(regions.size(), 2U);
  const double crease = sensor.camera.cx;
  for (const Region& region : regions) {
    const bool left = region.cells.front() % image.columns < crease;
    for (const int cell : region.cells) {
      const double beyond = left ? cell % image.columns - crease : crease - cell % image.columns;
      EXPECT_LE(beyond, 1.0) << "row " << cell / image.columns;
    }
    EXPECT_GT(static_cast<double>(region.cells.size()), 0.48 * count_valid(image));
  }
}
INSTANTIATE_TEST_SUITE_P(AngleAndNoise, SegmentationOfADihedral,
                         ::testing::Combine(::testing::Values(0.3, 0.6, -0.3, -0.6), ::testing::Values(0.0, 0.2, 0.5)));

TEST(Segmentation, a_face_does_not_run_on_where_its_plane_crosses_another) {
  // A wall on a floor: the wall's plane crosses the floor beyond the wall's ends too.
  SensorModel sensor = noisy_sensor();
  const double tilt = 0.7;
  const Eigen::Vector3d down_the_floor(0, std::cos(tilt), -std::sin(tilt));
  const Eigen::Vector3d up_the_wall(0, -std::sin(tilt), -std::cos(tilt));
  const Eigen::Vector3d origin(0, 0, 900);
  const std::vector<Rectangle> scene = {
      {origin - 120 * down_the_floor - Eigen::Vector3d(120, 0, 0), {240, 0, 0}, 240 * down_the_floor},
      {origin - Eigen::Vector3d(30, 0, 0), {60, 0, 0}, 50 * up_the_wall}};
  const RangeImage image = render(scene, sensor.camera, sensor.depth_noise);
  const auto regions = segment(image, segmentation_options_for(sensor));
  ASSERT_EQ(regions.size(), 2U);
  for (const int cell : regions[1].cells) EXPECT_LT(std::abs(image[cell].x()), 30.0 + 1.5 * sensor.cell_size());
}

TEST(Segmentation, every_cell_lies_within_tolerance_of_its_plane) {
  const SensorModel sensor = noisy_sensor();
  const SegmentationOptions options = segmentation_options_for(sensor);
  RangeImage image = render(box_at({100, 70, 50}, corner_view(), {0, 0, 900}), sensor.camera, 0.5);
  Random random(11);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (random.uniform() < 0.01) image[cell] *= 1.0F + 0.02F * static_cast<float>(random.gaussian());
  }
  const auto regions = segment(image, options);
  EXPECT_EQ(regions.size(), 3U);
  for (const Region& region : regions) {
    for (const int cell : region.cells) {
      EXPECT_LE(std::abs(region.normal.dot(image[cell].cast<double>()) - region.offset),
                options.grow_tolerance * options.plane_sigma);
    }
  }
}

TEST(Segmentation, nothing_is_found_in_pure_noise) {
  for (const SensorModel& sensor : {quiet_sensor(), noisy_sensor()}) {
    RangeImage image(240, 256);
    Random random(5);
    for (int cell = 0; cell < image.size(); ++cell) {
      const Eigen::Vector3d ray = sensor.camera.ray(cell / 256, cell % 256);
      image[cell] = (random.uniform(800, 1000) * ray).cast<float>();
    }
    EXPECT_TRUE(segment(image, segmentation_options_for(sensor)).empty());
  }
}

TEST(Segmentation, a_single_row_of_cells_is_no_region) {
  const SensorModel sensor = quiet_sensor();
  RangeImage image = render({facing({0, 0, 900}, 150, 150)}, sensor.camera);
  for (int cell = 0; cell < image.size(); ++cell) {
    if (cell / image.columns != 100) image[cell].setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  EXPECT_TRUE(segment(image, segmentation_options_for(sensor)).empty());
}

TEST(Segmentation, holes_in_the_data_do_no_harm) {
  const SensorModel sensor = quiet_sensor();
  RangeImage image = render({facing({0, 0, 900}, 150, 150)}, sensor.camera);
  Random random(3);
  int removed = 0;
  for (int cell = 0; cell < image.size(); ++cell) {
    if (image.valid(cell) && random.uniform() < 0.02) {
      image[cell].setConstant(std::numeric_limits<float>::quiet_NaN());
      ++removed;
    }
  }
  ASSERT_GT(removed, 100);
  const auto regions = segment(image, segmentation_options_for(sensor));
  ASSERT_EQ(regions.size(), 1U);
  EXPECT_GT(static_cast<double>(regions[0].cells.size()), 0.99 * count_valid(image));
}

TEST(Segmentation, an_empty_image_has_no_regions) {
  EXPECT_TRUE(segment(RangeImage(64, 64), {}).empty());
  RangeImage dot(64, 64);
  dot[100] = {0, 0, 900};
  EXPECT_TRUE(segment(dot, {}).empty());
}

TEST(Segmentation, same_image_same_regions) {
  const SensorModel sensor = noisy_sensor();
  const RangeImage image = render(box_at({100, 70, 50}, corner_view(), {0, 0, 900}), sensor.camera, 0.5);
  const auto options = segmentation_options_for(sensor);
  EXPECT_EQ(label_image(segment(image, options), image.size()), label_image(segment(image, options), image.size()));
}

TEST(Segmentation, settings_follow_the_sensor) {
  const auto quiet = segmentation_options_for(quiet_sensor());
  const auto noisy = segmentation_options_for(noisy_sensor());
  EXPECT_NO_THROW(check(quiet));
  EXPECT_NO_THROW(check(noisy));
  EXPECT_GT(noisy.plane_sigma, quiet.plane_sigma);
  EXPECT_GT(noisy.seed_block, quiet.seed_block);
}

TEST(Segmentation, options_outside_their_limits_are_refused) {
  const auto refused = [](auto change) {
    SegmentationOptions options;
    change(options);
    EXPECT_THROW(check(options), UsageError);
  };
  refused([](auto& o) { o.plane_sigma = 0; });
  refused([](auto& o) { o.merge_tolerance = 1; });
  refused([](auto& o) { o.grow_tolerance = std::nan(""); });
  refused([](auto& o) { o.seed_block = 1; });
  refused([](auto& o) { o.smallest_region = 2; });
  refused([](auto& o) { o.largest_depth_step = 0; });
}

// Whenever it is stopped, it is soon over and without regions; asked and not stopped, it finds what it always does.
TEST(Segmentation, can_be_stopped_between_its_steps) {
  const RangeImage image = render(box_at({120, 90, 70}, corner_view(), {0, 0, 900}), PinholeCamera{});
  const SegmentationOptions options = segmentation_options_for(quiet_sensor());
  int asked = 0;
  const auto whole = segment(image, options, [&asked] { return ++asked < 0; });
  EXPECT_EQ(whole.size(), segment(image, options).size());
  EXPECT_GT(whole.size(), 2U);
  EXPECT_GT(asked, 10);
  for (int last = 1; last <= asked; ++last) {
    int times = 0;
    EXPECT_TRUE(segment(image, options, [&times, last] { return ++times >= last; }).empty()) << last;
    EXPECT_GE(times, last);
    EXPECT_LE(times, last + 2);  // asked again behind steps that have stopped within
  }
  EXPECT_TRUE(extract_regions(image, PinholeCamera{}, options, [] { return true; }).empty());
}

}  // namespace
}  // namespace foresight
