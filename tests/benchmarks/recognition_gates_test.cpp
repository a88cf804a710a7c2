// Regression gates: recognition on fixed scenes must not fall below what it once was. The lower end of the 95 %
// interval is held against the gate, not the mean, so that a gate that fails means something.
#include <gtest/gtest.h>

#include "benchmarks/intervals.h"
#include "benchmarks/series.h"
#include "tests/support.h"

namespace foresight {
namespace {

constexpr int kScenes = 80;

ExperimentOptions gate_options(const test::TemporaryFolder& folder) {
  ExperimentOptions options;
  options.output = folder.path();
  options.progress = "none";
  options.seed = 5;  // an exploration seed: tables are reported on others
  options.n = kScenes;
  options.jobs = 2;
  options.method.most_verifications = 20;
  return options;
}

TEST(RecognitionGates, single_objects_before_nothing) {
  const test::TemporaryFolder folder;
  const std::vector<SummaryRow> rows = run_single_object_series(gate_options(folder), "synthetic", "");
  ASSERT_EQ(rows.size(), 2U);
  for (const SummaryRow& row : rows) {
    const bool two_way = row.method == "two-way";
    ASSERT_EQ(row.objects, kScenes);
    EXPECT_GE(wilson_interval(row.right, row.objects).low, two_way ? 0.84 : 0.78)
        << row.method << ": " << row.right << " of " << row.objects << " right";
    EXPECT_LE(wilson_interval(row.false_positives, row.scenes).high, two_way ? 0.08 : 0.20)
        << row.method << ": " << row.false_positives << " false positives";
    EXPECT_LE(row.hypotheses, two_way ? 5000.0 : 1200.0);
    EXPECT_LE(row.verifications, 2.0);
  }
}

TEST(RecognitionGates, single_objects_on_a_table_with_noise_and_shadow) {
  const test::TemporaryFolder folder;
  ExperimentOptions options = gate_options(folder);
  options.n = 40;
  options.methods = {"two-way"};
  const SummaryRow row =
      run_single_object_series(options, "scanner", test::project_file("models/sensors/scanner.textproto")).front();
  EXPECT_GE(wilson_interval(row.right, row.objects).low, 0.72) << row.right << " of " << row.objects << " right";
}

}  // namespace
}  // namespace foresight
