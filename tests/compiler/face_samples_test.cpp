#include "compiler/face_samples.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <set>

#include "common/viewing_sphere.h"
#include "compiler/sensor_file.h"
#include "tests/solids.h"

namespace foresight {
namespace {

DescribedRegion region_of(PoolVector<int> cells) {
  DescribedRegion described;
  described.region.cells = std::move(cells);
  return described;
}

// One label a cell: the face of object 0, or -1 for nothing.
std::vector<CellLabel> labels_of(const std::vector<int>& faces) {
  std::vector<CellLabel> labels;
  for (const int face : faces) labels.push_back({face < 0 ? -1 : 0, face});
  return labels;
}

std::vector<std::pair<int, int>> paired(const PoolVector<DescribedRegion>& regions, const std::vector<int>& faces,
                                        double smallest_share = 0.5) {
  std::vector<std::pair<int, int>> pairs;
  for (const RegionFace& pair : pair_regions_with_faces(regions, labels_of(faces), smallest_share)) {
    pairs.emplace_back(pair.region, pair.face);
  }
  return pairs;
}

using Pairs = std::vector<std::pair<int, int>>;

TEST(PairRegionsWithFaces, takes_the_face_most_cells_show) {
  const std::vector<int> faces = {4, 4, 4, 7, 7, 2, 2, 2, 2, 4};
  EXPECT_EQ(paired({region_of({0, 1, 2, 3}), region_of({4}), region_of({5, 6, 7, 8, 9})}, faces),
            (Pairs{{0, 4}, {1, 7}, {2, 2}}));
}

TEST(PairRegionsWithFaces, lets_two_regions_have_one_face) {
  EXPECT_EQ(paired({region_of({0, 1}), region_of({2, 3})}, {5, 5, 5, 5}), (Pairs{{0, 5}, {1, 5}}));
}

TEST(PairRegionsWithFaces, leaves_out_regions_without_a_majority) {
  const PoolVector<DescribedRegion> regions = {region_of({0, 1, 2, 3, 4}), region_of({5, 6})};
  const std::vector<int> faces = {1, 1, 2, 2, 3, 9, 9};
  EXPECT_EQ(paired(regions, faces), (Pairs{{1, 9}}));
  EXPECT_EQ(paired(regions, faces, 0.4), (Pairs{{0, 1}, {1, 9}}));
  EXPECT_EQ(paired({region_of({0, 1, 2, 3})}, {1, 1, 2, 3}), (Pairs{{0, 1}})) << "exactly half is enough";
}

TEST(PairRegionsWithFaces, pairs_no_face_with_what_shows_none) {
  EXPECT_EQ(paired({region_of({0, 1, 2}), region_of({3, 4})}, {-1, -1, 6, 6, 6}), (Pairs{{1, 6}}));
  EXPECT_TRUE(paired({}, {1, 2}).empty());
}

FaceSampleOptions views(int count, std::uint64_t seed = 1) { return {count, seed}; }

std::vector<ViewSample> samples_of(const CadModel& model, const FaceSampleOptions& options,
                                   const SensorModel& sensor = paper_sensor()) {
  return sample_views(model, sensor, segmentation_options_for(sensor), options);
}

SensorModel noisy_sensor() {
  SensorModel sensor = paper_sensor();
  sensor.depth_noise = 0.4;
  sensor.nearest_distance = 800.0;
  sensor.farthest_distance = 1000.0;
  return sensor;
}

void expect_same(const std::vector<ViewSample>& a, const std::vector<ViewSample>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t view = 0; view < a.size(); ++view) {
    ASSERT_EQ(a[view].faces.size(), b[view].faces.size());
    for (std::size_t i = 0; i < a[view].faces.size(); ++i) {
      EXPECT_EQ(a[view].faces[i].face, b[view].faces[i].face);
      EXPECT_EQ(a[view].faces[i].attributes, b[view].faces[i].attributes);
    }
    ASSERT_EQ(a[view].pairs.size(), b[view].pairs.size());
    for (std::size_t i = 0; i < a[view].pairs.size(); ++i) {
      EXPECT_EQ(a[view].pairs[i].first, b[view].pairs[i].first);
      EXPECT_EQ(a[view].pairs[i].second, b[view].pairs[i].second);
      EXPECT_EQ(a[view].pairs[i].relations, b[view].pairs[i].relations);
    }
  }
}

TEST(SampleViews, shows_one_to_three_faces_of_a_box_in_each_view) {
  const auto samples = samples_of(test::make_box(90, 70, 50), views(80));
  ASSERT_EQ(samples.size(), 80U);
  std::set<int> seen;
  for (const ViewSample& sample : samples) {
    std::set<int> faces;
    for (const auto& observation : sample.faces) faces.insert(observation.face);
    EXPECT_GE(faces.size(), 1U);
    EXPECT_LE(faces.size(), 3U);
    seen.insert(faces.begin(), faces.end());
  }
  EXPECT_EQ(seen.size(), 6U);
}

TEST(SampleViews, measures_attributes_no_larger_than_the_face) {
  const CadModel box = test::make_box(90, 70, 50);
  for (const ViewSample& sample : samples_of(box, views(20))) {
    for (const auto& [face, attributes] : sample.faces) {
      EXPECT_GT(attributes[kArea], 0.0);
      EXPECT_LT(attributes[kArea], 1.15 * box.faces[static_cast<std::size_t>(face)].area);
      EXPECT_GE(attributes[kMaxSecondMoment], attributes[kMinSecondMoment]);
      EXPECT_LT(attributes[kMaxDiameter], std::hypot(90, 70) + 5.0);
    }
  }
}

TEST(SampleViews, relates_each_two_faces_of_a_view_lower_number_first) {
  const CadModel box = test::make_box(90, 70, 50);
  std::size_t pairs = 0;
  std::size_t upright = 0;
  for (const ViewSample& sample : samples_of(box, views(80))) {
    std::set<int> faces;
    for (const auto& observation : sample.faces) faces.insert(observation.face);
    for (const auto& [first, second, relations] : sample.pairs) {
      EXPECT_LT(first, second);
      EXPECT_TRUE(faces.contains(first) && faces.contains(second));
      // Sides of a box that are seen together meet at a right angle; few cells of a sliver tell its normal roughly.
      EXPECT_NEAR(relations[kOrientation], std::numbers::pi / 2.0, 0.5);
      upright += std::abs(relations[kOrientation] - std::numbers::pi / 2.0) < 0.05 ? 1 : 0;
      EXPECT_LE(relations[kMaxDistance], box.diameter() + 5.0);
    }
    if (sample.faces.size() == faces.size()) {
      EXPECT_EQ(sample.pairs.size(), faces.size() * (faces.size() - 1) / 2);
    }
    pairs += sample.pairs.size();
  }
  EXPECT_GT(pairs, 80U);
  EXPECT_GT(static_cast<double>(upright), 0.9 * static_cast<double>(pairs));
}

TEST(SampleViews, is_the_same_at_any_number_of_threads) {
  std::vector<std::vector<ViewSample>> results;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(samples_of(test::make_step(), views(20), noisy_sensor()));
  }
  expect_same(results[0], results[1]);
  expect_same(results[0], results[2]);
}

