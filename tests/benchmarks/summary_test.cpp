#include "benchmarks/summary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace foresight {
namespace {

// A scene of one object with the given verdict, visible fraction and count of verifications.
SceneRecord scene(Verdict verdict, bool named, double visible, long verifications) {
  SceneRecord record;
  record.truth = {{0, {Pose{}}, visible}};
  record.verdicts.truth = {verdict};
  record.verdicts.named = {named};
  record.statistics.verifications = verifications;
  if (named) {
    record.reported = {{0, Pose{}}};
    record.ranks = {2};
    record.scores = {0.95};
    record.verdicts.reported = {verdict == Verdict::missed ? Verdict::wrong_pose : verdict};
  }
  return record;
}

std::vector<SceneRecord> four_scenes() {
  return {scene(Verdict::right, true, 0.9, 1), scene(Verdict::indistinguishable, true, 0.6, 3),
          scene(Verdict::missed, true, 0.5, 5), scene(Verdict::missed, false, 0.2, 31)};
}

TEST(Summary, counts_objects_and_reports) {
  const SummaryRow row = summarize("all", four_scenes());
  EXPECT_EQ(row.objects, 4);
  EXPECT_EQ(row.named, 3);
  EXPECT_EQ(row.right, 1);
  EXPECT_EQ(row.indistinguishable, 1);
  EXPECT_EQ(row.reported, 3);
  EXPECT_EQ(row.wrong_poses, 1);
  EXPECT_EQ(row.false_positives, 0);
}

TEST(Summary, counts_declared_ambiguity_apart) {
  std::vector<SceneRecord> scenes = four_scenes();
  scenes.push_back(scene(Verdict::declared, true, 0.9, 1));
  const SummaryRow row = summarize("all", scenes);
  EXPECT_EQ(row.declared, 1);
  EXPECT_EQ(row.right, 1);
  EXPECT_EQ(row.indistinguishable, 1);
  EXPECT_EQ(row.wrong_poses, 1);
  EXPECT_EQ(row.false_positives, 0);
  const Table shares = declared_table({row}, 7);
  ASSERT_EQ(shares.rows.size(), 3U);
  EXPECT_EQ(shares.rows[1][5], "20.0");  // declared: one of five
  EXPECT_EQ(shares.rows[2][5], "40.0");  // right or declared
  const Table calibration = calibration_table(scenes);
  EXPECT_EQ(calibration.rows.front()[5], "50.0");  // a declared report is not right by itself
}

TEST(Summary, means_verifications_with_and_without_failed_scenes) {
  const SummaryRow row = summarize("all", four_scenes());
  EXPECT_DOUBLE_EQ(row.verifications, 10.0);
  EXPECT_DOUBLE_EQ(row.verifications_when_found, 3.0);
}

TEST(Summary, of_a_visible_range_counts_its_objects_only) {
  EXPECT_EQ(summarize("", four_scenes(), {0.5, 2.0}).objects, 3);
  EXPECT_EQ(summarize("", four_scenes(), {0.0, 0.5}).objects, 1);
  EXPECT_EQ(summarize("", four_scenes(), {0.6, 0.9}).objects, 1);
}

TEST(Summary, of_no_scene_has_no_means) {
  const SummaryRow row = summarize("none", {});
  EXPECT_EQ(row.objects, 0);
  EXPECT_TRUE(std::isnan(row.verifications));
  EXPECT_EQ(summary_table({row}, 1).rows.front().size(), summary_table({row}, 1).header.size());
}

TEST(Summary, holds_scores_against_what_is_right) {
  const Table table = calibration_table(four_scenes());
  ASSERT_EQ(table.rows.size(), 1U);  // all reports score 0.95
  EXPECT_EQ(table.rows.front()[3], "3");
  EXPECT_EQ(table.rows.front()[4], "0.950");
  EXPECT_EQ(table.rows.front()[5], "66.7");  // the wrong pose is not right, the indistinguishable one is
}

TEST(Table, rows_are_as_wide_as_the_header) {
  const std::vector<SceneRecord> scenes = four_scenes();
  const std::vector<SummaryRow> rows = {summarize("all", scenes)};
  for (const Table& table : {summary_table(rows, 7), short_table(rows), declared_table(rows, 7),
                             scene_table(scenes, {"box"}), calibration_table(scenes)}) {
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  }
  EXPECT_EQ(scene_table(scenes, {"box"}).rows.size(), 7U);
}

TEST(Table, quotes_what_csv_would_misread) {
  EXPECT_EQ(to_csv({{"a", "b"}, {{"", "1"}}}), "a,b\n,1\n");
  EXPECT_EQ(to_csv({{"a", "b"}, {{"x,y", "say \"1\""}}}), "a,b\n\"x,y\",\"say \"\"1\"\"\"\n");
}

TEST(Table, lines_up_its_columns) { EXPECT_EQ(to_text({{"set", "n"}, {{"a", "160"}}}), "set    n\na    160\n"); }

TEST(Table, writes_numbers_the_same_everywhere) {
  EXPECT_EQ(decimal(92.5, 1), "92.5");
  EXPECT_EQ(decimal(std::nan(""), 1), "-");
}

}  // namespace
}  // namespace foresight
