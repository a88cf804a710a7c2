#include "runtime/pose_evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "tests/images.h"
#include "tests/runtime/box_scene.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

// A scan with what refers to it kept alive.
struct Seen {
  SensorModel sensor;
  RangeImage image;
  PoolVector<DescribedRegion> regions;

  explicit Seen(RangeImage seen) : image(std::move(seen)), regions(extract_regions(image, sensor.camera, {})) {}

  [[nodiscard]] LabelledScan labelled() const { return label_scan(image, sensor.camera, sensor, regions); }
};

Seen box_seen(const std::vector<test::Screen>& screens = {}) {
  return Seen(test::box_image(test::box_pose(), PinholeCamera{}, screens));
}

PoseEvidence box_evidence(const Seen& seen, const Pose& pose = test::box_pose()) {
  return gather_evidence(test::box_model(), pose, seen.labelled());
}

// One side of a thin plate 60 x 40 mm, facing the camera at 900 mm.
CompiledModel plate() {
  CompiledModel model;
  model.vertices = {{-30, -20, 900}, {-30, 20, 900}, {30, 20, 900}, {30, -20, 900}};
  model.triangles = {{0, 1, 2}, {0, 2, 3}};
  return model;
}

void expect_counts_add_up(const PoseEvidence& e) {
  EXPECT_EQ(e.explained + e.tilted + e.behind + e.front + e.beyond + e.shadowed + e.missing, e.drawn);
  EXPECT_LE(e.owned, e.explained + 1e-9);
  EXPECT_LE(e.faces_found, e.faces);
  EXPECT_LE(e.largest, e.explained);
  for (const int k : {kOwnedShare, kContradictedShare, kMissing, kHiddenShare, kFoundFaces, kAmount, kOtherSurfaces}) {
    const double share = evidence_features(e)[static_cast<std::size_t>(k)];
    EXPECT_TRUE(share >= 0.0 && share <= 1.0 + 1e-9) << k << ": " << share;
  }
}

// Every second row and column tells about the same as all.
TEST(PoseEvidence, a_stride_changes_little) {
  const Seen seen = box_seen({{800.0, 0, 118}});
  EvidenceOptions coarse;
  coarse.stride = 2;
  for (const double shift : {0.0, 3.0, 12.0}) {
    const Pose pose = test::moved(test::box_pose(), {shift, 0, 0}, {0, 0, 0});
    const PoseEvidence all = box_evidence(seen, pose);
    const PoseEvidence some = gather_evidence(test::box_model(), pose, seen.labelled(), coarse);
    expect_counts_add_up(some);
    EXPECT_NEAR(some.drawn, all.drawn, 0.03 * all.drawn);
    EXPECT_NE(some.drawn, all.drawn);
    for (std::size_t k = 0; k < kEvidenceFeatureCount; ++k) {
      if (k == kFoundFaces) continue;  // a small face may be below the count that decides
      EXPECT_NEAR(evidence_features(some)[k], evidence_features(all)[k], 0.05) << k;
    }
  }
}

TEST(LabelScan, numbers_cells_by_their_region) {
  const Seen seen = box_seen();
  const LabelledScan scan = seen.labelled();
  ASSERT_EQ(seen.regions.size(), 3U);
  EXPECT_EQ(std::count(scan.taken.begin(), scan.taken.end(), true), 0);
  for (std::size_t r = 0; r < 3; ++r) {
    EXPECT_EQ(static_cast<std::size_t>(std::count(scan.labels.begin(), scan.labels.end(), static_cast<int>(r) + 1)),
              seen.regions[r].region.cells.size());
    EXPECT_EQ(static_cast<std::size_t>(scan.free_cells[r]), seen.regions[r].region.cells.size());
  }
}

TEST(PoseEvidence, the_true_pose_is_explained) {
  const Seen seen = box_seen();
  const PoseEvidence e = box_evidence(seen);
  EXPECT_GT(e.drawn, 500);
  EXPECT_EQ(e.explained, e.drawn);
  EXPECT_GT(e.owned, 0.97 * e.explained);
  EXPECT_EQ(e.faces, 3);
  EXPECT_EQ(e.faces_found, 3);
  for (std::size_t r = 0; r < seen.regions.size(); ++r) {
    EXPECT_GT(e.explained_of_region[r], 0.95 * static_cast<double>(seen.regions[r].region.cells.size()));
  }
  expect_counts_add_up(e);
}