TEST(SampleDirections, from_the_viewing_sphere_are_the_sample_views) {
  const ViewingSphere sphere(20);
  std::vector<Eigen::Vector3d> directions;
  for (int cell = 0; cell < sphere.size(); ++cell) directions.push_back(sphere.centre(cell));
  const SensorModel sensor = noisy_sensor();
  const CadModel step = test::make_step();
  expect_same(sample_directions(step, sensor, segmentation_options_for(sensor), directions, 3),
              sample_views(step, sensor, segmentation_options_for(sensor), views(20, 3)));
}

TEST(SampleDirections, look_at_the_face_that_points_to_the_sensor) {
  const SensorModel sensor = paper_sensor();
  const std::vector<Eigen::Vector3d> directions = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}};
  const auto samples =
      sample_directions(test::make_box(90, 70, 50), sensor, segmentation_options_for(sensor), directions, 1);
  ASSERT_EQ(samples.size(), 3U);
  const std::vector<int> faces = {1, 0, 3};  // top, bottom, right
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(samples[i].faces.size(), 1U) << i;
    EXPECT_EQ(samples[i].faces[0].face, faces[i]);
  }
}

TEST(SampleViews, depends_on_the_seed) {
  const auto first = samples_of(test::make_step(), views(20, 1), noisy_sensor());
  const auto second = samples_of(test::make_step(), views(20, 2), noisy_sensor());
  bool differs = false;
  for (std::size_t i = 0; i < first.size(); ++i) {
    differs = differs || first[i].faces.empty() || second[i].faces.empty() ||
              first[i].faces[0].attributes != second[i].faces[0].attributes;
  }
  EXPECT_TRUE(differs);
}

TEST(SampleViews, reports_every_view_once) {
  const SensorModel sensor = paper_sensor();
  std::atomic<int> calls = 0;
  std::atomic<int> sum = 0;
  (void)sample_views(test::make_box(60, 60, 60), sensor, segmentation_options_for(sensor), views(20), [&](int done) {
    ++calls;
    sum += done;
  });
  EXPECT_EQ(calls, 20);
  EXPECT_EQ(sum, 20 * 21 / 2);
}

// Face f is seen in views 0 ... f, face 0 twice in its view; with each pair.
std::vector<ViewSample> stairs(int faces) {
  std::vector<ViewSample> views(static_cast<std::size_t>(faces));
  for (int view = 0; view < faces; ++view) {
    ViewSample& sample = views[static_cast<std::size_t>(view)];
    for (int face = view; face < faces; ++face) {
      sample.faces.push_back({face, {}});
      for (int other = face + 1; other < faces; ++other) sample.pairs.push_back({face, other, {}});
    }
  }
  views.front().faces.push_back({0, {}});
  return views;
}

TEST(FacesFoundMost, stay_with_the_pairs_of_two_of_them) {
  std::vector<ViewSample> views = stairs(5);
  keep_faces_found_most(views, 2);
  std::set<int> faces;
  for (const ViewSample& view : views) {
    for (const auto& seen : view.faces) faces.insert(seen.face);
    for (const auto& seen : view.pairs) EXPECT_EQ(std::pair(seen.first, seen.second), std::pair(3, 4));
  }
  EXPECT_EQ(faces, (std::set<int>{3, 4}));
  EXPECT_EQ(views[3].pairs.size(), 1U);
}

TEST(FacesFoundMost, are_all_where_there_are_no_more) {
  std::vector<ViewSample> views = stairs(5);
  keep_faces_found_most(views, 5);
  for (std::size_t view = 0; view < views.size(); ++view) {
    EXPECT_EQ(views[view].faces.size(), stairs(5)[view].faces.size());
    EXPECT_EQ(views[view].pairs.size(), stairs(5)[view].pairs.size());
  }
}

TEST(FacesFoundMost, are_the_first_of_equals) {
  std::vector<ViewSample> views(1);
  for (int face = 4; face >= 0; --face) views[0].faces.push_back({face, {}});
  keep_faces_found_most(views, 2);
  ASSERT_EQ(views[0].faces.size(), 2U);
  EXPECT_EQ(views[0].faces[0].face, 1);
  EXPECT_EQ(views[0].faces[1].face, 0);
}

}  // namespace
}  // namespace foresight
