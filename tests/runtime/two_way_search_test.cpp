#include "runtime/two_way_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "runtime/pose_evidence.h"
#include "tests/images.h"
#include "tests/runtime/compiled_objects.h"

namespace foresight {
namespace {

using test::compiled_objects;
using test::pose_of;
using test::visible_scene;

const PinholeCamera& camera() { return compiled_objects().content().sensor.camera; }

RecognitionResult recognize_in(const RangeImage& image, const RecognizeOptions& options = {}) {
  return recognize(image, camera(), compiled_objects(), options);
}

const CompiledModel& model_of(const std::string& object) {
  const auto& models = compiled_objects().models();
  return *std::find_if(models.begin(), models.end(), [&](const CompiledModel& m) { return m.name == object; });
}

bool is_right(const Detection& detection, const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& object) {
    const CompiledModel& model = compiled_objects().models()[static_cast<std::size_t>(object.model)];
    return detection.object == model.name &&
           test::surface_distance(model, pose_of(detection), object.T_sensor_model) < 5.0;
  });
}

void expect_same_detections(const RecognitionResult& a, const RecognitionResult& b) {
  ASSERT_EQ(a.detections.size(), b.detections.size());
  for (std::size_t i = 0; i < a.detections.size(); ++i) {
    EXPECT_EQ(a.detections[i].object, b.detections[i].object);
    EXPECT_EQ(a.detections[i].T_sensor_model, b.detections[i].T_sensor_model);
    EXPECT_EQ(a.detections[i].score, b.detections[i].score);
    EXPECT_EQ(a.detections[i].rank, b.detections[i].rank);
    EXPECT_EQ(a.detections[i].regions, b.detections[i].regions);
  }
}

TEST(TwoWaySearch, finds_objects_and_nothing_else) {
  int found = 0;
  int there = 0;
  for (std::uint64_t index = 0; index < 6; ++index) {
    const Scene scene = visible_scene(1 + static_cast<int>(index % 2), index);
    for (const Detection& detection : recognize_in(scene.scan.image).detections) {
      EXPECT_TRUE(is_right(detection, scene)) << "scene " << index << ": " << detection.object;
      found += is_right(detection, scene) ? 1 : 0;
    }
    there += static_cast<int>(scene.objects.size());
  }
  EXPECT_EQ(found, there);
}

TEST(TwoWaySearch, scores_are_the_probabilities_of_the_poses) {
  const Scene scene = visible_scene(2, 1);
  const auto regions = extract_regions(scene.scan.image, camera(), compiled_objects().content().segmentation);
  const LabelledScan scan = label_scan(scene.scan.image, camera(), compiled_objects().content().sensor, regions);
  const RecognitionResult result = recognize_in(scene.scan.image);
  ASSERT_FALSE(result.detections.empty());
  for (const Detection& detection : result.detections) {
    EXPECT_GT(detection.score, 0.5);
    EXPECT_LE(detection.score, 1.0);
  }
  // No region was taken yet when the first one was judged.
  const Detection& first = result.detections[0];
  const CompiledModel& model = model_of(first.object);
  EXPECT_DOUBLE_EQ(first.score, probability_right(model.acceptance, gather_evidence(model, pose_of(first), scan)));
}

TEST(TwoWaySearch, refines_fewer_hypotheses_than_it_looks_at) {
  const Statistics s = recognize_in(visible_scene(2, 2).scan.image).statistics;
  EXPECT_GT(s.verifications, 0);
  EXPECT_LE(s.verifications, s.pose_checks);
  EXPECT_LE(s.pose_checks, s.hypotheses);
}

TEST(TwoWaySearch, says_the_same_twice) {
  const Scene scene = visible_scene(2, 3);
  const RecognitionResult first = recognize_in(scene.scan.image);
  const RecognitionResult second = recognize_in(scene.scan.image);
  expect_same_detections(first, second);
  EXPECT_EQ(first.statistics.pose_checks, second.statistics.pose_checks);
  EXPECT_EQ(first.statistics.energy_evaluations, second.statistics.energy_evaluations);
}

TEST(TwoWaySearch, does_not_ask_for_the_papers_fractions) {
  const Scene scene = visible_scene(1, 1);
  RecognizeOptions strict;
  strict.smallest_matched = strict.smallest_coherent = 1.0;
  strict.largest_occluding = 0.0;
  expect_same_detections(recognize_in(scene.scan.image, strict), recognize_in(scene.scan.image));
  strict.method = Method::paper;
  EXPECT_TRUE(recognize_in(scene.scan.image, strict).detections.empty());
}

TEST(TwoWaySearch, the_papers_method_scores_by_the_matched_fraction) {
  RecognizeOptions paper;
  paper.method = Method::paper;
  const Scene scene = visible_scene(1, 1);
  const RecognitionResult result = recognize_in(scene.scan.image, paper);
  ASSERT_FALSE(result.detections.empty());
  EXPECT_TRUE(is_right(result.detections[0], scene));
  for (const Detection& detection : result.detections) EXPECT_EQ(detection.score, detection.matched);
  EXPECT_EQ(result.statistics.pose_checks, 0);
}