TEST(PoseEvidence, outlines_half_a_cell_off_do_not_count) {
  const Seen seen = box_seen();
  for (const Vector3d& move : {Vector3d(0.5, 0, 0), Vector3d(-0.5, 0, 0), Vector3d(0, 0.5, 0), Vector3d(0, -0.5, 0)}) {
    const PoseEvidence e = box_evidence(seen, test::moved(test::box_pose(), move, {0, 0, 0}));
    EXPECT_GT(e.drawn, 500);
    EXPECT_EQ(e.missing, 0) << move.transpose();
    EXPECT_EQ(e.behind + e.front, 0) << move.transpose();
    EXPECT_LT(e.tilted, 0.03 * e.drawn) << move.transpose();  // creases do: the region beyond has another normal
  }
}

TEST(PoseEvidence, an_absent_object_is_missing_before_nothing) {
  const PoseEvidence e = box_evidence(Seen(RangeImage(240, 256)));
  EXPECT_GT(e.drawn, 500);
  EXPECT_EQ(e.missing, e.drawn);
  EXPECT_EQ(e.faces, 0);
  expect_counts_add_up(e);
}

TEST(PoseEvidence, an_absent_object_is_seen_through_before_a_wall) {
  const PoseEvidence e = box_evidence(Seen(test::render({test::facing({0, 0, 1200}, 1000, 1000)}, PinholeCamera{})));
  EXPECT_EQ(e.behind, e.drawn);
  EXPECT_EQ(e.faces, 3);
  EXPECT_EQ(e.faces_found, 0);
  EXPECT_DOUBLE_EQ(evidence_features(e)[kContradictedShare], 1.0);
  expect_counts_add_up(e);
}

TEST(PoseEvidence, what_hides_the_object_does_not_contradict_it) {
  const PoseEvidence alone = box_evidence(box_seen());
  const PoseEvidence hidden = box_evidence(box_seen({{700.0, 0, 120}}));
  EXPECT_GT(hidden.front, 0.2 * hidden.drawn);
  EXPECT_EQ(hidden.behind, 0);
  EXPECT_EQ(hidden.tilted, 0);
  EXPECT_EQ(hidden.missing, 0);
  EXPECT_EQ(hidden.drawn, alone.drawn);
  EXPECT_LT(hidden.explained, alone.explained);
  EXPECT_EQ(evidence_features(hidden)[kContradictedShare], 0.0);
  EXPECT_EQ(hidden.faces_found, hidden.faces);
  expect_counts_add_up(hidden);
}

// A plate without data, lit from beside the camera, and what else is seen.
PoseEvidence dark_plate(const std::vector<test::Rectangle>& seen, const std::optional<Vector3d>& projector) {
  Seen scan(test::render(seen, PinholeCamera{}));
  scan.sensor.projector = projector;
  return gather_evidence(plate(), {}, scan.labelled());
}

TEST(PoseEvidence, missing_data_in_what_may_be_a_shadow_are_unseen) {
  const Vector3d beside(250, 0, 0);
  const auto between = test::facing({55, 0, 700}, 40, 60);
  const PoseEvidence dark = dark_plate({between}, beside);
  EXPECT_GT(dark.drawn, 500);
  EXPECT_GT(dark.shadowed, 0.4 * dark.drawn);
  EXPECT_GT(evidence_features(dark)[kHiddenShare], 0.4);
  expect_counts_add_up(dark);
  EXPECT_EQ(dark_plate({between}, Vector3d(-250, 0, 0)).shadowed, 0);  // on the other side
  EXPECT_EQ(dark_plate({between}, std::nullopt).missing, dark.drawn);
}

TEST(PoseEvidence, what_the_light_meets_beyond_the_image_may_cast_a_shadow) {
  const PoseEvidence dark = dark_plate({test::facing({-60, 0, 500}, 20, 20)}, Vector3d(250, 0, 0));
  EXPECT_EQ(dark.shadowed, dark.drawn);
  // Inside the image the way is already nearer to the camera than anything seen.
  EXPECT_EQ(dark_plate({test::facing({-80, 0, 850}, 20, 20)}, Vector3d(250, 0, 0)).missing, dark.drawn);
}

