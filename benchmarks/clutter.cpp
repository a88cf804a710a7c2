// Several known objects in one scene that hide one another (Fig. 9): recall by how much of an object is visible.
#include <charconv>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {
namespace {

// "5" or "4-6".
SceneOptions objects_range(const std::string& text, std::size_t models) {
  SceneOptions options;
  const char* end = text.data() + text.size();
  auto parsed = std::from_chars(text.data(), end, options.fewest_objects);
  options.most_objects = options.fewest_objects;
  if (parsed.ec == std::errc() && parsed.ptr != end && *parsed.ptr == '-') {
    parsed = std::from_chars(parsed.ptr + 1, end, options.most_objects);
  }
  if (parsed.ec != std::errc() || parsed.ptr != end || options.fewest_objects < 1 ||
      options.most_objects < options.fewest_objects || static_cast<std::size_t>(options.most_objects) > models) {
    throw UsageError("--objects", "\"" + text + "\" is not a number or range up to the number of CAD files",
                     "give for instance 4 or 4-6");
  }
  return options;
}

std::vector<SummaryRow> rows_by_visibility(const std::vector<SceneRecord>& records) {
  std::vector<SummaryRow> rows;
  rows.push_back(summarize("visible 0-25 %", records, {0.0, 0.25}));
  rows.push_back(summarize("visible 25-50 %", records, {0.25, 0.5}));
  rows.push_back(summarize("visible 50-75 %", records, {0.5, 0.75}));
  rows.push_back(summarize("visible 75-100 %", records, {0.75, 2.0}));
  rows.push_back(summarize("visible >= 50 %", records, {0.5, 2.0}));
  rows.push_back(summarize("all", records));
  return rows;
}

void run_clutter(const ExperimentOptions& options, const std::string& objects_text) {
  const SensorModel sensor = sensor_of(options.sensor_file);
  const std::vector<CadModel> models = read_objects(options, sensor);
  SceneOptions scene_options = objects_range(objects_text, models.size());
  scene_options.background = sensor.background;
  const std::vector<ScoredObject> objects = scored_objects(models);
  const Database database = database_of(
      options, models, options.compile_sensor_file.empty() ? sensor : sensor_of(options.compile_sensor_file));
  std::vector<SceneRecord> records(static_cast<std::size_t>(options.n));
  run_in_parallel(options, "clutter", options.n, [&](int i) {
    const Scene scene = generate_scene(models, sensor, scene_options, options.seed, static_cast<std::uint64_t>(i));
    records[static_cast<std::size_t>(i)] = recognize_and_score({models, objects, database, sensor, options.method},
                                                               std::to_string(i), scene.scan.image, truth_of(scene));
  });
  write_results(options, "clutter", rows_by_visibility(records), records, models);
}

}  // namespace

Experiment add_clutter(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  const auto objects = std::make_shared<std::string>("4-6");
  CLI::App* command =
      app.add_subcommand("clutter", "Several known objects a scene that hide one another, by visible fraction");
  add_common_options(*command, *options, 40);
  command->add_option("--objects", *objects, "Objects a scene: a number, or a range")->capture_default_str();
  add_object_options(*command, *options);
  add_method_options(*command, options->method);
  return {command, [options, objects] {
            run_clutter(*options, *objects);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