TEST(TwoWaySearch, stops_at_its_limits) {
  const RangeImage image = visible_scene(2, 0).scan.image;
  RecognizeOptions options;
  options.most_detections = 1;
  EXPECT_EQ(recognize_in(image, options).detections.size(), 1U);
  options.most_detections = 0;
  options.most_verifications = 1;
  EXPECT_EQ(recognize_in(image, options).statistics.verifications, 1);
  EXPECT_LE(recognize_in(image, options).detections.size(), 1U);
}

// The usual database with another judge.
Database judged_by(const AcceptanceModel& judge) {
  CompiledDatabase content = compiled_objects().content();
  for (CompiledModel& model : content.models) model.acceptance = judge;
  return Database(std::move(content));
}

RecognitionResult recognize_by(const AcceptanceModel& judge, const RangeImage& image,
                               const RecognizeOptions& options = {}) {
  return recognize(image, camera(), judged_by(judge), options);
}

// Judges that look at nothing. Half of a start must be explained, to save time.
AcceptanceModel refusing(double least_overlap = 0.5) { return {{}, -1.0, least_overlap, 1}; }
AcceptanceModel hesitating() { return {{}, 1.0, 0.5, 1}; }  // everything is probable, nothing sure
AcceptanceModel trusting() { return {{}, 10.0, 0.5, 1}; }   // everything is sure

TEST(TwoWaySearch, finds_nothing_that_its_acceptance_models_hold_improbable) {
  const RangeImage image = visible_scene(2, 0).scan.image;
  EXPECT_TRUE(recognize_by(refusing(), image).detections.empty());
  EXPECT_FALSE(recognize_by(hesitating(), image).detections.empty());
  EXPECT_FALSE(recognize_by(trusting(), image).detections.empty());
}

TEST(TwoWaySearch, no_two_detections_rest_on_one_region) {
  for (const AcceptanceModel& judge : {compiled_objects().models()[0].acceptance, hesitating(), trusting()}) {
    for (std::uint64_t index = 0; index < 3; ++index) {
      std::set<int> regions;
      for (const Detection& detection : recognize_by(judge, visible_scene(2, index).scan.image).detections) {
        for (const int region : detection.regions) EXPECT_TRUE(regions.insert(region).second) << region;
      }
    }
  }
}

TEST(TwoWaySearch, stops_after_the_detections_asked_for_among_those_that_waited) {
  const RangeImage image = visible_scene(2, 0).scan.image;
  RecognizeOptions one;
  one.most_detections = 1;
  EXPECT_GT(recognize_by(hesitating(), image).detections.size(), 1U);
  EXPECT_EQ(recognize_by(hesitating(), image, one).detections.size(), 1U);
}

// A judge of contradiction alone, never sure: all poses wait until all are known.
TEST(TwoWaySearch, judges_what_waited_by_what_better_ones_left) {
  AcceptanceModel judge = hesitating();
  judge.weights[kContradictedShare] = -4.0;
  const Database database = judged_by(judge);
  for (std::uint64_t index = 0; index < 3; ++index) {
    const Scene scene = visible_scene(2, index);
    const auto regions = extract_regions(scene.scan.image, camera(), database.content().segmentation);
    LabelledScan scan = label_scan(scene.scan.image, camera(), database.content().sensor, regions);
    const RecognitionResult result = recognize(scene.scan.image, camera(), database, {});
    ASSERT_FALSE(result.detections.empty());
    for (const Detection& detection : result.detections) {
      const PoseEvidence found = gather_evidence(model_of(detection.object), pose_of(detection), scan);
      EXPECT_DOUBLE_EQ(detection.score, probability_right(judge, found));
      EXPECT_GE(detection.score, 0.5);
      for (const int region : detection.regions) scan.taken[static_cast<std::size_t>(region)] = true;
      for (std::size_t r = 0; r < regions.size(); ++r) {
        const bool most = 2 * static_cast<std::size_t>(found.explained_of_region[r]) >= regions[r].region.cells.size();
        if (most) scan.taken[r] = true;
      }
    }
  }
}

TEST(TwoWaySearch, looks_at_equal_poses_once) {
  const Statistics s = recognize_by(refusing(1.0), visible_scene(2, 0).scan.image).statistics;
  EXPECT_GT(s.pose_checks, 0);
  EXPECT_LT(s.pose_checks, s.hypotheses);
}

TEST(TwoWaySearch, refines_only_what_overlaps_enough) {
  const RangeImage image = visible_scene(2, 0).scan.image;
  const Statistics some = recognize_by(refusing(0.5), image).statistics;
  const Statistics few = recognize_by(refusing(0.9), image).statistics;
  EXPECT_LT(some.verifications, some.pose_checks);
  EXPECT_LT(few.verifications, some.verifications);
  EXPECT_EQ(recognize_by(refusing(1.0), image).statistics.verifications, 0);
}

TEST(TwoWaySearch, finds_nothing_in_an_unknown_box) {
  const Pose pose{rotation_from_vector({0.6, 0.5, 0.2}), {0, 0, 900}};
  std::vector<test::Rectangle> box;
  for (const test::Rectangle& side : test::box_sides({120, 70, 50})) box.push_back(test::moved(side, pose));
  EXPECT_TRUE(recognize_in(test::render(box, camera())).detections.empty());
}

}  // namespace
}  // namespace foresight
