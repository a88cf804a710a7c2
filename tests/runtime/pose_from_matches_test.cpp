#include "runtime/pose_from_matches.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/random.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

ModelFace face_at(const Vector3d& centroid, const Vector3d& normal) {
  ModelFace face;
  face.normal = normal.normalized();
  face.centroid = centroid;
  face.offset = face.normal.dot(centroid);
  return face;
}

// The region of a face wholly seen from the pose.
DescribedRegion region_of(const ModelFace& face, const Pose& T_sensor_model) {
  DescribedRegion region;
  region.region.normal = T_sensor_model.rotation * face.normal;
  region.centroid = T_sensor_model * face.centroid;
  region.region.offset = region.region.normal.dot(region.centroid);
  return region;
}

// Moves a region's centroid within its plane, as a part hidden would.
void slide_centroid(DescribedRegion& region, const Vector3d& by) {
  region.centroid += by - region.region.normal * region.region.normal.dot(by);
}

Pose random_pose(Random& random) {
  return {random.rotation(), Vector3d(0.0, 0.0, 900.0) + random.uniform(0.0, 200.0) * random.direction()};
}

// Three faces of a box that meet in a corner; not about the origin.
std::vector<ModelFace> random_box(Random& random) {
  const Vector3d size(random.uniform(10.0, 90.0), random.uniform(10.0, 90.0), random.uniform(10.0, 90.0));
  const Vector3d corner = random.uniform(0.0, 100.0) * random.direction();
  std::vector<ModelFace> faces;
  for (int axis = 0; axis < 3; ++axis) {
    Vector3d centroid = corner + 0.5 * size;
    centroid[axis] = corner[axis] + size[axis];
    faces.push_back(face_at(centroid, Vector3d::Unit(axis)));
  }
  return faces;
}

PoolVector<DescribedRegion> regions_of(const std::vector<ModelFace>& faces, const Pose& pose) {
  PoolVector<DescribedRegion> regions;
  for (const ModelFace& face : faces) regions.push_back(region_of(face, pose));
  return regions;
}

std::optional<Pose> estimate(const PoolVector<DescribedRegion>& regions, const std::vector<ModelFace>& faces,
                             std::vector<std::size_t> order = {}) {
  if (order.empty()) {
    for (std::size_t i = 0; i < faces.size(); ++i) order.push_back(i);
  }
  PoolVector<RegionFaceMatch> matches;
  for (const std::size_t i : order) matches.push_back({&regions[i], &faces[i]});
  return pose_from_matches(matches);
}

void expect_pose(const std::optional<Pose>& found, const Pose& truth, double millimetres = 1e-8,
                 double radians = 1e-10) {
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(is_rotation(found->rotation, 1e-9));
  EXPECT_LT(rotation_angle(found->rotation.transpose() * truth.rotation), radians);
  EXPECT_LT((found->translation - truth.translation).norm(), millimetres);
}

TEST(PoseFromMatches, of_three_box_faces_is_exact_even_with_parts_hidden) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto faces = random_box(random);
    const Pose truth = random_pose(random);
    auto regions = regions_of(faces, truth);
    for (DescribedRegion& region : regions) slide_centroid(region, 20.0 * random.direction());
    expect_pose(estimate(regions, faces), truth);
  }
}

TEST(PoseFromMatches, of_two_wholly_seen_faces_is_exact) {
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    auto faces = random_box(random);
    faces.pop_back();
    const Pose truth = random_pose(random);
    expect_pose(estimate(regions_of(faces, truth), faces), truth);
  }
}

TEST(PoseFromMatches, of_faces_at_any_dependable_angle_is_exact) {
  Random random(3);
  for (const double degrees : {11.0, 30.0, 90.0, 150.0, 169.0}) {
    const double angle = degrees / 57.29577951308232;
    const std::vector<ModelFace> faces = {face_at({0.0, 0.0, 30.0}, Vector3d::UnitZ()),
                                          face_at({40.0, 5.0, 10.0}, {std::sin(angle), 0.0, std::cos(angle)})};
    const Pose truth = random_pose(random);
    expect_pose(estimate(regions_of(faces, truth), faces), truth, 1e-7, 1e-9);
  }
}

TEST(PoseFromMatches, takes_only_the_sliding_direction_from_centroids) {
  Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    auto faces = random_box(random);
    faces.pop_back();
    const Pose truth = random_pose(random);
    auto regions = regions_of(faces, truth);
    const Vector3d slides[] = {15.0 * random.direction(), 15.0 * random.direction()};
    for (std::size_t i = 0; i < 2; ++i) slide_centroid(regions[i], slides[i]);
    const auto found = estimate(regions, faces);
    // The two planes fix everything but a slide along their common line, and the centroids say how far on the mean.
    const Vector3d line = regions[0].region.normal.cross(regions[1].region.normal).normalized();
    const Pose expected{truth.rotation, truth.translation + line * line.dot(0.5 * (slides[0] + slides[1]))};
    expect_pose(found, expected);
  }
}

