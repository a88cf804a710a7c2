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

SeriesSetup set_up_series(const ExperimentOptions& options, const std::string& sensor_file) {
  SeriesSetup setup;
  setup.sensor = sensor_of(options.sensor_file.empty() ? sensor_file : options.sensor_file);
  setup.models = read_objects(options, setup.sensor);
  setup.objects = scored_objects(setup.models);
  setup.database = std::make_unique<const Database>(
      database_of(options, setup.models,
                  options.compile_sensor_file.empty() ? setup.sensor : sensor_of(options.compile_sensor_file)));
  setup.contestants = contestants(options, setup.models, setup.sensor, *setup.database);
  return setup;
}

std::vector<std::vector<SceneRecord>> recognize_series(const ExperimentOptions& options, const std::string& title,
                                                       const SeriesSetup& setup, int count,
                                                       const std::function<TrueScan(int)>& draw) {
  std::vector<std::vector<SceneRecord>> records(setup.contestants.size());
  for (auto& of_method : records) of_method.resize(static_cast<std::size_t>(count));
  run_in_parallel(options, title, count, [&](int i) {
    const TrueScan scan = draw(i);
    for (std::size_t c = 0; c < records.size(); ++c) {
      records[c][static_cast<std::size_t>(i)] =
          recognize_and_score({setup.models, setup.objects, setup.sensor}, setup.contestants[c], scan);
    }
  });
  return records;
}

std::vector<SummaryRow> rows_of_all(const std::vector<std::vector<SceneRecord>>& records, const RowsOf& rows_of) {
  std::vector<SummaryRow> rows;
  for (const auto& of_method : records) {
    for (SummaryRow& row : rows_of(of_method)) rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<SceneRecord> joined(const std::vector<std::vector<SceneRecord>>& records) {
  std::vector<SceneRecord> all;
  for (const auto& of_method : records) all.insert(all.end(), of_method.begin(), of_method.end());
  return all;
}

std::vector<SummaryRow> rows_by_object(const std::vector<CadModel>& models, const std::vector<SceneRecord>& records) {
  std::vector<SummaryRow> rows;
  for (std::size_t m = 0; m < models.size(); ++m) {
    std::vector<SceneRecord> of_model;
    for (const SceneRecord& record : records) {
      if (record.truth.front().object == static_cast<int>(m)) of_model.push_back(record);
    }
    if (!of_model.empty()) rows.push_back(summarize(models[m].name, of_model));
  }
  rows.push_back(summarize("all", records));
  return rows;
}

std::vector<SummaryRow> run_single_object_series(const ExperimentOptions& options, const std::string& name,
                                                 const std::string& sensor_file) {
  const SeriesSetup setup = set_up_series(options, sensor_file);
  const auto records = recognize_series(options, name, setup, options.n, [&](int i) {
    Scene scene = single_object_scene(setup.models, setup.sensor, setup.sensor.background, options.seed, i);
    return TrueScan{std::to_string(i), std::move(scene.scan.image), setup.sensor.camera, truth_of(scene)};
  });
  const auto by_object = [&](const auto& of_method) { return rows_by_object(setup.models, of_method); };
  write_results(options, name, rows_of_all(records, by_object), joined(records), setup.models);
  return rows_of_all(records, [](const auto& of_method) { return std::vector{summarize("all", of_method)}; });
}

}  // namespace foresight
