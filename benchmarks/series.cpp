#include "benchmarks/series.h"

namespace foresight {

Scene single_object_scene(const std::vector<CadModel>& models, const SensorModel& sensor, bool background,
                          std::uint64_t seed, int index) {
  const int count = static_cast<int>(models.size());
  const int model = index % count;
  SceneOptions options;
  options.background = background;
  Scene scene = generate_scene({models[static_cast<std::size_t>(model)]}, sensor, options, seed,
                               static_cast<std::uint64_t>(index));
  for (SceneObject& object : scene.objects) object.model = model;
  return scene;
}

std::vector<TrueObject> truth_of(const Scene& scene) {
  std::vector<TrueObject> truth;
  for (const SceneObject& object : scene.objects)
    truth.push_back({object.model, {object.T_sensor_model}, object.visible_fraction});
  return truth;
}

void run_single_object_series(const ExperimentOptions& options, const std::string& name, const SensorModel& scan_sensor,
                              const SensorModel& compile_sensor) {
  const std::vector<CadModel> models = read_objects(options, scan_sensor);
  const std::vector<ScoredObject> objects = scored_objects(models);
  const Database database = database_of(options, models, compile_sensor);
  std::vector<SceneRecord> records(static_cast<std::size_t>(options.n));
  run_in_parallel(options, name, options.n, [&](int i) {
    const Scene scene = single_object_scene(models, scan_sensor, scan_sensor.background, options.seed, i);
    records[static_cast<std::size_t>(i)] = recognize_and_score({models, objects, database, scan_sensor, options.method},
                                                               std::to_string(i), scene.scan.image, truth_of(scene));
  });

  std::vector<SummaryRow> rows;
  for (std::size_t m = 0; m < models.size(); ++m) {
    std::vector<SceneRecord> of_model;
    for (std::size_t i = m; i < records.size(); i += models.size()) of_model.push_back(records[i]);
    rows.push_back(summarize(models[m].name, of_model));
  }
  rows.push_back(summarize("all", records));
  write_results(options, name, rows, records, models);
}

}  // namespace foresight