TEST(PoseEvidence, a_surface_turned_away_from_the_light_is_unseen) {
  const PoseEvidence dark = dark_plate({test::facing({-80, 0, 850}, 20, 20)}, Vector3d(0, 0, 2000));
  EXPECT_EQ(dark.shadowed, dark.drawn);
}

TEST(PoseEvidence, few_missing_cells_say_much) {
  PoseEvidence e;
  e.drawn = 1000;
  double last = 0.0;
  for (const int missing : {0, 100, 1000}) {
    e.missing = missing;
    const double feature = evidence_features(e)[kMissing];
    EXPECT_TRUE(missing == 0 ? feature == 0.0 : feature > last);
    EXPECT_LT(feature, 1.0);
    last = feature;
  }
  e.missing = 100;
  EXPECT_NEAR(evidence_features(e)[kMissing], 0.5, 1e-9);
}

TEST(PoseEvidence, more_faces_found_say_more_and_faces_not_found_less) {
  const auto feature = [](int found, int faces) {
    PoseEvidence e;
    e.faces = faces;
    e.faces_found = found;
    return evidence_features(e)[kFoundFaces];
  };
  EXPECT_LT(feature(1, 1), feature(2, 2));
  EXPECT_LT(feature(2, 2), feature(5, 5));
  EXPECT_LT(feature(2, 3), feature(2, 2));
  EXPECT_EQ(feature(0, 0), 0.0);
}

TEST(PoseEvidence, regions_that_run_on_beyond_a_face_are_not_owned) {
  double last = 2.0;
  for (const double growth : {1.0, 1.5, 3.0}) {
    const Seen seen(test::render({test::facing({0, 0, 900}, 60 * growth, 40 * growth)}, PinholeCamera{}));
    ASSERT_EQ(seen.regions.size(), 1U);
    const PoseEvidence e = gather_evidence(plate(), {}, seen.labelled());
    EXPECT_EQ(e.explained, e.drawn);
    const double owned = e.owned / e.explained;
    EXPECT_NEAR(owned, 1.0 / (growth * growth), 0.06);
    EXPECT_LT(owned, last);
    last = owned;
    expect_counts_add_up(e);
  }
}

void take_region(LabelledScan& scan, std::size_t region) {
  for (const int cell : scan.regions[region].region.cells) take(scan, cell);
}

TEST(PoseEvidence, what_another_object_explains_contradicts) {
  const Seen seen = box_seen();
  LabelledScan scan = seen.labelled();
  const PoseEvidence free = gather_evidence(test::box_model(), test::box_pose(), scan);
  take_region(scan, 0);
  EXPECT_EQ(scan.free_cells[0], 0);
  const PoseEvidence some = gather_evidence(test::box_model(), test::box_pose(), scan);
  for (const std::size_t r : {1U, 2U}) take_region(scan, r);
  const PoseEvidence taken = gather_evidence(test::box_model(), test::box_pose(), scan);
  EXPECT_EQ(taken.drawn, free.drawn);
  EXPECT_GT(taken.tilted, 0.9 * taken.drawn);
  EXPECT_EQ(std::accumulate(taken.explained_of_region.begin(), taken.explained_of_region.end(), 0), 0);
  EXPECT_EQ(taken.faces_found, 0);
  EXPECT_GT(some.tilted, free.tilted);
  EXPECT_LT(some.tilted, taken.tilted);
  expect_counts_add_up(some);
  expect_counts_add_up(taken);
}

