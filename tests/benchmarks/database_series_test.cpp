#include "benchmarks/database_series.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "benchmarks/random_solids.h"
#include "common/errors.h"
#include "tests/solids.h"
#include "tests/support.h"

namespace foresight {
namespace {

// One small CAD file of its own, so that little has to be compiled.
ExperimentOptions options_in(const test::TemporaryFolder& folder) {
  ExperimentOptions options;
  options.cad_files = {folder.file("box.obj")};
  test::write_obj(options.cad_files.front(), test::make_box(60, 80, 100));
  options.output = folder.file("results");
  options.progress = "none";
  options.seed = 4;
  return options;
}

// Few views: what the models are is tested elsewhere.
CompileOptions few_views() {
  CompileOptions compile;
  compile.samples.views = 20;
  return compile;
}

TEST(DatabaseSeries, has_the_objects_first_then_random_solids) {
  const test::TemporaryFolder folder;
  const ModelSeries series = compile_series(options_in(folder), sensor_of(""), 3, few_views());
  ASSERT_EQ(series.models.size(), 3U);
  EXPECT_EQ(series.objects, 1);
  EXPECT_EQ(series.models[0].name, "box");
  EXPECT_EQ(series.models[1].name, "solid_0000");
  EXPECT_EQ(series.models[2].name, "solid_0001");
  EXPECT_EQ(series.cads[2].vertices, random_solid(4, 1).vertices);
  EXPECT_EQ(first_models(series, 2).models().size(), 2U);
  EXPECT_EQ(only_model(series, 1).models().front().name, "solid_0000");
}

TEST(DatabaseSeries, keeps_what_it_compiled_and_reads_it_the_next_time) {
  const test::TemporaryFolder folder;
  const ExperimentOptions options = options_in(folder);
  const ModelSeries first = compile_series(options, sensor_of(""), 1, few_views());
  const auto kept = std::filesystem::directory_iterator(options.output + "/databases")->path();
  const auto written = std::filesystem::last_write_time(kept);
  const ModelSeries second = compile_series(options, sensor_of(""), 1, few_views());
  EXPECT_EQ(std::filesystem::last_write_time(kept), written);
  EXPECT_EQ(first.models[0].faces[0].densities[0].mass, second.models[0].faces[0].densities[0].mass);

  CompileOptions other = few_views();
  other.samples.seed = 9;
  (void)compile_series(options, sensor_of(""), 1, other);
  const std::filesystem::directory_iterator files(options.output + "/databases");
  EXPECT_EQ(std::distance(begin(files), end(files)), 2) << "other settings share a file";

  std::ofstream(kept) << "rubbish";
  EXPECT_THROW((void)compile_series(options, sensor_of(""), 1, few_views()), DatabaseError);
}

TEST(DatabaseSeries, refuses_sizes_that_leave_objects_out) {
  EXPECT_NO_THROW(check_database_sizes({1, 8, 32}, 8));
  EXPECT_THROW(check_database_sizes({1, 5}, 8), UsageError);
}

}  // namespace
}  // namespace foresight