TEST(PoseFromMatches, of_parallel_steps_turns_by_the_centroids) {
  Random random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<ModelFace> steps = {face_at({0.0, 10.0, 10.0}, Vector3d::UnitZ()),
                                          face_at({30.0, 10.0, 25.0}, Vector3d::UnitZ()),
                                          face_at({45.0, -20.0, 40.0}, Vector3d::UnitZ())};
    const Pose truth = random_pose(random);
    expect_pose(estimate(regions_of(steps, truth), steps), truth);
    const std::vector<ModelFace> two(steps.begin(), steps.begin() + 2);
    expect_pose(estimate(regions_of(two, truth), two), truth);
  }
}

TEST(PoseFromMatches, of_nearly_parallel_planes_turns_by_the_centroids) {
  // The regions of two parallel steps as noise tilts them: the turn must not come from the tilt, whatever its
  // direction.
  Random random(6);
  const std::vector<ModelFace> steps = {face_at({0.0, 0.0, 10.0}, Vector3d::UnitZ()),
                                        face_at({40.0, 0.0, 25.0}, Vector3d::UnitZ())};
  for (int trial = 0; trial < 100; ++trial) {
    const Pose truth = random_pose(random);
    auto regions = regions_of(steps, truth);
    for (DescribedRegion& region : regions) {
      region.region.normal = rotation_from_vector(0.02 * random.direction()) * region.region.normal;
      region.region.offset = region.region.normal.dot(region.centroid);
    }
    expect_pose(estimate(regions, steps), truth, 3.0, 0.04);
  }
}

TEST(PoseFromMatches, stays_near_the_truth_under_noise) {
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const auto faces = random_box(random);
    const Pose truth = random_pose(random);
    auto regions = regions_of(faces, truth);
    for (DescribedRegion& region : regions) {
      region.region.normal = rotation_from_vector(0.01 * random.direction()) * region.region.normal;
      region.region.offset = region.region.normal.dot(region.centroid) + random.uniform(-0.2, 0.2);
    }
    // Angles err as the normals do; a point d from the origin of the model by that angle times d.
    const auto found = estimate(regions, faces);
    expect_pose(found, truth, 5.0, 0.02);
    for (const ModelFace& face : faces) EXPECT_LT((*found * face.centroid - truth * face.centroid).norm(), 2.0);
  }
}

TEST(PoseFromMatches, does_not_depend_on_the_order_of_matches) {
  Random random(8);
  for (int trial = 0; trial < 50; ++trial) {
    auto faces = random_box(random);
    if (trial % 2 == 0) faces[1].normal = faces[2].normal = faces[0].normal;  // parallel planes
    auto regions = regions_of(faces, random_pose(random));
    for (DescribedRegion& region : regions) {
      region.region.normal = rotation_from_vector(0.01 * random.direction()) * region.region.normal;
      slide_centroid(region, 5.0 * random.direction());
    }
    const auto first = estimate(regions, faces, {0, 1, 2});
    ASSERT_TRUE(first.has_value());
    std::vector<std::size_t> order = {0, 1, 2};
    while (std::next_permutation(order.begin(), order.end())) {
      expect_pose(estimate(regions, faces, order), *first, 1e-7, 1e-9);
    }
  }
}

TEST(PoseFromMatches, moves_with_the_sensor_frame) {
  Random random(9);
  for (int trial = 0; trial < 50; ++trial) {
    const auto faces = random_box(random);
    auto regions = regions_of(faces, random_pose(random));
    for (DescribedRegion& region : regions) {
      region.region.normal = rotation_from_vector(0.05 * random.direction()) * region.region.normal;
    }
    const auto before = estimate(regions, faces);
    ASSERT_TRUE(before.has_value());
    const Pose motion = random_pose(random);
    for (DescribedRegion& region : regions) {
      region.region.normal = motion.rotation * region.region.normal;
      region.region.offset += region.region.normal.dot(motion.translation);
      region.centroid = motion * region.centroid;
    }
    expect_pose(estimate(regions, faces), motion * *before, 1e-7, 1e-9);
  }
}

TEST(PoseFromMatches, is_none_for_coaxial_parallel_faces) {
  Random random(10);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<ModelFace> tower = {face_at({7.0, 8.0, 10.0}, Vector3d::UnitZ()),
                                          face_at({7.0, 8.5, 40.0}, Vector3d::UnitZ())};
    auto regions = regions_of(tower, random_pose(random));
    EXPECT_FALSE(estimate(regions, tower).has_value());
    // Hiding parts of them moves the regions' centroids, and still says nothing about the turn.
    slide_centroid(regions[0], 5.0 * random.direction());
    EXPECT_FALSE(estimate(regions, tower).has_value());
    // Nor does the tilt that noise gives the regions.
    regions[1].region.normal = rotation_from_vector(0.05 * random.direction()) * regions[1].region.normal;
    EXPECT_FALSE(estimate(regions, tower).has_value());
  }
}

TEST(PoseFromMatches, is_none_for_the_mirror_image_of_a_corner) {
  Random random(11);
  const auto faces = random_box(random);
  auto regions = regions_of(faces, random_pose(random));
  std::swap(regions[0], regions[1]);
  EXPECT_FALSE(estimate(regions, faces).has_value());
}

}  // namespace
}  // namespace foresight