// Two plates of one size side by side in one plane come out as one region. What is left by the first is the other's
// own.
TEST(PoseEvidence, the_rest_of_a_region_is_owned_by_who_explains_it) {
  const Seen seen(test::render({test::facing({30, 0, 900}, 120, 40)}, PinholeCamera{}));
  ASSERT_EQ(seen.regions.size(), 1U);
  LabelledScan scan = seen.labelled();
  const Pose beside{Eigen::Matrix3d::Identity(), {60, 0, 0}};
  const PoseEvidence before = gather_evidence(plate(), beside, scan);
  EXPECT_NEAR(before.owned / before.explained, 0.5, 0.06);
  EXPECT_FALSE(is_taken(scan, 0));
  take_explained(plate(), {}, {}, scan);
  EXPECT_NEAR(scan.free_cells[0], 0.5 * static_cast<double>(seen.regions[0].region.cells.size()),
              0.03 * static_cast<double>(seen.regions[0].region.cells.size()));
  const PoseEvidence after = gather_evidence(plate(), beside, scan);
  EXPECT_GT(after.owned / after.explained, 0.94);
  const PoseEvidence again = gather_evidence(plate(), {}, scan);
  EXPECT_GT(again.tilted, 0.95 * again.drawn);
  take_explained(plate(), beside, {}, scan);
  EXPECT_TRUE(is_taken(scan, 0));
  EXPECT_EQ(scan.free_cells[0], 0);  // its border, too
}

// An object that hangs over the border of the image: what lies beyond is as little seen as what is hidden.
TEST(PoseEvidence, counts_what_lies_beyond_the_image_as_unseen) {
  const PinholeCamera camera;
  const double half_width = 0.5 * camera.columns * 900.0 / camera.fx;
  const Pose over_the_border{Eigen::Matrix3d::Identity(), {half_width, 0, 0}};
  const Seen seen(test::render({test::facing({half_width, 0, 900}, 60, 40)}, camera));
  const PoseEvidence e = gather_evidence(plate(), over_the_border, seen.labelled());
  EXPECT_NEAR(e.beyond, 0.5 * e.drawn, 0.04 * e.drawn);
  EXPECT_EQ(e.explained + e.beyond, e.drawn);
  EXPECT_NEAR(evidence_features(e)[kHiddenShare], 0.5, 0.04);
  EXPECT_NEAR(evidence_features(e)[kMissing], 0.0, 1e-9);
  expect_counts_add_up(e);
  const PoseEvidence whole = gather_evidence(plate(), {}, seen.labelled());
  EXPECT_EQ(whole.beyond, 0);
  EXPECT_NEAR(whole.drawn, e.drawn, 0.05 * whole.drawn);
}

// A wall that cuts the plate at an angle has data on it, but no surface like it.
TEST(PoseEvidence, a_region_with_another_normal_contradicts) {
  const auto cut_at = [](double angle) {
    const Pose turn{rotation_from_vector({0, angle, 0}), {0, 0, 900}};
    const Seen seen(test::render({test::moved(test::facing({0, 0, 0}, 200, 200), turn)}, PinholeCamera{}));
    return gather_evidence(plate(), {}, seen.labelled());
  };
  const PoseEvidence steep = cut_at(0.7);  // beyond 30 degrees
  EXPECT_GT(steep.tilted, 100);
  EXPECT_EQ(steep.explained, 0);
  EXPECT_GT(steep.front, 100);
  EXPECT_GT(steep.behind, 100);
  const PoseEvidence slight = cut_at(0.1);
  EXPECT_EQ(slight.tilted, 0);
  EXPECT_EQ(slight.explained, slight.drawn);
  expect_counts_add_up(steep);
}

// What stands flush with a box hides its side, though near the edge its surface is near that of the side.
TEST(PoseEvidence, another_surface_well_before_a_steep_one_hides_it) {
  const Eigen::Matrix3d steep = rotation_from_vector({0, 1.3, 0});
  const Vector3d centre(0, 0, 900);
  const Pose pose{steep, centre - steep * centre};
  // Across the steep plate 12 mm are less than 4.
  Seen seen(test::render({test::facing({0, 0, 888}, 200, 200)}, PinholeCamera{}));
  seen.sensor.matching_window = 3;
  const PoseEvidence e = gather_evidence(plate(), pose, seen.labelled());
  EXPECT_GT(e.front, 10);
  for (const double before : {6.0, 12.0}) {
    Seen nearer(test::render({test::facing({0, 0, 870 - before}, 200, 200)}, PinholeCamera{}));
    nearer.sensor.matching_window = 3;
    const PoseEvidence hidden = gather_evidence(plate(), pose, nearer.labelled());
    EXPECT_EQ(hidden.front, hidden.drawn);
    EXPECT_EQ(hidden.tilted, 0);
  }
}

