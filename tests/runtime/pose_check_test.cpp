#include "runtime/pose_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/runtime/learned_database.h"

namespace foresight {
namespace {

using Eigen::Vector3d;
using test::box_pose;
using test::kBoxCentre;
using test::SeenScan;

const Database& database() {
  static const Database loaded = test::database_of({test::box_model()});
  return loaded;
}
const CompiledModel& box() { return database().models()[0]; }

const SeenScan& box_scan() {
  static const SeenScan seen(test::box_image(box_pose(), PinholeCamera{}));
  return seen;
}

PoseCheck check_of(const LabelledScan& scan, const Pose& pose) { return PoseChecker(database(), scan).check(0, pose); }
PoseCheck check_of(const SeenScan& seen, const Pose& pose) { return check_of(seen.labelled(), pose); }

void expect_counts_add_up(const PoseCheck& check) {
  EXPECT_LE(check.explained + check.contradicted + check.hidden, check.total + 1e-9);
  EXPECT_LE(check.owned, check.explained + 1e-9);
  EXPECT_GE(check.owned, 0.0);
  double supported = 0.0;
  for (const FaceSupport& support : check.supports) supported += support.cells;
  EXPECT_LE(supported, check.explained + 1e-9);
  EXPECT_LE(check.quality(), 1.0);
}

TEST(PoseCheck, the_true_pose_looks_almost_perfect) {
  const PoseCheck check = check_of(box_scan(), box_pose());
  EXPECT_GT(check.quality(), 0.9);
  EXPECT_EQ(check.contradicted, 0.0);
  EXPECT_EQ(check.hidden, 0.0);
  EXPECT_GT(check.explained, 0.98 * check.total);
  expect_counts_add_up(check);
}

TEST(PoseCheck, estimates_how_many_cells_would_show_the_object) {
  int cells = 0;
  for (const DescribedRegion& region : box_scan().regions) cells += static_cast<int>(region.region.cells.size());
  EXPECT_NEAR(check_of(box_scan(), box_pose()).total, cells, 0.1 * cells);
  const SeenScan far(test::box_image(box_pose(1800), PinholeCamera{}));
  EXPECT_NEAR(check_of(far, box_pose(1800)).total, 0.25 * cells, 0.05 * cells);
}

TEST(PoseCheck, names_the_faces_that_regions_show) {
  const PoseCheck check = check_of(box_scan(), box_pose());
  ASSERT_EQ(box_scan().regions.size(), 3U);
  ASSERT_EQ(check.supports.size(), 3U);
  for (const FaceSupport& support : check.supports) {
    const Region& region = box_scan().regions[static_cast<std::size_t>(support.region)].region;
    EXPECT_GT(region.normal.dot(box_pose().rotation * test::box_normal(support.face)), 0.999);
    EXPECT_NEAR(support.cells, static_cast<double>(region.cells.size()),
                0.2 * static_cast<double>(region.cells.size()));
  }
}

TEST(PoseCheck, looks_worse_off_its_place) {
  const double best = check_of(box_scan(), box_pose()).quality();
  for (const Vector3d& direction : {Vector3d(1, 0, 0), Vector3d(0, -1, 0), Vector3d(0, 0, 1), Vector3d(0, 0, -1)}) {
    const auto moved_by = [&](double distance) {
      const PoseCheck check = check_of(box_scan(), test::moved(box_pose(), distance * direction, {0, 0, 0}));
      expect_counts_add_up(check);
      return check.quality();
    };
    EXPECT_LT(moved_by(5.0), best + 0.02) << direction.transpose();  // data agree still
    EXPECT_LT(moved_by(20.0), 0.6 * best) << direction.transpose();
    EXPECT_LT(moved_by(40.0), 0.1 * best) << direction.transpose();
  }
  for (int axis = 0; axis < 3; ++axis) {
    const PoseCheck check = check_of(box_scan(), test::moved(box_pose(), {0, 0, 0}, 0.7 * Vector3d::Unit(axis)));
    EXPECT_LT(check.quality(), 0.5 * best) << axis;
  }
}

TEST(PoseCheck, data_behind_contradict_and_data_in_front_hide) {
  const PoseCheck nearer = check_of(box_scan(), test::moved(box_pose(), {0, 0, -60}, {0, 0, 0}));
  EXPECT_GT(nearer.contradicted, 0.8 * nearer.total);
  EXPECT_EQ(nearer.hidden, 0.0);
  EXPECT_LT(nearer.quality(), -0.5);
  const PoseCheck farther = check_of(box_scan(), test::moved(box_pose(), {0, 0, 60}, {0, 0, 0}));
  EXPECT_GT(farther.hidden, 0.8 * farther.total);
  EXPECT_EQ(farther.contradicted, 0.0);
  EXPECT_NEAR(farther.quality(), 0.0, 0.05);
  expect_counts_add_up(nearer);
  expect_counts_add_up(farther);
}

TEST(PoseCheck, a_screen_hides_its_part) {
  const SeenScan half(test::box_image(box_pose(), PinholeCamera{}, {{700.0, 0, 127}}));
  const PoseCheck check = check_of(half, box_pose());
  EXPECT_NEAR(check.hidden, 0.5 * check.total, 0.12 * check.total);
  EXPECT_EQ(check.contradicted, 0.0);
  EXPECT_NEAR(check.quality(), 0.5, 0.12);
}

TEST(PoseCheck, data_agree_within_the_distance_across_the_surface) {
  const Vector3d normal =
      box_pose().rotation * test::box_normal(test::face_shown(box(), box_pose(), box_scan().regions[0]).value());
  for (const double distance : {3.0, 8.0}) {
    PoseCheckOptions options;
    options.distance = distance;
    const LabelledScan scan = box_scan().labelled();
    PoseChecker checker(database(), scan, options);
    const auto explained = [&](double off) {
      return checker.check(0, test::moved(box_pose(), off * normal, {0, 0, 0})).explained;
    };
    EXPECT_GT(explained(-0.8 * distance), explained(-1.3 * distance) + 300.0) << distance;
    EXPECT_GT(explained(0.8 * distance), explained(1.3 * distance) + 300.0) << distance;
  }
}

TEST(PoseCheck, a_region_that_is_taken_contradicts) {
  LabelledScan scan = box_scan().labelled();
  const PoseCheck free = check_of(scan, box_pose());
  double last = free.quality();
  for (std::size_t r = 0; r < scan.regions.size(); ++r) {
    for (const int cell : scan.regions[r].region.cells) take(scan, cell);
    const PoseCheck check = check_of(scan, box_pose());
    EXPECT_LT(check.quality(), last);
    EXPECT_EQ(check.supports.size(), 2 - r);
    last = check.quality();
  }
  EXPECT_LT(last, -0.9);
  // Hopeless by then, so that not all of it need be looked at.
  const PoseCheck taken = check_of(scan, box_pose());
  EXPECT_GE(taken.contradicted, 0.9 * taken.total);
}

TEST(PoseCheck, a_region_with_another_normal_contradicts) {
  // A wall through the box's middle, facing the camera: where it lies on the surface its normal is another.
  const SeenScan wall(test::image_of({}));
  EXPECT_EQ(check_of(wall, box_pose()).explained, 0.0);
  RangeImage image(240, 256);
  const PinholeCamera camera;
  for (int cell = 0; cell < image.size(); ++cell) {
    image[cell] = (885.0 * camera.ray(cell / image.columns, cell % image.columns)).cast<float>();
  }
  const SeenScan seen(image);
  ASSERT_EQ(seen.regions.size(), 1U);
  const PoseCheck check = check_of(seen, box_pose());
  EXPECT_EQ(check.explained, 0.0);
  EXPECT_GT(check.contradicted, 0.2 * check.total);
}

// A plane that runs on beyond the face it lies on is owned by the share of it that the face explains.
TEST(PoseCheck, regions_that_run_on_are_not_owned) {
  const Pose frontal{Eigen::Matrix3d::Identity(), Vector3d(0, 0, 900) - kBoxCentre};
  const double face_depth = 900.0 - test::box_half_size().z();
  const auto seen_with = [&](double growth) {
    const double width = 2.0 * growth * test::box_half_size().x();
    const double height = 2.0 * growth * test::box_half_size().y();
    RangeImage image(240, 256);
    const PinholeCamera camera;
    for (int cell = 0; cell < image.size(); ++cell) {
      const Vector3d point = face_depth * camera.ray(cell / image.columns, cell % image.columns);
      if (std::abs(point.x()) < 0.5 * width && std::abs(point.y()) < 0.5 * height) image[cell] = point.cast<float>();
    }
    return image;
  };
  for (const double growth : {1.0, 1.5, 2.0}) {
    const SeenScan seen(seen_with(growth));
    ASSERT_EQ(seen.regions.size(), 1U);
    const PoseCheck check = check_of(seen, frontal);
    EXPECT_NEAR(check.owned / check.explained, 1.0 / (growth * growth), 0.1) << growth;
  }
}

TEST(PoseCheck, is_nothing_where_nothing_can_be_seen) {
  for (const Vector3d& move : {Vector3d(3000, 0, 0), Vector3d(0, 0, -3000)}) {
    const PoseCheck check = check_of(box_scan(), test::moved(box_pose(), move, {0, 0, 0}));
    EXPECT_EQ(check.explained, 0.0);
    EXPECT_TRUE(check.supports.empty());
    EXPECT_LE(check.quality(), 0.0);
  }
  EXPECT_EQ(check_of(box_scan(), Pose{Eigen::Matrix3d::Identity(), -kBoxCentre}).total, 0.0);
}

TEST(PoseCheck, answers_the_same_whatever_was_asked_before) {
  Random random(5);
  const LabelledScan scan = box_scan().labelled();
  PoseChecker one(database(), scan);
  for (int i = 0; i < 50; ++i) {
    const Pose pose = test::moved(box_pose(), 15.0 * random.direction(), random.uniform(0.0, 3.0) * random.direction());
    const PoseCheck known = one.check(0, pose);
    const PoseCheck fresh = check_of(scan, pose);
    EXPECT_EQ(known.owned, fresh.owned);
    EXPECT_EQ(known.contradicted, fresh.contradicted);
    EXPECT_EQ(known.supports.size(), fresh.supports.size());
  }
}

double turn_between(const Pose& a, const Pose& b) { return rotation_angle(a.rotation.transpose() * b.rotation); }
double distance_between(const Pose& a, const Pose& b) { return (a * kBoxCentre - b * kBoxCentre).norm(); }

// Given up or not, a check answers the one question asked of it: whether the pose looks as well as that.
TEST(PoseCheck, gives_up_only_poses_that_look_worse_than_asked_for) {
  const LabelledScan scan = box_scan().labelled();
  PoseChecker checker(database(), scan);
  Random random(8);
  int given_up = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose pose = test::moved(box_pose(), random.uniform(0.0, 40.0) * random.direction(),
                                  random.uniform(0.0, 0.8) * random.direction());
    const PoseCheck whole = checker.check(0, pose);
    for (const double least : {0.2, 0.5, 0.8}) {
      const PoseCheck asked = checker.check(0, pose, least);
      if (asked.total == whole.total) {
        EXPECT_EQ(asked.quality(), whole.quality());
        continue;
      }
      ++given_up;
      EXPECT_LT(asked.total, whole.total);
      EXPECT_LT(whole.quality(), least);
      EXPECT_LT(asked.quality(), least);
    }
  }
  EXPECT_GT(given_up, 100);
}

TEST(RefitToPlanes, brings_a_pose_back_to_the_planes_it_touches) {
  Random random(6);
  const LabelledScan scan = box_scan().labelled();
  PoseChecker checker(database(), scan);
  for (int trial = 0; trial < 20; ++trial) {
    Pose pose = test::moved(box_pose(), 3.0 * random.direction(), 0.05 * random.direction());
    const double turned = turn_between(pose, box_pose());
    const double moved = distance_between(pose, box_pose());
    for (int i = 0; i < 3; ++i) pose = refit_to_planes(box(), pose, checker.check(0, pose), box_scan().regions);
    EXPECT_LT(turn_between(pose, box_pose()), 0.1 * turned);
    EXPECT_LT(distance_between(pose, box_pose()), 0.1 * moved);
    EXPECT_TRUE(is_rotation(pose.rotation, 1e-12));
  }
}

TEST(RefitToPlanes, leaves_the_true_pose_where_it_is) {
  const Pose pose = refit_to_planes(box(), box_pose(), check_of(box_scan(), box_pose()), box_scan().regions);
  EXPECT_LT(turn_between(pose, box_pose()), 1e-3);
  EXPECT_LT(distance_between(pose, box_pose()), 0.1);
}

TEST(RefitToPlanes, changes_nothing_without_supports) {
  const Pose off = test::moved(box_pose(), {1, 2, 3}, {0.1, 0.2, 0.3});
  const Pose same = refit_to_planes(box(), off, {}, box_scan().regions);
  EXPECT_EQ(same.rotation, off.rotation);
  EXPECT_EQ(same.translation, off.translation);
}

TEST(RefitToPlanes, regions_the_object_hardly_explains_take_no_part) {
  const Pose off = test::moved(box_pose(), {1, 2, 3}, {0.02, 0.0, 0.0});
  PoseCheck check;
  const auto cells = static_cast<double>(box_scan().regions[0].region.cells.size());
  check.supports = {{0, test::face_shown(box(), box_pose(), box_scan().regions[0]).value(), 0.3 * cells}};
  EXPECT_EQ(refit_to_planes(box(), off, check, box_scan().regions).translation, off.translation);
  check.supports[0].cells = 0.4 * cells;
  EXPECT_NE(refit_to_planes(box(), off, check, box_scan().regions).translation, off.translation);
}

TEST(RefitToPlanes, leaves_what_no_plane_decides) {
  const DescribedRegion& region = box_scan().regions[0];
  const int face = test::face_shown(box(), box_pose(), region).value();
  const Vector3d normal = region.region.normal;
  const Vector3d along = normal.unitOrthogonal();
  PoseCheck one;
  one.supports = {{0, face, static_cast<double>(region.region.cells.size())}};
  // Moved and turned within the plane: nothing to mend.
  const Pose slid = test::moved(box_pose(), 7.0 * along, 0.3 * normal);
  const Pose kept = refit_to_planes(box(), slid, one, box_scan().regions);
  EXPECT_LT(turn_between(kept, slid), 1e-3);
  EXPECT_LT(distance_between(kept, slid), 0.1);
  // Off the plane as well: that alone is mended.
  const Pose off = test::moved(slid, 5.0 * normal, {0, 0, 0});
  const Pose mended = refit_to_planes(box(), off, one, box_scan().regions);
  EXPECT_NEAR(normal.dot(mended * kBoxCentre - slid * kBoxCentre), 0.0, 0.2);
  const Vector3d moved = mended * kBoxCentre - off * kBoxCentre;
  EXPECT_LT((moved - normal * normal.dot(moved)).norm(), 0.1);
}

}  // namespace
}  // namespace foresight
