#include "runtime/explained_regions.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/runtime/box_scene.h"

namespace foresight {
namespace {

using test::box_image;
using test::box_pose;
using test::moved;
using test::Screen;

CompiledModel box_model() {
  CompiledModel model = test::box_model();
  for (int face = 0; face < 6; ++face) model.faces[static_cast<std::size_t>(face)].normal = test::box_normal(face);
  return model;
}

// A box with three sides in sight; a wall stands far behind it when asked for.
struct Scan {
  RangeImage image;
  PoolVector<DescribedRegion> regions;
  PoolVector<int> of_box;  // regions
  PoolVector<int> of_wall;

  explicit Scan(const std::vector<Screen>& screens = {}) : image(box_image(box_pose(), PinholeCamera{}, screens)) {
    regions = extract_regions(image, PinholeCamera{}, segmentation_options_for(SensorModel{}));
    for (std::size_t i = 0; i < regions.size(); ++i) {
      (regions[i].centroid.z() < 1000.0 ? of_box : of_wall).push_back(static_cast<int>(i));
    }
  }
  [[nodiscard]] PoolVector<int> explained_by(const Pose& pose, const ExplanationOptions& options = {}) const {
    return explained_regions(box_model(), pose, image, regions, options);
  }
};

TEST(ExplainedRegions, are_all_regions_of_the_object_at_the_true_pose) {
  const Scan scan;
  ASSERT_EQ(scan.of_box.size(), 3U);
  EXPECT_EQ(scan.explained_by(box_pose()), scan.of_box);
}

TEST(ExplainedRegions, are_none_of_a_wall_far_behind) {
  const Scan scan({Screen{1100.0}});
  ASSERT_EQ(scan.of_box.size(), 3U);
  ASSERT_FALSE(scan.of_wall.empty());
  EXPECT_EQ(scan.explained_by(box_pose()), scan.of_box);
}

TEST(ExplainedRegions, forgive_an_error_that_localization_leaves) {
  const Scan scan;
  EXPECT_EQ(scan.explained_by(moved(box_pose(), {1.0, -1.0, 1.0}, {0.01, 0.0, -0.01})), scan.of_box);
}

TEST(ExplainedRegions, are_few_at_a_wrong_pose) {
  const Scan scan({Screen{1100.0}});
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  EXPECT_TRUE(scan.explained_by(moved(box_pose(), {200.0, 0.0, 0.0}, none)).empty());
  EXPECT_TRUE(scan.explained_by(moved(box_pose(), {0.0, 0.0, -80.0}, none)).empty());
  EXPECT_LE(scan.explained_by(moved(box_pose(), {30.0, 0.0, 0.0}, none)).size(), 1U);
  EXPECT_LE(scan.explained_by(moved(box_pose(), none, {0.0, 0.0, std::numbers::pi / 2.0})).size(), 1U);
}

TEST(ExplainedRegions, need_a_normal_that_agrees_and_not_only_points_near_by) {
  Scan scan;
  for (DescribedRegion& region : scan.regions) region.region.normal = Eigen::Vector3d(0.0, 0.0, -1.0);
  ExplanationOptions strict;
  strict.normal_cosine = 0.99;
  EXPECT_TRUE(scan.explained_by(box_pose(), strict).empty());
  strict.normal_cosine = -1.0;
  EXPECT_EQ(scan.explained_by(box_pose(), strict), scan.of_box);
}

TEST(ExplainedRegions, need_the_share_asked_for) {
  // One region of the whole image: the box is a part of it, the wall the rest.
  Scan scan({Screen{1100.0}});
  DescribedRegion whole = scan.regions[static_cast<std::size_t>(scan.of_box.front())];
  whole.region.cells.clear();
  int of_box = 0;
  for (int cell = 0; cell < scan.image.size(); ++cell) {
    whole.region.cells.push_back(cell);
    of_box += scan.image[cell].z() < 1000.0F ? 1 : 0;
  }
  const double share = static_cast<double>(of_box) / scan.image.size();
  ASSERT_LT(share, 0.4);
  scan.regions = {whole};
  ExplanationOptions options;
  options.normal_cosine = -1.0;
  options.most_samples = scan.image.size();
  options.smallest_share = 0.9 * share;
  EXPECT_EQ(scan.explained_by(box_pose(), options).size(), 1U);
  options.smallest_share = 1.1 * share;
  EXPECT_TRUE(scan.explained_by(box_pose(), options).empty());
}

TEST(ExplainedRegions, hardly_depend_on_how_many_data_points_are_looked_at) {
  const Scan scan({Screen{1100.0}});
  for (const int samples : {12, 48, 1 << 20}) {
    ExplanationOptions options;
    options.most_samples = samples;
    EXPECT_EQ(scan.explained_by(box_pose(), options), scan.of_box) << samples;
  }
}

TEST(ExplainedRegions, do_not_depend_on_the_aspects) {
  const Scan scan;
  CompiledModel unseen = box_model();
  for (std::vector<int>& aspect : unseen.surface.aspects) aspect.clear();
  EXPECT_EQ(explained_regions(unseen, box_pose(), scan.image, scan.regions), scan.of_box);
}

TEST(ExplainedRegions, are_none_without_regions) {
  Scan scan;
  scan.regions.clear();
  EXPECT_TRUE(scan.explained_by(box_pose()).empty());
}

}  // namespace
}  // namespace foresight