// Their depths are means of what lies on either side.
TEST(PoseEvidence, cells_near_outlines_do_not_count_for_sensors_that_match_windows) {
  Seen seen = box_seen();
  int last = box_evidence(seen).drawn;
  for (const int window : {3, 5, 9}) {
    seen.sensor.matching_window = window;
    const PoseEvidence e = box_evidence(seen);
    EXPECT_LT(e.drawn, last) << window;
    EXPECT_EQ(e.explained, e.drawn) << window;
    last = e.drawn;
    expect_counts_add_up(e);
  }
}

// Along the ray, a step across a slanting surface is longer.
TEST(PoseEvidence, data_agree_within_the_distance_across_the_surface) {
  for (const double angle : {0.0, 0.5, 1.0}) {
    const Eigen::Matrix3d rotation = rotation_from_vector({0, angle, 0});
    const Vector3d centre(0, 0, 900);
    const Pose pose{rotation, centre - rotation * centre};
    for (const double off : {-4.5, -3.5, 3.5, 4.5}) {
      const Pose wall{rotation, centre + off * rotation.col(2)};
      const Seen seen(test::render({test::moved(test::facing({0, 0, 0}, 200, 200), wall)}, PinholeCamera{}));
      const PoseEvidence e = gather_evidence(plate(), pose, seen.labelled());
      ASSERT_GT(e.drawn, 500);
      EXPECT_EQ(e.explained, std::abs(off) < 4.0 ? e.drawn : 0);
      EXPECT_EQ(e.behind, off > 4.0 ? e.drawn : 0);
      EXPECT_EQ(e.front, off < -4.0 ? e.drawn : 0);
      EvidenceOptions wider;
      wider.distance = 5.0;
      EXPECT_EQ(gather_evidence(plate(), pose, seen.labelled(), wider).explained, e.drawn);
    }
  }
}

TEST(PoseEvidence, speaks_against_displaced_poses_more_the_farther_they_are) {
  const Seen seen = box_seen();
  double last = box_evidence(seen).owned;
  for (const double distance : {4.0, 8.0, 32.0}) {
    const PoseEvidence e = box_evidence(seen, test::moved(test::box_pose(), {0.0, distance, 0.0}, {0, 0, 0}));
    EXPECT_LT(e.owned, last) << distance;
    last = e.owned;
    expect_counts_add_up(e);
  }
  EXPECT_LT(last, 0.2 * box_evidence(seen).owned);
}

TEST(PoseEvidence, asks_nothing_where_the_sensor_gives_nothing) {
  Seen seen = box_seen();
  const PoseEvidence all = box_evidence(seen);
  seen.sensor.largest_incidence = 0.8;
  const PoseEvidence steep_left_out = box_evidence(seen);
  EXPECT_LT(steep_left_out.drawn, all.drawn);
  EXPECT_GT(steep_left_out.drawn, 0);
  EXPECT_EQ(steep_left_out.explained, steep_left_out.drawn);
}

TEST(PoseEvidence, is_nothing_outside_the_image) {
  const Seen seen = box_seen();
  for (const Vector3d& move : {Vector3d(5000, 0, 0), Vector3d(0, 0, -2000)}) {
    const PoseEvidence e = box_evidence(seen, test::moved(test::box_pose(), move, {0, 0, 0}));
    EXPECT_EQ(e.drawn, 0);
    EXPECT_EQ(e.explained_of_region, PoolVector<int>(3, 0));
    for (std::size_t k = 0; k < kEvidenceFeatureCount; ++k) {
      if (k != kOtherSurfaces) {
        EXPECT_EQ(evidence_features(e)[k], 0.0);
      }
    }
  }
}

TEST(EvidenceFeatures, the_amount_rises_with_the_owned_cells) {
  PoseEvidence e;
  double last = 0.0;
  for (const double owned : {10.0, 100.0, 300.0, 1000.0, 1e6}) {
    e.owned = owned;
    const double amount = evidence_features(e)[kAmount];
    EXPECT_GT(amount, last) << owned;
    EXPECT_LT(amount, 1.0) << owned;
    last = amount;
  }
  EXPECT_GT(last, 0.99);
  e.owned = 0.0;
  EXPECT_EQ(evidence_features(e)[kAmount], 0.0);
}

