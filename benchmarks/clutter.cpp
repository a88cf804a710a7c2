// Several known objects in one scene that hide one another, and unknown ones among them (Fig. 9): recall by how much of
// an object is visible.
#include <charconv>
#include <memory>
#include <numeric>

#include "benchmarks/commands.h"
#include "benchmarks/random_solids.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {
namespace {

struct CountRange {
  int fewest = 0;
  int most = 0;
};

// "5" or "4-6".
CountRange read_range(const std::string& option, const std::string& text, int fewest, int most) {
  CountRange range;
  const char* end = text.data() + text.size();
  auto parsed = std::from_chars(text.data(), end, range.fewest);
  range.most = range.fewest;
  if (parsed.ec == std::errc() && parsed.ptr != end && *parsed.ptr == '-') {
    parsed = std::from_chars(parsed.ptr + 1, end, range.most);
  }
  if (parsed.ec != std::errc() || parsed.ptr != end || range.fewest < fewest || range.most < range.fewest ||
      range.most > most) {
    throw UsageError(
        option,
        "\"" + text + "\" is not a number or range from " + std::to_string(fewest) + " to " + std::to_string(most),
        "give for instance " + std::to_string(fewest) + " or " + std::to_string(fewest) + "-" + std::to_string(most));
  }
  return range;
}

// Which known objects scene i holds, and beside them unknown ones that no other scene holds.
TrueScan draw_clutter(const SeriesSetup& setup, const CountRange& known, const CountRange& unknown, std::uint64_t seed,
                      int i) {
  Random random(~seed, static_cast<std::uint64_t>(i));  // its own stream, apart from that of the arrangement
  std::vector<int> order(setup.models.size());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t k = order.size() - 1; k > 0; --k) {
    std::swap(order[k], order[static_cast<std::size_t>(random.integer(0, static_cast<int>(k)))]);
  }
  order.resize(static_cast<std::size_t>(random.integer(known.fewest, known.most)));
  std::vector<CadModel> models;
  for (const int index : order) models.push_back(setup.models[static_cast<std::size_t>(index)]);
  const int strangers = random.integer(unknown.fewest, unknown.most);
  for (int k = 0; k < strangers; ++k) models.push_back(random_solid(seed, unknown.most * i + k));

  const int count = static_cast<int>(models.size());
  Scene scene = generate_scene(models, setup.sensor, {count, count, setup.sensor.background}, seed,
                               static_cast<std::uint64_t>(i));
  std::vector<TrueObject> truth;
  for (const TrueObject& object : truth_of(scene)) {
    if (static_cast<std::size_t>(object.object) >= order.size()) continue;
    truth.push_back(object);
    truth.back().object = order[static_cast<std::size_t>(object.object)];
  }
  return {std::to_string(i), std::move(scene.scan.image), setup.sensor.camera, std::move(truth)};
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

void run_clutter(const ExperimentOptions& options, const std::string& known_text, const std::string& unknown_text) {
  const SeriesSetup setup = set_up_series(options);
  const CountRange known = read_range("--objects", known_text, 1, static_cast<int>(setup.models.size()));
  const CountRange unknown = read_range("--unknown", unknown_text, 0, 8);
  const auto records = recognize_series(options, "clutter", setup, options.n,
                                        [&](int i) { return draw_clutter(setup, known, unknown, options.seed, i); });
  write_results(options, "clutter", rows_of_all(records, rows_by_visibility), joined(records), setup.models);
}

}  // namespace

Experiment add_clutter(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  const auto known = std::make_shared<std::string>("4-6");
  const auto unknown = std::make_shared<std::string>("1-2");
  CLI::App* command = app.add_subcommand(
      "clutter", "Several known and unknown objects a scene that hide one another, by visible fraction");
  add_common_options(*command, *options, 48);
  command->add_option("--objects", *known, "Known objects a scene: a number, or a range")->capture_default_str();
  command->add_option("--unknown", *unknown, "Random unknown solids a scene: a number, or a range")
      ->capture_default_str();
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options, known, unknown] {
            run_clutter(*options, *known, *unknown);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
