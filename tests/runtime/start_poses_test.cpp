#include "runtime/start_poses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/runtime/learned_database.h"

namespace foresight {
namespace {

using Eigen::Vector3d;
using test::learned_block;
using test::SeenScan;

const Database& database() {
  static const Database loaded = test::database_of({learned_block()});
  return loaded;
}
const FaceShapes& shapes() {
  static const FaceShapes known(database());
  return known;
}

void expect_contains(const PatchFrame& frame, const PoolVector<Vector3d>& points, double tolerance) {
  const Vector3d across = frame.normal.cross(frame.axis);
  for (const Vector3d& point : points) {
    EXPECT_LE(std::abs(frame.axis.dot(point - frame.centre)), 0.5 * frame.extents[0] + tolerance);
    EXPECT_LE(std::abs(across.dot(point - frame.centre)), 0.5 * frame.extents[1] + tolerance);
    EXPECT_NEAR(frame.normal.dot(point - frame.centre), 0.0, tolerance);
  }
}

void expect_orthonormal(const PatchFrame& frame) {
  EXPECT_NEAR(frame.axis.norm(), 1.0, 1e-12);
  EXPECT_NEAR(frame.normal.dot(frame.axis), 0.0, 1e-9);
  EXPECT_GE(frame.extents[0], frame.extents[1]);
  EXPECT_GE(frame.extents[1], 0.0);
}

// Points of the x-y plane, taken somewhere into space.
struct Placed {
  Pose pose;
  PoolVector<Vector3d> points;

  Placed(Random& random, const std::vector<Eigen::Vector2d>& flat) {
    pose = {random.rotation(), 500.0 * random.direction()};
    for (const Eigen::Vector2d& p : flat) points.push_back(pose * Vector3d(p.x(), p.y(), 0.0));
  }
  [[nodiscard]] Vector3d normal() const { return pose.rotation.col(2); }
};

TEST(SmallestRectangle, of_a_rectangle_is_itself) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Placed rectangle(random, {{-40, -15}, {40, -15}, {40, 15}, {-40, 15}, {10, 15}, {3, 2}});
    const PatchFrame frame = smallest_rectangle(rectangle.points, rectangle.normal());
    EXPECT_NEAR(frame.extents[0], 80.0, 1e-6);
    EXPECT_NEAR(frame.extents[1], 30.0, 1e-6);
    EXPECT_NEAR((frame.centre - rectangle.pose.translation).norm(), 0.0, 1e-6);
    EXPECT_NEAR(std::abs(frame.axis.dot(rectangle.pose.rotation.col(0))), 1.0, 1e-9);
    EXPECT_EQ(frame.normal, rectangle.normal());
    expect_orthonormal(frame);
    expect_contains(frame, rectangle.points, 1e-6);
  }
}

// Area of the box about the points whose one side has this direction.
double area_along(const Placed& placed, double angle) {
  const Vector3d u = placed.pose.rotation * Vector3d(std::cos(angle), std::sin(angle), 0.0);
  const Vector3d v = placed.normal().cross(u);
  double area = 1.0;
  for (const Vector3d& direction : {u, v}) {
    const auto by = [&](const Vector3d& a, const Vector3d& b) { return direction.dot(a) < direction.dot(b); };
    const auto [low, high] = std::minmax_element(placed.points.begin(), placed.points.end(), by);
    area *= direction.dot(*high - *low);
  }
  return area;
}

TEST(SmallestRectangle, no_turned_box_about_the_points_is_smaller) {
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Eigen::Vector2d> flat;
    const int count = random.integer(3, 30);
    for (int i = 0; i < count; ++i) flat.emplace_back(random.uniform(-50, 50), random.uniform(-20, 20));
    if (trial % 3 == 0) flat.push_back(flat.front());                        // a point twice
    if (trial % 4 == 0) flat.push_back(0.5 * (flat.front() + flat.back()));  // three in a line
    const Placed placed(random, flat);
    const PatchFrame frame = smallest_rectangle(placed.points, placed.normal());
    expect_orthonormal(frame);
    expect_contains(frame, placed.points, 1e-6);
    double least = 1e300;
    for (double angle = 0.0; angle < 0.5 * std::numbers::pi; angle += 0.001) {
      least = std::min(least, area_along(placed, angle));
    }
    EXPECT_LE(frame.extents[0] * frame.extents[1], least * (1.0 + 1e-9)) << trial;
  }
}

