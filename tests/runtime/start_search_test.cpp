#include "runtime/start_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "runtime/pose_check.h"
#include "tests/runtime/learned_database.h"

namespace foresight {
namespace {

using Eigen::Vector3d;
using test::learned_block;
using test::learned_box;
using test::SeenScan;

// Models 0 and 1 are the block and its mirror image, model 2 is the box.
const Database& database() {
  static const Database loaded = [] {
    CompiledModel mirror = test::mirrored(learned_block());
    test::learn(mirror);
    return test::database_of({learned_block(), mirror, learned_box()});
  }();
  return loaded;
}
const CompiledModel& model(int index) { return database().models()[static_cast<std::size_t>(index)]; }

struct Found {
  PoolVector<StartPose> starts;
  StartSearchCounts counts;
};

Found find(const Database& objects, const SeenScan& seen, const StartSearchOptions& options = {}) {
  Found found;
  found.starts = find_starts(objects, seen.labelled(), options, found.counts);
  return found;
}

// A view of three or more faces with a hundred cells each; of the block and its mirror image with the cut corner among
// them, which alone tells one from the other.
Pose open_view(const CompiledModel& object, std::uint64_t index, const Vector3d& shift = {0, 0, 0}) {
  Random random(21, index);
  while (true) {
    Pose pose = test::random_pose(object, random);
    pose.translation += shift;
    const SeenScan seen(test::image_of({{&object, pose}}));
    int large = 0;
    bool cut_corner = object.faces.size() < 7;
    for (const DescribedRegion& region : seen.regions) {
      if (region.region.cells.size() < 100) continue;
      ++large;
      cut_corner = cut_corner || test::face_shown(object, pose, region) == 6;
    }
    if (large >= 3 && cut_corner) return pose;
  }
}

double turn_between(const Pose& a, const Pose& b) { return rotation_angle(a.rotation.transpose() * b.rotation); }
double distance_between(const CompiledModel& object, const Pose& a, const Pose& b) {
  return (a * object.centre - b * object.centre).norm();
}
bool is_near(const StartPose& start, int index, const Pose& truth) {
  return start.model == index && distance_between(model(index), start.T_sensor_model, truth) < 5.0 &&
         turn_between(start.T_sensor_model, truth) < 0.09;
}

TEST(StartSearch, the_best_start_of_an_object_alone_is_near_its_pose) {
  for (std::uint64_t index = 0; index < 12; ++index) {
    const Pose truth = open_view(model(0), index);
    const SeenScan seen(test::image_of({{&model(0), truth}}));
    const Found found = find(database(), seen);
    ASSERT_FALSE(found.starts.empty());
    EXPECT_TRUE(is_near(found.starts.front(), 0, truth)) << index << ": model " << found.starts.front().model;
    EXPECT_GT(found.starts.front().quality, 0.7);
  }
}

// One face may fit the mirror image as well; which of them it is, the evidence of every cell decides later.
TEST(StartSearch, the_object_looks_about_as_well_as_its_mirror_image_at_best) {
  for (std::uint64_t index = 0; index < 8; ++index) {
    const Pose truth = open_view(model(1), 100 + index);
    const SeenScan seen(test::image_of({{&model(1), truth}}));
    const Found found = find(database(), seen);
    ASSERT_FALSE(found.starts.empty());
    const auto right = std::find_if(found.starts.begin(), found.starts.end(),
                                    [&](const StartPose& start) { return is_near(start, 1, truth); });
    ASSERT_NE(right, found.starts.end()) << index;
    EXPECT_GE(right->quality, 0.9 * found.starts.front().quality) << index;
  }
}

// The sign of the triple product of three normals is that of the faces matched: with the wrong hand, no turn would
// bring a face of the model to each of them. A start that was settled on other planes may leave one region.
TEST(StartSearch, starts_of_three_regions_have_a_face_for_each_of_them) {
  int regions = 0;
  int faced = 0;
  for (std::uint64_t index = 0; index < 12; ++index) {
    const SeenScan seen(test::image_of({{&model(0), open_view(model(0), index)}}));
    for (const StartPose& start : find(database(), seen).starts) {
      if (start.regions.size() < 3 || start.quality < 0.5) continue;
      for (const int region : start.regions) {
        const Vector3d normal = seen.regions[static_cast<std::size_t>(region)].region.normal;
        const auto& faces = model(start.model).faces;
        ++regions;
        faced += std::any_of(faces.begin(), faces.end(),
                             [&](const ModelFace& face) {
                               return normal.dot(start.T_sensor_model.rotation * face.normal) > 0.96;
                             })
                     ? 1
                     : 0;
      }
    }
  }
  EXPECT_GT(regions, 6);
  EXPECT_GE(faced, 0.8 * regions);
}

const SeenScan& scene_of_two() {
  static const SeenScan seen(test::image_of(
      {{&model(0), open_view(model(0), 3, {-60, 0, 0})}, {&model(2), open_view(model(2), 4, {50, 10, 60})}}));
  return seen;
}

TEST(StartSearch, finds_starts_of_all_objects_of_a_scene) {
  const Found found = find(database(), scene_of_two());
  for (const int index : {0, 2}) {
    const auto first = std::find_if(found.starts.begin(), found.starts.end(),
                                    [&](const StartPose& start) { return start.model == index; });
    ASSERT_NE(first, found.starts.end()) << index;
    EXPECT_GT(first->quality, 0.7) << index;
  }
  EXPECT_TRUE(is_near(
      *std::find_if(found.starts.begin(), found.starts.end(), [](const StartPose& start) { return start.model == 0; }),
      0, open_view(model(0), 3, {-60, 0, 0})));
}

TEST(StartSearch, gives_starts_that_look_best_first) {
  const LabelledScan scan = scene_of_two().labelled();
  PoseChecker checker(database(), scan);
  const Found found = find(database(), scene_of_two());
  ASSERT_GT(found.starts.size(), 10U);
  double last = 1.0;
  for (const StartPose& start : found.starts) {
    EXPECT_LE(start.quality, last);
    EXPECT_GT(start.quality, 0.0);
    EXPECT_NEAR(start.quality, checker.check(start.model, start.T_sensor_model).quality(), 1e-9);
    EXPECT_TRUE(is_rotation(start.T_sensor_model.rotation, 1e-6));
    last = start.quality;
  }
}

TEST(StartSearch, names_the_regions_that_were_matched) {
  const int count = static_cast<int>(scene_of_two().regions.size());
  std::set<std::size_t> sizes;
  for (const StartPose& start : find(database(), scene_of_two()).starts) {
    const std::set<int> regions(start.regions.begin(), start.regions.end());
    EXPECT_EQ(regions.size(), start.regions.size());
    EXPECT_GE(*regions.begin(), 0);
    EXPECT_LT(*regions.rbegin(), count);
    sizes.insert(start.regions.size());
  }
  EXPECT_EQ(sizes, (std::set<std::size_t>{1, 2, 3}));
}

// Starts that settled together are one. A better one takes the place of a worse one and may so come nearer to a third:
// those are few.
TEST(StartSearch, keeps_one_of_starts_that_are_the_same) {
  const StartSearchOptions options;
  const auto same = [&](const StartPose& a, const StartPose& b) {
    return a.model == b.model &&
           distance_between(model(a.model), a.T_sensor_model, b.T_sensor_model) < options.same_distance &&
           turn_between(a.T_sensor_model, b.T_sensor_model) < options.same_angle;
  };
  const Found found = find(database(), scene_of_two());
  std::size_t doubled = 0;
  for (std::size_t i = 0; i < found.starts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) doubled += same(found.starts[i], found.starts[j]) ? 1 : 0;
  }
  EXPECT_LE(doubled, found.starts.size() / 20);
  StartSearchOptions wider;
  wider.same_distance = 40.0;
  wider.same_angle = 0.5;
  EXPECT_LT(find(database(), scene_of_two(), wider).starts.size(), found.starts.size());
}

TEST(StartSearch, counts_what_it_does) {
  const Found found = find(database(), scene_of_two());
  EXPECT_GT(found.counts.matches, 0);
  EXPECT_GT(found.counts.hypotheses, found.counts.matches);  // each match is a hypothesis of its own
  EXPECT_GT(found.counts.checks, found.counts.hypotheses / 2);
  EXPECT_LE(static_cast<long>(found.starts.size()), found.counts.hypotheses);
  StartSearchOptions fewer;
  fewer.most_pairs = 10;
  EXPECT_EQ(find(database(), scene_of_two(), fewer).counts.hypotheses, found.counts.matches + 10);
  StartSearchOptions single;
  single.most_pairs = 0;
  const Found singles = find(database(), scene_of_two(), single);
  EXPECT_EQ(singles.counts.hypotheses, found.counts.matches);
  for (const StartPose& start : singles.starts) EXPECT_EQ(start.regions.size(), 1U);
  StartSearchOptions pairs;
  pairs.most_thirds = 0;
  for (const StartPose& start : find(database(), scene_of_two(), pairs).starts) EXPECT_LE(start.regions.size(), 2U);
  StartSearchOptions best;
  best.least_rating = 1e6;
  EXPECT_EQ(find(database(), scene_of_two(), best).counts.hypotheses, found.counts.matches);
}

TEST(StartSearch, says_the_same_twice) {
  const Found first = find(database(), scene_of_two());
  const Found second = find(database(), scene_of_two());
  ASSERT_EQ(first.starts.size(), second.starts.size());
  EXPECT_EQ(first.counts.checks, second.counts.checks);
  for (std::size_t i = 0; i < first.starts.size(); ++i) {
    EXPECT_EQ(first.starts[i].model, second.starts[i].model);
    EXPECT_EQ(first.starts[i].T_sensor_model.rotation, second.starts[i].T_sensor_model.rotation);
    EXPECT_EQ(first.starts[i].T_sensor_model.translation, second.starts[i].T_sensor_model.translation);
    EXPECT_EQ(first.starts[i].quality, second.starts[i].quality);
    EXPECT_EQ(first.starts[i].regions, second.starts[i].regions);
  }
}

TEST(StartSearch, finds_the_same_in_one_stretch_or_many) {
  const LabelledScan scan = scene_of_two().labelled();
  StartSearchCounts counts;
  StartSearch search(database(), scan, {}, counts);
  int stretches = 1;
  long looked_at = 0;
  while (search.look_further(50)) {
    ++stretches;
    EXPECT_EQ(counts.hypotheses, looked_at + 50);
    looked_at = counts.hypotheses;
  }
  EXPECT_GT(stretches, 3);
  const Found at_once = find(database(), scene_of_two());
  EXPECT_EQ(counts.hypotheses, at_once.counts.hypotheses);
  EXPECT_EQ(counts.checks, at_once.counts.checks);
  EXPECT_EQ(search.starts().size(), at_once.starts.size());
}

TEST(StartSearch, what_is_taken_on_the_way_takes_no_part_in_the_rest) {
  LabelledScan scan = scene_of_two().labelled();
  StartSearchCounts counts;
  StartSearch search(database(), scan, {}, counts);
  ASSERT_TRUE(search.look_further(10));
  const std::size_t before = search.starts().size();
  const int taken = search.starts()[0].regions[0];
  for (const int cell : scan.regions[static_cast<std::size_t>(taken)].region.cells) take(scan, cell);
  const PoolVector<StartPose> known = search.starts();
  while (search.look_further(1000)) {
  }
  ASSERT_GT(search.starts().size(), before);
  for (std::size_t i = 0; i < search.starts().size(); ++i) {
    const PoolVector<int>& regions = search.starts()[i].regions;
    if (i < before && regions == known[i].regions) continue;
    EXPECT_EQ(std::count(regions.begin(), regions.end(), taken), 0);
  }
  EXPECT_LT(counts.hypotheses, find(database(), scene_of_two()).counts.hypotheses);
}

TEST(StartSearch, rivals_are_all_that_may_explain_the_same_regions) {
  const Pose truth = open_view(model(0), 3);
  const SeenScan seen(test::image_of({{&model(0), truth}}));
  const LabelledScan scan = seen.labelled();
  StartSearchCounts counts;
  StartSearch search(database(), scan, {}, counts);
  search.look_for_rivals(0, 1);
  ASSERT_FALSE(search.starts().empty());
  std::set<int> models;
  for (const StartPose& start : search.starts()) {
    models.insert(start.model);
    EXPECT_TRUE(std::count(start.regions.begin(), start.regions.end(), 0) > 0);
  }
  EXPECT_GE(models.size(), 2U);
  const long hypotheses = counts.hypotheses;
  search.look_for_rivals(0, 1);
  EXPECT_EQ(counts.hypotheses, hypotheses) << "looked for twice";
  search.look_for_rivals(1, -1);
  EXPECT_GT(counts.hypotheses, hypotheses);
}

TEST(StartSearch, without_pruning_it_looks_at_more_and_misses_nothing) {
  StartSearchOptions all;
  all.pruned = false;
  const Found pruned = find(database(), scene_of_two());
  const Found every = find(database(), scene_of_two(), all);
  EXPECT_GT(every.counts.matches, pruned.counts.matches);
  EXPECT_GT(every.counts.hypotheses, 2 * pruned.counts.hypotheses);
  EXPECT_GE(every.starts.front().quality, pruned.starts.front().quality);
}

TEST(StartSearch, where_all_is_taken_there_is_no_start) {
  LabelledScan scan = scene_of_two().labelled();
  for (int cell = 0; cell < scan.image.size(); ++cell) take(scan, cell);
  StartSearchCounts counts;
  EXPECT_TRUE(find_starts(database(), scan, {}, counts).empty());
  EXPECT_GT(counts.matches, 0);
}

TEST(StartSearch, finds_nothing_where_nothing_is_seen) {
  const SeenScan nothing(RangeImage(240, 256));
  const Found found = find(database(), nothing);
  EXPECT_TRUE(found.starts.empty());
  EXPECT_EQ(found.counts.matches, 0);
  EXPECT_EQ(found.counts.hypotheses, 0);
  EXPECT_EQ(found.counts.checks, 0);
}

}  // namespace
}  // namespace foresight
