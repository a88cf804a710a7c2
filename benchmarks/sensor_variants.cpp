#include "benchmarks/sensor_variants.h"

#include <numbers>

#include "compiler/statistics.h"

namespace foresight {

std::vector<SensorVariant> sensor_variants(const SensorModel& sensor) {
  SensorModel bare = sensor;
  bare.depth_noise = 0.0;
  bare.matching_window = 1;
  bare.projector.reset();
  bare.nearest_distance = bare.farthest_distance = sensor.working_distance();
  bare.largest_incidence = 0.5 * std::numbers::pi;
  std::vector<SensorVariant> variants = {{"nothing", bare}};
  const auto add = [&](const std::string& name, const SensorModel& variant) {
    if (!(variant == bare)) variants.push_back({name, variant});
  };
  SensorModel noise = bare, shadow = bare, distance = bare, incidence = bare;
  noise.depth_noise = sensor.depth_noise;
  noise.matching_window = sensor.matching_window;
  shadow.projector = sensor.projector;
  distance.nearest_distance = sensor.nearest_distance;
  distance.farthest_distance = sensor.farthest_distance;
  incidence.largest_incidence = sensor.largest_incidence;
  add("noise", noise);
  add("shadow", shadow);
  add("distance", distance);
  add("incidence", incidence);
  variants.push_back({"all", sensor});
  return variants;
}

CompiledDatabase with_priors_of(const SensorModel& sensor, CompiledDatabase database,
                                const std::vector<CadModel>& models, const FaceSampleOptions& samples) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    CompiledModel& model = database.models[i];
    for (ModelFace& face : model.faces) {
      face.views_found = 0;
      face.densities = {};
    }
    // The settings of the database, not those that would follow from the other sensor.
    estimate_statistics(sample_views(models[i], sensor, database.segmentation, samples), database.density, model);
  }
  return database;
}

}  // namespace foresight