TEST(SmallestRectangle, bears_points_that_span_no_area) {
  Random random(3);
  const Placed point(random, {{5, 7}});
  const PatchFrame of_point = smallest_rectangle(point.points, point.normal());
  expect_orthonormal(of_point);
  EXPECT_EQ(of_point.extents[0], 0.0);
  EXPECT_EQ(of_point.centre, point.points[0]);
  const Placed line(random, {{-30, -10}, {0, 0}, {30, 10}, {15, 5}});
  const PatchFrame of_line = smallest_rectangle(line.points, line.normal());
  expect_orthonormal(of_line);
  EXPECT_NEAR(of_line.extents[0], 2.0 * std::hypot(30.0, 10.0), 1e-6);
  EXPECT_NEAR(of_line.extents[1], 0.0, 1e-6);
  expect_contains(of_line, line.points, 1e-6);
}

TEST(SmallestRectangle, frames_the_regions_of_a_scan) {
  Random random(4);
  for (int view = 0; view < 10; ++view) {
    const SeenScan seen(test::image_of({{&learned_block(), test::random_pose(learned_block(), random)}}));
    const ScanRegions scan = frame_regions(seen.regions);
    ASSERT_EQ(scan.frames.size(), seen.regions.size());
    for (std::size_t r = 0; r < seen.regions.size(); ++r) {
      expect_orthonormal(scan.frames[r]);
      expect_contains(scan.frames[r], seen.regions[r].hull, 1e-6);
    }
  }
}

TEST(FaceShapes, know_the_corners_and_the_rectangle_of_each_face) {
  const std::vector<std::size_t> corners = {4, 5, 4, 5, 4, 5, 3};
  for (int face = 0; face < 7; ++face) {
    const auto f = static_cast<std::size_t>(face);
    const ModelFace& of_model = learned_block().faces[f];
    EXPECT_EQ(shapes().vertices(0, face).size(), corners[f]);
    expect_orthonormal(shapes().frame(0, face));
    expect_contains(shapes().frame(0, face), shapes().vertices(0, face), 1e-4);
    EXPECT_NEAR(shapes().major_axis(0, face).norm(), 1.0, 1e-9);
    EXPECT_NEAR(shapes().major_axis(0, face).dot(of_model.normal), 0.0, 1e-9);
  }
  // Of a whole rectangle: 70 x 40 at y = -25.
  EXPECT_NEAR(shapes().frame(0, 2).extents[0], 70.0, 1e-4);
  EXPECT_NEAR(shapes().frame(0, 2).extents[1], 40.0, 1e-4);
  EXPECT_NEAR(std::abs(shapes().major_axis(0, 2).x()), 1.0, 1e-6);
}

double turn_between(const Pose& a, const Pose& b) { return rotation_angle(a.rotation.transpose() * b.rotation); }

// How far the nearest of the starts is from a pose: in mm, with a millimetre for each degree.
double nearest_start(const PoolVector<Pose>& starts, const Pose& truth) {
  double nearest = 1e9;
  for (const Pose& start : starts) {
    EXPECT_TRUE(is_rotation(start.rotation, 1e-6));
    const double apart = (start * learned_block().centre - truth * learned_block().centre).norm();
    nearest = std::min(nearest, apart + turn_between(start, truth) * 180.0 / std::numbers::pi);
  }
  return nearest;
}

// A pose with three faces well in sight, each time turned otherwise.
Pose corner_view(Random& random) {
  Pose pose;
  pose.rotation = rotation_from_vector(0.15 * random.direction()) * test::box_pose().rotation *
                  (random.uniform() < 0.5 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                          : rotation_from_vector({0, std::numbers::pi / 2, 0}));
  pose.translation = {random.uniform(-30, 30), random.uniform(-30, 30), 900.0};
  return pose;
}

PoolVector<RatedMatch> true_matches(const SeenScan& seen, const Pose& pose) {
  PoolVector<RatedMatch> matches;
  for (std::size_t r = 0; r < seen.regions.size(); ++r) {
    const auto face = test::face_shown(learned_block(), pose, seen.regions[r]);
    if (face && seen.regions[r].region.cells.size() > 150) matches.push_back({static_cast<int>(r), 0, *face, 0.0});
  }
  return matches;
}