// The same view from half as far shows four times the cells: more to go by.
TEST(EvidenceFeatures, the_amount_is_larger_for_nearer_objects) {
  const Seen near(test::box_image(test::box_pose(600), PinholeCamera{}));
  const Seen far(test::box_image(test::box_pose(1200), PinholeCamera{}));
  const double of_near = evidence_features(box_evidence(near, test::box_pose(600)))[kAmount];
  const double of_far = evidence_features(box_evidence(far, test::box_pose(1200)))[kAmount];
  EXPECT_GT(of_near, of_far + 0.1);
}

TEST(EvidenceFeatures, one_face_alone_has_no_other_surfaces) {
  const Seen seen(test::render({test::facing({0, 0, 900}, 60, 40)}, PinholeCamera{}));
  CompiledModel model = plate();
  model.triangle_faces = {0, 0};
  const PoseEvidence of_face = gather_evidence(model, {}, seen.labelled());
  EXPECT_EQ(of_face.largest, of_face.explained);
  EXPECT_EQ(evidence_features(of_face)[kOtherSurfaces], 0.0);
  // Where faces are unknown, each triangle is one: about half of the plate.
  const PoseEvidence of_triangles = gather_evidence(plate(), {}, seen.labelled());
  EXPECT_EQ(of_triangles.explained, of_face.explained);
  EXPECT_NEAR(evidence_features(of_triangles)[kOtherSurfaces], 0.5, 0.05);
}

TEST(EvidenceFeatures, a_corner_view_has_other_surfaces) {
  const Seen seen = box_seen();
  const PoseEvidence e = box_evidence(seen);
  const auto largest = std::max_element(e.explained_of_region.begin(), e.explained_of_region.end());
  EXPECT_NEAR(e.largest, *largest, 0.2 * *largest);
  EXPECT_GT(evidence_features(e)[kOtherSurfaces], 0.3);
}

TEST(EvidenceFeatures, of_nothing_explained_nothing_is_on_other_surfaces) {
  EXPECT_EQ(evidence_features(PoseEvidence{})[kOtherSurfaces], 0.0);
}

TEST(AgreeingDistance, grows_with_the_noise_of_the_sensor_from_what_localization_leaves) {
  SensorModel sensor;
  sensor.depth_quantization = 0.0;
  double last = 0.0;
  for (const double noise : {0.0, 0.1, 0.5, 1.0, 3.0}) {
    sensor.depth_noise = noise;
    const double distance = agreeing_distance(sensor);
    EXPECT_GE(distance, last);
    EXPECT_GE(distance, 3.0 * sensor.depth_sigma());
    EXPECT_GT(distance, 1.0);  // a step of localization
    last = distance;
  }
  EXPECT_GT(last, 9.0);
}

TEST(ProbabilityRight, is_a_half_for_a_model_that_knows_nothing) {
  EXPECT_DOUBLE_EQ(probability_right({}, box_evidence(box_seen())), 0.5);
}

TEST(ProbabilityRight, rises_with_each_weight_whose_evidence_is_there) {
  PoseEvidence e;
  e.drawn = 100;
  e.explained = 40;
  e.tilted = e.behind = 10;
  e.front = e.missing = 20;
  e.owned = 30.0;
  e.largest = 25;
  e.faces = 4;
  e.faces_found = 3;
  for (std::size_t k = 0; k < kEvidenceFeatureCount; ++k) {
    double last = 0.0;
    for (const double weight : {-30.0, -1.0, 0.0, 2.0, 30.0}) {
      AcceptanceModel model;
      model.weights[k] = weight;
      const double probability = probability_right(model, e);
      EXPECT_GT(probability, last) << k;
      EXPECT_LT(probability, 1.0) << k;
      last = probability;
    }
  }
}

TEST(ProbabilityRight, stays_between_zero_and_one_for_extreme_models) {
  const PoseEvidence e = box_evidence(box_seen());
  for (const double bias : {-1e6, 1e6}) {
    AcceptanceModel model;
    model.bias = bias;
    EXPECT_EQ(probability_right(model, e), bias > 0.0 ? 1.0 : 0.0);
  }
}

}  // namespace
}  // namespace foresight
