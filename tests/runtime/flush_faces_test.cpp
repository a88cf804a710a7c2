#include "runtime/flush_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/runtime/learned_database.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

// A box with a corner in the origin; face 4 looks along -z, at the sensor.
CompiledModel box(double x, double y, double z) {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) != 0 ? x : 0.0, (i & 2) != 0 ? y : 0.0, (i & 4) != 0 ? z : 0.0);
  return test::convex_solid("box", corners,
                            {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}});
}
const CompiledModel& known_box() {
  static const CompiledModel model = box(70, 40, 30);
  return model;
}
const Database& database() {
  static const Database loaded = test::database_of({known_box()});
  return loaded;
}

std::vector<DescribedRegion> regions_of(const RangeImage& image) { return extract_regions(image, PinholeCamera{}, {}); }
std::vector<DescribedRegion> parted(const RangeImage& image) {
  return part_flush_faces(regions_of(image), image, PinholeCamera{}, database());
}

// Boxes whose tops face the sensor in one plane at 850 mm, before a wall.
RangeImage flush_boxes(const std::vector<Vector3d>& corners, const CompiledModel& model) {
  std::vector<test::PlacedModel> objects;
  for (const Vector3d& corner : corners) objects.push_back({&model, {Eigen::Matrix3d::Identity(), corner}});
  static const CompiledModel wall = box(2000, 2000, 10);
  objects.push_back({&wall, {Eigen::Matrix3d::Identity(), Vector3d(-1000, -1000, 900)}});
  return test::image_of(objects);
}

int regions_of_area(const std::vector<DescribedRegion>& regions, double area) {
  return static_cast<int>(std::count_if(regions.begin(), regions.end(), [&](const DescribedRegion& region) {
    return std::abs(region.attributes[kArea] - area) < 0.1 * area;
  }));
}

TEST(FlushFaces, of_touching_boxes_are_parted) {
  const std::vector<std::vector<Vector3d>> groups = {
      {{-70, -20, 850}, {0, -20, 850}},
      {{-35, -40, 850}, {-35, 0, 850}},
      {{-70, -40, 850}, {0, -40, 850}, {-70, 0, 850}, {0, 0, 850}},
      {{-70, -40, 850}, {0, -40, 850}, {-70, 0, 850}},
      {{-100, -20, 850}, {-30, -20, 850}, {40, -20, 850}},
  };
  for (const std::vector<Vector3d>& group : groups) {
    const RangeImage image = flush_boxes(group, known_box());
    const double top = 70.0 * 40.0;
    EXPECT_EQ(regions_of_area(regions_of(image), static_cast<double>(group.size()) * top), 1);
    EXPECT_EQ(regions_of_area(parted(image), top), static_cast<int>(group.size())) << group.size();
  }
}

TEST(FlushFaces, keep_every_cell_and_no_cell_twice) {
  const RangeImage image = flush_boxes({{-70, -20, 850}, {0, -20, 850}}, known_box());
  const auto cells_of = [](const std::vector<DescribedRegion>& regions) {
    std::multiset<int> cells;
    for (const DescribedRegion& region : regions) cells.insert(region.region.cells.begin(), region.region.cells.end());
    return cells;
  };
  const std::vector<DescribedRegion> parts = parted(image);
  EXPECT_EQ(cells_of(parts), cells_of(regions_of(image)));
  for (std::size_t r = 1; r < parts.size(); ++r)
    EXPECT_GE(parts[r - 1].region.cells.size(), parts[r].region.cells.size());
  for (const DescribedRegion& part : parts)
    EXPECT_TRUE(std::is_sorted(part.region.cells.begin(), part.region.cells.end()));
}

TEST(FlushFaces, what_fits_one_face_stays_whole) {
  const RangeImage image = flush_boxes({{-35, -20, 850}}, known_box());
  EXPECT_EQ(parted(image).size(), regions_of(image).size());
}

// Larger than the face, and of no whole number of them.
TEST(FlushFaces, other_solids_stay_whole) {
  for (const CompiledModel& other : {box(105, 40, 30), box(70, 60, 30), box(110, 110, 30)}) {
    const RangeImage image = flush_boxes({{-55, -30, 850}}, other);
    EXPECT_EQ(parted(image).size(), regions_of(image).size());
  }
}

TEST(FlushFaces, a_wall_that_reaches_beyond_the_image_stays_whole) {
  const RangeImage image = flush_boxes({}, known_box());
  EXPECT_EQ(parted(image).size(), 1U);
}

TEST(FlushFaces, of_solids_without_rectangles_there_are_none) {
  const CompiledModel prism = test::convex_solid("prism", {{0, 0, 0}, {50, 0, 0}, {0, 40, 0}, {0, 0, 30}},
                                                 {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  const RangeImage image = flush_boxes({{-70, -20, 850}, {0, -20, 850}}, known_box());
  const auto regions = regions_of(image);
  EXPECT_EQ(part_flush_faces(regions, image, PinholeCamera{}, test::database_of({prism})).size(), regions.size());
}

}  // namespace
}  // namespace foresight