TEST(PairStarts, hold_the_true_pose_for_whole_faces) {
  Random random(5);
  int pairs = 0;
  for (int view = 0; view < 15; ++view) {
    const Pose truth = corner_view(random);
    const SeenScan seen(test::image_of({{&learned_block(), truth}}));
    const ScanRegions scan = frame_regions(seen.regions);
    const PoolVector<RatedMatch> matches = true_matches(seen, truth);
    for (std::size_t i = 0; i < matches.size(); ++i) {
      for (std::size_t j = i + 1; j < matches.size(); ++j) {
        EXPECT_LT(nearest_start(pair_starts(database(), shapes(), scan, {matches[i], matches[j], 0.0}), truth), 4.0);
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 30);
}

// The object with what lies left or right of its middle hidden by a screen.
RangeImage half_hidden(const Pose& pose, bool left) {
  const PinholeCamera camera;
  RangeImage image = test::image_of({{&learned_block(), pose}}, camera);
  const int middle = static_cast<int>(camera.project(pose.translation).x());
  for (int cell = 0; cell < image.size(); ++cell) {
    const int column = cell % image.columns;
    if (left ? column >= middle - 10 : column <= middle + 10) continue;
    image[cell] = (700.0 * camera.ray(cell / image.columns, column)).cast<float>();
  }
  return image;
}

// Each face keeps at least one end.
TEST(PairStarts, hold_the_true_pose_for_faces_cut_at_one_end) {
  Random random(6);
  int pairs = 0;
  int near = 0;
  for (int view = 0; view < 30; ++view) {
    const Pose truth = corner_view(random);
    const SeenScan seen(half_hidden(truth, view % 2 == 0));
    const ScanRegions scan = frame_regions(seen.regions);
    const PoolVector<RatedMatch> matches = true_matches(seen, truth);
    for (std::size_t i = 0; i < matches.size(); ++i) {
      for (std::size_t j = i + 1; j < matches.size(); ++j) {
        const PoolVector<Pose> starts = pair_starts(database(), shapes(), scan, {matches[i], matches[j], 0.0});
        ++pairs;
        near += nearest_start(starts, truth) < 5.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(pairs, 40);
  EXPECT_GE(near, 0.95 * pairs);
}

TEST(PairStarts, lay_both_planes_where_the_regions_are) {
  Random random(7);
  const Pose truth = corner_view(random);
  const SeenScan seen(test::image_of({{&learned_block(), truth}}));
  const ScanRegions scan = frame_regions(seen.regions);
  const PoolVector<RatedMatch> matches = true_matches(seen, truth);
  ASSERT_GE(matches.size(), 2U);
  const PoolVector<Pose> starts = pair_starts(database(), shapes(), scan, {matches[0], matches[1], 0.0});
  ASSERT_FALSE(starts.empty());
  for (const Pose& start : starts) {
    for (const RatedMatch& match : {matches[0], matches[1]}) {
      const Region& region = seen.regions[static_cast<std::size_t>(match.region)].region;
      const ModelFace& face = learned_block().faces[static_cast<std::size_t>(match.face)];
      EXPECT_GT(region.normal.dot(start.rotation * face.normal), 0.999);
      EXPECT_NEAR(region.normal.dot(start * face.centroid), region.offset, 0.5);
    }
  }
}

TEST(PairStarts, are_none_for_a_region_longer_than_its_face) {
  Random random(8);
  const Pose truth = corner_view(random);
  SeenScan seen(test::image_of({{&learned_block(), truth}}));
  const PoolVector<RatedMatch> matches = true_matches(seen, truth);
  ASSERT_GE(matches.size(), 2U);
  DescribedRegion& region = seen.regions[static_cast<std::size_t>(matches[0].region)];
  for (Vector3d& corner : region.hull) corner = region.centroid + 2.0 * (corner - region.centroid);
  const ScanRegions scan = frame_regions(seen.regions);
  EXPECT_TRUE(pair_starts(database(), shapes(), scan, {matches[0], matches[1], 0.0}).empty());
}

// One face seen frontally, as far as a screen leaves it.
struct FaceView {
  Pose truth;
  SeenScan seen;
  int face;

  FaceView(int shown, double turn, double hidden_share)
      : truth(frontal(shown, turn)), seen(screened(truth, hidden_share)), face(shown) {}

  static Pose frontal(int shown, double turn) {
    const Vector3d normal = learned_block().faces[static_cast<std::size_t>(shown)].normal;
    Pose pose;
    const Eigen::Matrix3d facing = Eigen::Quaterniond::FromTwoVectors(normal, -Vector3d::UnitZ()).toRotationMatrix();
    pose.rotation = rotation_from_vector({0, 0, turn}) * facing;
    pose.translation = {0, 0, 900};
    return pose;
  }
  static RangeImage screened(const Pose& pose, double hidden_share) {
    const PinholeCamera camera;
    RangeImage image = test::image_of({{&learned_block(), pose}}, camera);
    int first = camera.columns;
    int last = 0;
    for (int cell = 0; cell < image.size(); ++cell) {
      if (!image.valid(cell)) continue;
      first = std::min(first, cell % camera.columns);
      last = std::max(last, cell % camera.columns);
    }
    const double limit = hidden_share > 0.0 ? first + hidden_share * (last - first) : -1.0;
    for (int cell = 0; cell < image.size(); ++cell) {
      if (cell % camera.columns >= limit) continue;
      image[cell] = (700.0 * camera.ray(cell / camera.columns, cell % camera.columns)).cast<float>();
    }
    return image;
  }
  [[nodiscard]] PoolVector<Pose> starts(bool cut, int as_face) const {
    const ScanRegions scan = frame_regions(seen.regions);
    for (std::size_t r = 0; r < seen.regions.size(); ++r) {
      if (test::face_shown(learned_block(), truth, seen.regions[r]) != face) continue;
      return single_starts(database(), shapes(), scan, {static_cast<int>(r), 0, as_face, 0.0}, cut);
    }
    ADD_FAILURE() << "the face is not seen";
    return {};
  }
  [[nodiscard]] PoolVector<Pose> starts(bool cut) const { return starts(cut, face); }
};

TEST(SingleStarts, hold_the_true_pose_for_a_whole_face) {
  for (int face = 0; face < 6; ++face) {
    for (const double turn : {0.0, 0.4, 1.1, 2.5}) {
      const FaceView view(face, turn, 0.0);
      EXPECT_LT(nearest_start(view.starts(false), view.truth), 6.0) << face << " " << turn;
    }
  }
}

// A rectangular face whose one end is hidden, upright in the image.
TEST(SingleStarts, hold_the_true_pose_for_a_cut_face) {
  for (const int face : {0, 2, 4}) {
    for (const double share : {0.3, 0.5}) {
      const FaceView view(face, 0.0, share);
      EXPECT_LT(nearest_start(view.starts(true), view.truth), 6.0) << face << " " << share;
    }
  }
}

TEST(SingleStarts, lay_the_face_on_the_plane_of_the_region) {
  for (const bool cut : {false, true}) {
    const FaceView view(2, 0.3, cut ? 0.4 : 0.0);
    const ModelFace& face = learned_block().faces[2];
    const PoolVector<Pose> starts = view.starts(cut);
    ASSERT_FALSE(starts.empty());
    for (const Pose& start : starts) {
      EXPECT_GT((view.truth.rotation * face.normal).dot(start.rotation * face.normal), 0.999);
      EXPECT_NEAR((start * face.centroid).z(), (view.truth * face.centroid).z(), 0.5);
    }
  }
}

TEST(SingleStarts, are_none_for_a_cut_region_larger_than_the_face) {
  const FaceView view(4, 0.0, 0.1);  // 70 x 50 mm, a tenth hidden
  EXPECT_FALSE(view.starts(true).empty());
  for (const int smaller : {0, 2, 6}) EXPECT_TRUE(view.starts(true, smaller).empty()) << smaller;
}

// A corner and its mirror image have the same angles between their planes: the triple product alone tells them apart.
TEST(SameHanded, tells_a_corner_from_its_mirror_image) {
  Random random(12);
  int told = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d a = random.direction();
    const Vector3d b = random.direction();
    const Vector3d c = random.direction();
    const Eigen::Matrix3d turn = random.rotation();
    const Eigen::Matrix3d mirror = turn * Eigen::DiagonalMatrix<double, 3>(-1.0, 1.0, 1.0);
    const double corner = a.cross(b).dot(c);
    const double turned = (turn * a).cross(turn * b).dot(turn * c);
    const double mirrored = (mirror * a).cross(mirror * b).dot(mirror * c);
    EXPECT_FALSE(same_handed(corner, mirrored));
    EXPECT_EQ(same_handed(corner, turned), std::min(std::abs(corner), std::abs(turned)) >= 0.1);
    told += same_handed(corner, turned) ? 1 : 0;
  }
  EXPECT_GT(told, 100);
  EXPECT_FALSE(same_handed(0.05, 0.9));
  EXPECT_FALSE(same_handed(-0.9, -0.05));
  EXPECT_TRUE(same_handed(-0.9, -0.2));
}

}  // namespace
}  // namespace foresight
