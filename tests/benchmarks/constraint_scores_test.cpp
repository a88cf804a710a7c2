#include "benchmarks/constraint_scores.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compiler/sensor_file.h"
#include "tests/solids.h"
#include "tests/support.h"

namespace foresight {
namespace {

// One attribute whose samples lie in bins 1 (three of four) and 3 of width 10.
ConstraintSubject subject_of(const std::string& object, std::vector<double> held_out) {
  AttributeSamples attribute;
  attribute.name = "length";
  attribute.samples = {11.0, 12.0, 13.0, 35.0};
  attribute.held_out = std::move(held_out);
  attribute.density = estimate_density(attribute.samples, 0.0, 100.0, {10, 0.0});
  attribute.bin_width = 10.0;
  attribute.cad_value = 30.0;
  attribute.cad_sigma = 1.0;
  return {object, {0}, {attribute}};
}

TEST(ConstraintScores, count_true_and_false_samples_apart) {
  const std::vector<ConstraintSubject> subjects = {subject_of("a", {15.0, 25.0, 31.0}), subject_of("b", {12.0, 50.0})};
  const ConstraintTally sensor = score_subject(subjects, 0)[0][0];
  EXPECT_EQ(sensor.true_samples, 3);
  EXPECT_EQ(sensor.true_kept, 2) << "bin 2 is empty";
  EXPECT_EQ(sensor.false_samples, 2);
  EXPECT_EQ(sensor.false_kept, 1);
  EXPECT_NEAR(sensor.log_likelihood, std::log(0.75) + std::log(kLeastProbability) + std::log(0.25), 1e-6);
  const ConstraintTally at_most = score_subject(subjects, 0)[0][3];
  EXPECT_EQ(at_most.true_kept, 2) << "31 is more than the CAD value";
  EXPECT_EQ(at_most.false_kept, 1);
}

TEST(ConstraintScores, keep_jointly_what_every_attribute_keeps) {
  ConstraintSubject a = subject_of("a", {15.0, 15.0, 25.0});
  a.attributes.push_back(a.attributes[0]);
  a.attributes[1].held_out = {35.0, 55.0, 35.0};
  const std::vector<ConstraintTallies> scores = score_subject({a}, 0);
  ASSERT_EQ(scores.size(), 3u);
  EXPECT_EQ(scores[0][0].true_kept, 2);
  EXPECT_EQ(scores[1][0].true_kept, 2);
  EXPECT_EQ(scores[2][0].true_kept, 1);
  EXPECT_NEAR(scores[2][0].log_likelihood, scores[0][0].log_likelihood + scores[1][0].log_likelihood, 1e-9);
}

TEST(ConstraintScores, compare_faces_with_faces_and_pairs_with_pairs) {
  ConstraintSubject pair = subject_of("a", {15.0});
  pair.faces = {0, 1};
  EXPECT_EQ(score_subject({subject_of("a", {15.0}), pair}, 0)[0][0].false_samples, 0);
}

TEST(ConstraintScores, sum_the_subjects_up) {
  ConstraintResult result{"here", {subject_of("a", {15.0, 25.0}), subject_of("b", {12.0, 50.0})}, {}};
  for (std::size_t i = 0; i < 2; ++i) result.scores.push_back(score_subject(result.subjects, i));
  const Table summary = constraint_summary({result}, 7);
  ASSERT_EQ(summary.rows.size(), 2u * kConstraintCount) << "one attribute, and all together";
  for (const auto& row : summary.rows) ASSERT_EQ(row.size(), summary.header.size());
  EXPECT_EQ(summary.rows[0][3], "4");
  EXPECT_EQ(summary.rows[0][4], "50.00");
  const Table table = constraint_table({result}, 7);
  EXPECT_EQ(table.rows.size(), 4u * kConstraintCount);
  for (const auto& row : table.rows) ASSERT_EQ(row.size(), table.header.size());
}

// The whole way on one object: the sensor model keeps nearly all faces it was compiled for.
TEST(ConstraintSamples, of_held_out_views_are_like_those_of_the_viewing_sphere) {
  const SensorModel sensor = paper_sensor();
  const CadModel box = test::make_box(90, 60, 40);
  const auto samples = sample_views(box, sensor, segmentation_options_for(sensor), {80, 1});
  const auto held_out = random_views(box, sensor, 40, 1);
  ASSERT_EQ(held_out.size(), 40u);
  const std::vector<ConstraintSubject> subjects = subjects_of(box, samples, held_out, sensor);
  ASSERT_GE(subjects.size(), 6u);
  long kept = 0, all = 0;
  for (int face = 0; face < 6; ++face) {
    const ConstraintSubject& subject = subjects[static_cast<std::size_t>(face)];
    EXPECT_EQ(subject.faces, std::vector<int>{face}) << "faces come first, in order";
    const ConstraintTally tally = score_subject(subjects, static_cast<std::size_t>(face)).back()[0];
    kept += tally.true_kept;
    all += tally.true_samples;
  }
  EXPECT_GT(all, 60);
  EXPECT_GT(static_cast<double>(kept), 0.8 * static_cast<double>(all));
  EXPECT_EQ(subjects.back().faces.size(), 2u);
  EXPECT_EQ(subjects.back().attributes.size(), static_cast<std::size_t>(kRelationCount));
}

TEST(ConstraintSamples, depend_on_the_seed_alone) {
  const SensorModel sensor = paper_sensor();
  const CadModel box = test::make_box(90, 60, 40);
  const auto areas = [&](std::uint64_t seed) {
    std::vector<double> values;
    for (const ViewSample& view : random_views(box, sensor, 5, seed)) {
      for (const auto& [face, attributes] : view.faces) values.push_back(attributes[kArea]);
    }
    return values;
  };
  EXPECT_EQ(areas(3), areas(3));
  EXPECT_NE(areas(3), areas(4));
}

}  // namespace
}  // namespace foresight
