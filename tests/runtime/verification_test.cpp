#include "runtime/verification.h"

#include <gtest/gtest.h>

#include <vector>

#include "runtime/localization.h"
#include "runtime/nearest_data_point.h"
#include "tests/runtime/box_scene.h"

namespace foresight {
namespace {

using test::box_image;
using test::box_model;
using test::box_pose;
using test::moved;
using test::Screen;

const ViewingSphere& sphere() {
  static const ViewingSphere s(kAspectCells);
  return s;
}

Verification verify_box(const RangeImage& image, const Pose& pose, const CompiledModel& model = box_model(),
                        const VerificationOptions& options = {}) {
  return verify(model, sphere(), pose, image, PinholeCamera{}, NearestDataPoint(image), options);
}

Pose shifted(double x, double y, double z) { return moved(box_pose(), {x, y, z}, Eigen::Vector3d::Zero()); }

TEST(Verification, is_complete_at_the_true_pose) {
  const Verification found = verify_box(box_image(box_pose(), PinholeCamera{}), box_pose());
  EXPECT_EQ(found.visible, static_cast<int>(visible_points(box_model(), sphere(), box_pose()).size()));
  EXPECT_GT(found.visible, 200);
  EXPECT_EQ(found.matched, 1.0);
  EXPECT_EQ(found.coherent, 1.0);
  EXPECT_EQ(found.occluding, 0.0);
  EXPECT_TRUE(found.accepted);
}

TEST(Verification, accepts_the_true_pose_before_a_wall) {
  // Points on the outline may fall into cells of the wall: some occlude, too few to matter.
  const Verification found = verify_box(box_image(box_pose(), PinholeCamera{}, {Screen{1100.0}}), box_pose());
  EXPECT_EQ(found.matched, 1.0);
  EXPECT_LT(found.occluding, 0.1);
  EXPECT_TRUE(found.accepted);
}

TEST(Verification, finds_more_occlusion_the_nearer_to_the_camera) {
  const RangeImage image = box_image(box_pose(), PinholeCamera{}, {Screen{1100.0}});
  EXPECT_GT(verify_box(image, shifted(0.0, 0.0, -6.0)).occluding, 0.5);
  EXPECT_GT(verify_box(image, shifted(0.0, 0.0, -100.0)).occluding, 0.95);
  EXPECT_FALSE(verify_box(image, shifted(0.0, 0.0, -100.0)).accepted);
}

TEST(Verification, finds_no_occlusion_behind_the_data) {
  const RangeImage image = box_image(box_pose(), PinholeCamera{});
  const Verification found = verify_box(image, shifted(0.0, 0.0, 50.0));
  EXPECT_EQ(found.occluding, 0.0);
  EXPECT_LT(found.matched, 0.5);
  EXPECT_FALSE(found.accepted);
}

TEST(Verification, lets_what_is_hidden_by_a_screen_be_unmatched_but_not_occluding) {
  const RangeImage image = box_image(box_pose(), PinholeCamera{}, {Screen{700.0, 0, 127}});
  const Verification found = verify_box(image, box_pose());
  EXPECT_GT(found.matched, 0.3);
  EXPECT_LT(found.matched, 0.8);
  EXPECT_EQ(found.occluding, 0.0);
  // Printed beta follows alpha where matches are local: only the rim between them lowers it.
  EXPECT_NEAR(found.coherent, found.matched, 0.1);
}

TEST(Verification, ignores_cells_without_data_and_points_beyond_the_image) {
  const RangeImage image = box_image(box_pose(), PinholeCamera{});
  for (const Pose& pose : {shifted(100.0, 0.0, 0.0), shifted(500.0, 0.0, 0.0), shifted(0.0, 0.0, -2000.0)}) {
    const Verification found = verify_box(image, pose);
    EXPECT_EQ(found.occluding, 0.0);
    EXPECT_EQ(found.matched, 0.0);
    EXPECT_EQ(found.coherent, 0.0);
    EXPECT_FALSE(found.accepted);
  }
}

TEST(Verification, counts_pairs_of_neighbours_for_the_coherent_fraction) {
  // A row of five points on one face; data near the first two only.
  CompiledModel model;
  model.centre = Eigen::Vector3d(0.0, 0.0, 20.0);
  for (std::vector<int>& aspect : model.surface.aspects) aspect = {0};
  for (int i = 0; i < 5; ++i) {
    TemplatePoint point;
    point.position = Eigen::Vector3f(10.0F * static_cast<float>(i), 0.0F, 0.0F);
    point.faces = {i < 4 ? 0 : 1};  // the last one is never visible
    if (i > 0) point.neighbours.push_back(i - 1);
    if (i < 4) point.neighbours.push_back(i + 1);
    model.surface.points.push_back(point);
  }
  RangeImage image(240, 256);
  image[0] = Eigen::Vector3f(0.0F, 0.0F, 500.0F);
  image[1] = Eigen::Vector3f(10.0F, 0.0F, 503.9F);
  const Pose pose{Eigen::Matrix3d::Identity(), {0.0, 0.0, 500.0}};
  const Verification found = verify_box(image, pose, model);
  EXPECT_EQ(found.visible, 4);
  EXPECT_DOUBLE_EQ(found.matched, 2.0 / 4.0);
  // Visible neighbours: {1}, {0, 2}, {1, 3}, {2}; matched among them: {1}, {0}, {1}, {}.
  EXPECT_DOUBLE_EQ(found.coherent, 3.0 / 6.0);
}

TEST(Verification, accepts_at_its_thresholds_and_not_beyond) {
  const RangeImage image = box_image(box_pose(), PinholeCamera{}, {Screen{1100.0}});
  const Pose pose = shifted(8.0, 0.0, -3.0);
  const Verification found = verify_box(image, pose);
  ASSERT_GT(found.occluding, 0.0);
  ASSERT_LT(found.matched, 1.0);
  VerificationOptions options;
  options.smallest_matched = found.matched;
  options.smallest_coherent = found.coherent;
  options.largest_occluding = found.occluding;
  EXPECT_TRUE(verify_box(image, pose, box_model(), options).accepted);
  VerificationOptions stricter = options;
  stricter.smallest_matched += 1e-9;
  EXPECT_FALSE(verify_box(image, pose, box_model(), stricter).accepted);
  stricter = options;
  stricter.smallest_coherent += 1e-9;
  EXPECT_FALSE(verify_box(image, pose, box_model(), stricter).accepted);
  stricter = options;
  stricter.largest_occluding -= 1e-9;
  EXPECT_FALSE(verify_box(image, pose, box_model(), stricter).accepted);
}

TEST(Verification, accepts_nothing_when_nothing_is_visible) {
  CompiledModel model = box_model();
  for (std::vector<int>& aspect : model.surface.aspects) aspect.clear();
  VerificationOptions lenient;
  lenient.smallest_matched = 0.0;
  lenient.smallest_coherent = 0.0;
  lenient.largest_occluding = 1.0;
  const Verification found = verify_box(box_image(box_pose(), PinholeCamera{}), box_pose(), model, lenient);
  EXPECT_EQ(found.visible, 0);
  EXPECT_FALSE(found.accepted);
}

TEST(Verification, accepts_a_rough_pose_only_after_refinement) {
  const RangeImage image = box_image(box_pose(), PinholeCamera{}, {Screen{1100.0}});
  const Pose start = moved(box_pose(), {6.0, -5.0, -8.0}, {0.1, -0.1, 0.1});
  const Pose refined = localize(box_model(), sphere(), start, NearestDataPoint(image), {}).T_sensor_model;
  EXPECT_FALSE(verify_box(image, start).accepted);
  EXPECT_TRUE(verify_box(image, refined).accepted);
}

}  // namespace
}  // namespace foresight
