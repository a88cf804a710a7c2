#include "benchmarks/sensor_variants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "compiler/compile.h"
#include "compiler/sensor_file.h"
#include "compiler/statistics.h"
#include "tests/benchmarks/solids.h"

namespace foresight {
namespace {

constexpr FaceSampleOptions kFewViews{20, 1};

// A sensor that has all that can be taken away.
SensorModel full_sensor() {
  SensorModel sensor = paper_sensor();
  sensor.camera = {100, 100, 300.0, 300.0, 49.5, 49.5};
  sensor.depth_noise = 0.8;
  sensor.projector = Eigen::Vector3d(300, 0, 0);
  sensor.nearest_distance = 700;
  sensor.farthest_distance = 1100;
  sensor.largest_incidence = 1.2;
  return sensor;
}

const SensorModel& named(const std::vector<SensorVariant>& variants, const std::string& name) {
  return std::find_if(variants.begin(), variants.end(), [&](const auto& v) { return v.name == name; })->sensor;
}

// Faces with densities, but for the acceptance model, which takes long and plays no part.
CompiledDatabase compiled(const CadModel& cad, const SensorModel& sensor) {
  CompiledDatabase database = new_database(sensor, {});
  CompiledModel& model = database.models.emplace_back();
  model.name = cad.name;
  model.faces.resize(cad.faces.size());
  model.acceptance.samples = 7;
  model.surface.spacing = 3.0;
  estimate_statistics(sample_views(cad, sensor, database.segmentation, kFewViews), database.density, model);
  return database;
}

std::vector<float> masses(const CompiledDatabase& database) {
  std::vector<float> all;
  for (const ModelFace& face : database.models.front().faces) {
    all.push_back(static_cast<float>(face.views_found));
    for (const Density& density : face.densities) all.insert(all.end(), density.mass.begin(), density.mass.end());
  }
  return all;
}

TEST(SensorVariants, go_from_nothing_to_all_one_thing_at_a_time) {
  const SensorModel sensor = full_sensor();
  const std::vector<SensorVariant> variants = sensor_variants(sensor);
  ASSERT_EQ(variants.size(), 6U);
  EXPECT_EQ(variants.front().name, "nothing");
  EXPECT_EQ(variants.back().name, "all");
  EXPECT_EQ(variants.back().sensor, sensor);
  SensorModel bare = sensor;
  bare.depth_noise = 0.0;
  bare.projector.reset();
  bare.nearest_distance = bare.farthest_distance = 900.0;
  bare.largest_incidence = 0.5 * std::numbers::pi;
  EXPECT_EQ(variants.front().sensor, bare);
  SensorModel noisy = bare;
  noisy.depth_noise = 0.8;
  EXPECT_EQ(named(variants, "noise"), noisy);
  EXPECT_EQ(named(variants, "shadow").projector, sensor.projector);
  EXPECT_EQ(named(variants, "shadow").depth_noise, 0.0);
  EXPECT_EQ(named(variants, "distance").farthest_distance, 1100.0);
  EXPECT_EQ(named(variants, "incidence").largest_incidence, 1.2);
}

TEST(SensorVariants, leave_out_what_the_sensor_does_not_have) {
  const std::vector<SensorVariant> variants = sensor_variants(paper_sensor());
  ASSERT_EQ(variants.size(), 2U);
  EXPECT_EQ(variants[0].sensor, variants[1].sensor);  // the paper's sensor has none of it
}

TEST(SensorVariants, change_the_priors_and_nothing_else) {
  const std::vector<CadModel> models = {test::cuboid(90, 70, 50)};
  const CompiledDatabase full = compiled(models[0], full_sensor());
  const SensorModel bare = sensor_variants(full_sensor()).front().sensor;
  const CompiledDatabase stripped = with_priors_of(bare, full, models, kFewViews);
  EXPECT_NE(masses(stripped), masses(full));
  EXPECT_EQ(stripped.sensor, full.sensor);
  EXPECT_EQ(stripped.segmentation, full.segmentation);
  EXPECT_FALSE(stripped.segmentation == segmentation_options_for(bare));  // whose extraction would be another
  EXPECT_EQ(stripped.density, full.density);
  EXPECT_EQ(stripped.models[0].acceptance.samples, 7);
  EXPECT_EQ(stripped.models[0].surface.spacing, 3.0);
}

TEST(SensorVariants, give_the_same_priors_again_for_the_same_sensor) {
  const std::vector<CadModel> models = {test::cuboid(90, 70, 50)};
  const CompiledDatabase full = compiled(models[0], full_sensor());
  EXPECT_EQ(masses(with_priors_of(full_sensor(), full, models, kFewViews)), masses(full));
}

}  // namespace
}  // namespace foresight
