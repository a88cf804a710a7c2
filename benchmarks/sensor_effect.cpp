// What does it bring that priors know noise, shadow, distance and grazing loss? The paper's knew none of them, and its
// conclusion (Section VII) names them as what a comprehensive sensor model should have. The same scans, recognized with
// databases that differ in their priors only.
#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/intervals.h"
#include "benchmarks/real_scans.h"
#include "benchmarks/result_plots.h"
#include "benchmarks/sensor_variants.h"
#include "benchmarks/series.h"
#include "common/errors.h"
#include "runtime/match_likelihoods.h"

namespace foresight {
namespace {

// A scan with what each of its cells shows; labels name the truth's objects.
struct LabelledTrueScan {
  TrueScan scan;
  std::vector<CellLabel> labels;
};

struct ScanSet {
  std::string name;
  int count = 0;
  std::function<LabelledTrueScan(int)> draw;
};

// Priors of one kind, with everything recognized with them.
struct VariantRun {
  std::string name;
  std::unique_ptr<const Database> database;
  std::vector<Contestant> contestants;
  std::vector<std::vector<SceneRecord>> records;  // by contestant, by scan
  std::vector<std::vector<bool>> kept;            // by scan, by true match: whether its likelihood is above 0
};

struct TrueMatch {
  int region, model, face;
};

// A region's true match is with the face that most of its cells show.
std::vector<TrueMatch> true_matches(const LabelledTrueScan& scan, const std::vector<CadModel>& models,
                                    const PoolVector<DescribedRegion>& regions) {
  std::vector<FaceIndex> numbered;  // the faces of all objects, numbered through
  std::vector<int> first;
  for (const TrueObject& object : scan.scan.truth) {
    first.push_back(static_cast<int>(numbered.size()));
    const std::size_t faces = models[static_cast<std::size_t>(object.object)].faces.size();
    for (std::size_t face = 0; face < faces; ++face) numbered.push_back({object.object, static_cast<int>(face)});
  }
  std::vector<CellLabel> labels = scan.labels;
  for (CellLabel& label : labels) {
    if (label.object >= 0) label.face += first[static_cast<std::size_t>(label.object)];
  }
  std::vector<TrueMatch> matches;
  for (const RegionFace& pair : pair_regions_with_faces(regions, labels)) {
    const FaceIndex& shown = numbered[static_cast<std::size_t>(pair.face)];
    matches.push_back({pair.region, shown.model, shown.face});
  }
  return matches;
}

// Which of them have a likelihood above 0.
std::vector<bool> kept_matches(const std::vector<TrueMatch>& truth, const PoolVector<DescribedRegion>& regions,
                               const Database& database) {
  const auto matches = match_likelihoods(regions, database, background_for(database.content().density));
  std::vector<bool> kept;
  for (const TrueMatch& true_match : truth) {
    kept.push_back(std::any_of(matches.begin(), matches.end(), [&](const Match& match) {
      const FaceIndex& face = database.faces()[static_cast<std::size_t>(match.face)];
      return match.region == true_match.region && face.model == true_match.model && face.face == true_match.face;
    }));
  }
  return kept;
}

// Of the true matches of all scans.
struct Kept {
  long matches = 0;
  long kept = 0;
  long gained = 0;  // kept here, not with the first variant
  long lost = 0;    // the other way round
};

Kept count_kept(const VariantRun& run, const VariantRun& first) {
  Kept count;
  for (std::size_t scan = 0; scan < run.kept.size(); ++scan) {
    for (std::size_t i = 0; i < run.kept[scan].size(); ++i) {
      const bool here = run.kept[scan][i];
      const bool before = first.kept[scan][i];
      ++count.matches;
      count.kept += here ? 1 : 0;
      count.gained += here && !before ? 1 : 0;
      count.lost += before && !here ? 1 : 0;
    }
  }
  return count;
}

ScanSet simulated_scans(const SeriesSetup& setup, const ExperimentOptions& options) {
  return {"scanner", options.n, [&setup, seed = options.seed](int i) {
            Scene scene = single_object_scene(setup.models, setup.sensor, setup.sensor.background, seed, i);
            std::vector<CellLabel> labels = std::move(scene.scan.labels);
            return LabelledTrueScan{
                {std::to_string(i), std::move(scene.scan.image), setup.sensor.camera, truth_of(scene)},
                std::move(labels)};
          }};
}

// Their labels are those of the scene as its truth has it.
ScanSet abw_scans(const SeriesSetup& setup, const std::string& abw) {
  const std::string truth_file = abw + "/truth.json";
  const auto scans = std::make_shared<const std::vector<ScanTruth>>(read_truth_file(truth_file));
  return {"abw", static_cast<int>(scans->size()), [&setup, scans, abw, truth_file](int i) {
            const ScanTruth& of_scan = (*scans)[static_cast<std::size_t>(i)];
            Scan scan = read_abw_scan(abw, of_scan);
            std::vector<TrueObject> truth = check_truth(of_scan, setup.models, truth_file);
            std::vector<PlacedObject> placed;
            for (const TrueObject& object : truth)
              placed.push_back({&setup.models[static_cast<std::size_t>(object.object)], object.poses.front()});
            SensorModel sensor = setup.sensor;
            sensor.camera = *scan.camera;
            std::vector<CellLabel> labels = SimulatedScene(placed).scan(sensor, Random(1)).labels;
            return LabelledTrueScan{{of_scan.scan, std::move(scan.image), sensor.camera, std::move(truth)},
                                    std::move(labels)};
          }};
}

std::vector<VariantRun> compile_variants(const ExperimentOptions& options, const SeriesSetup& setup,
                                         const FaceSampleOptions& samples, int scans) {
  const std::vector<SensorVariant> variants = sensor_variants(setup.sensor);
  std::vector<VariantRun> runs(variants.size());
  run_in_parallel(options, "priors", static_cast<int>(variants.size()), [&](int i) {
    VariantRun& run = runs[static_cast<std::size_t>(i)];
    const SensorVariant& variant = variants[static_cast<std::size_t>(i)];
    run.name = variant.name;
    run.database = std::make_unique<const Database>(
        with_priors_of(variant.sensor, setup.database->content(), setup.models, samples));
    run.contestants = contestants(options, setup.models, setup.sensor, *run.database);
    run.records.assign(run.contestants.size(), std::vector<SceneRecord>(static_cast<std::size_t>(scans)));
    run.kept.resize(static_cast<std::size_t>(scans));
  });
  return runs;
}

// Every scan is drawn and extracted once for all variants: they have the same extraction settings.
void recognize_all(const ExperimentOptions& options, const SeriesSetup& setup, const ScanSet& set,
                   std::vector<VariantRun>& runs) {
  run_in_parallel(options, "recognize", set.count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const LabelledTrueScan scan = set.draw(i);
    const auto regions = extract_regions(scan.scan.image, scan.scan.camera, setup.database->content().segmentation);
    const std::vector<TrueMatch> truth = true_matches(scan, setup.models, regions);
    for (VariantRun& run : runs) {
      run.kept[index] = kept_matches(truth, regions, *run.database);
      for (std::size_t c = 0; c < run.contestants.size(); ++c) {
        run.records[c][index] =
            recognize_and_score({setup.models, setup.objects, setup.sensor}, run.contestants[c], scan.scan);
      }
    }
  });
}

double percent(long hits, long trials) {
  return trials == 0 ? std::numeric_limits<double>::quiet_NaN()
                     : 100.0 * static_cast<double>(hits) / static_cast<double>(trials);
}

std::vector<std::string> with_interval(long hits, long trials) {
  const Interval interval = wilson_interval(hits, trials);
  return {decimal(percent(hits, trials), 1), decimal(100.0 * interval.low, 1), decimal(100.0 * interval.high, 1)};
}

// Times last: they alone differ between runs.
Table table_of(const std::vector<VariantRun>& runs, const std::vector<SummaryRow>& rows, std::uint64_t seed) {
  Table table;
  table.header = {"method",      "priors from",  "seed",          "scans",      "true matches",
                  "kept %",      "low",          "high",          "gained",     "lost",
                  "objects",     "right pose %", "right low",     "right high", "false positives",
                  "wrong poses", "hypotheses",   "verifications", "ms"};
  for (const SummaryRow& row : rows) {
    const auto run = std::find_if(runs.begin(), runs.end(), [&](const VariantRun& r) { return r.name == row.label; });
    const Kept kept = count_kept(*run, runs.front());
    std::vector<std::string> line = {row.method, row.label, std::to_string(seed), std::to_string(row.scenes),
                                     std::to_string(kept.matches)};
    const auto append = [&](const std::vector<std::string>& cells) {
      line.insert(line.end(), cells.begin(), cells.end());
    };
    append(with_interval(kept.kept, kept.matches));
    append({std::to_string(kept.gained), std::to_string(kept.lost)});
    append({std::to_string(row.objects)});
    append(with_interval(row.right, row.objects));
    append({std::to_string(row.false_positives), std::to_string(row.wrong_poses), decimal(row.hypotheses, 1),
            decimal(row.verifications, 2), decimal(row.milliseconds.total, 1)});
    table.rows.push_back(std::move(line));
  }
  return table;
}

// True matches kept, in percent with their intervals.
Plot kept_plot(const std::vector<VariantRun>& runs) {
  Plot plot;
  plot.title = "priors from the sensor with ...";
  plot.y_label = "true matches kept, %";
  plot.percent_y = true;
  Curve& curve = plot.curves.emplace_back();
  curve.style = Curve::Style::points;
  for (const VariantRun& run : runs) {
    const Kept kept = count_kept(run, runs.front());
    const Interval interval = wilson_interval(kept.kept, kept.matches);
    curve.x.push_back(static_cast<double>(plot.x_names.size()));
    curve.y.push_back(percent(kept.kept, kept.matches));
    curve.low.push_back(100.0 * interval.low);
    curve.high.push_back(100.0 * interval.high);
    plot.x_names.push_back(run.name);
  }
  return plot;
}

void run_sensor_effect(ExperimentOptions options, const FaceSampleOptions& samples, const std::string& scans,
                       const std::string& abw) {
  const bool real = scans == "abw";
  if (real && options.cad_files.empty()) options.cad_files = cad_files_in(abw + "/models");
  const SeriesSetup setup = set_up_series(options, project_path("models/sensors/" + scans + ".textproto"));
  const std::vector<CompiledModel>& compiled = setup.database->models();
  if (!std::equal(compiled.begin(), compiled.end(), setup.models.begin(), setup.models.end(),
                  [](const CompiledModel& a, const CadModel& b) { return a.name == b.name; }))
    throw InputError(options.database_file, "its objects are not those of the CAD files, in their order",
                     "give the CAD files it was compiled from with --cad, in the same order");
  if (!(setup.database->content().sensor == setup.sensor))
    throw InputError(options.database_file, "it was compiled for another sensor than that of the scans",
                     "compile it for models/sensors/" + scans + ".textproto");
  make_folder(options.output);
  const ScanSet set = real ? abw_scans(setup, abw) : simulated_scans(setup, options);
  std::vector<VariantRun> runs = compile_variants(options, setup, samples, set.count);
  recognize_all(options, setup, set, runs);

  std::vector<SummaryRow> rows;  // method by method
  for (std::size_t c = 0; c < setup.contestants.size(); ++c) {
    for (const VariantRun& run : runs) rows.push_back(summarize(run.name, run.records[c], {0.5, 2.0}));
  }
  const std::string name = "sensor_effect_" + set.name;
  write_csv(options, name, table_of(runs, rows, options.seed));
  write_plots(options.output + "/" + name + ".svg",
              {kept_plot(runs), right_pose_plot("priors from the sensor with ...", rows)}, 2);
  std::cout << "sensor-effect, scans " << set.name << ", objects at least half visible\n"
            << to_text(table_of(runs, rows, options.seed));
  if (options.jobs > 1)
    std::cout << "times: of " << options.jobs << " scans at once; use --jobs 1 for times that mean something\n";
}

}  // namespace

Experiment add_sensor_effect(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  const auto folder = std::make_shared<std::string>();
  const auto scans = std::make_shared<std::string>("scanner");
  const auto samples = std::make_shared<FaceSampleOptions>();
  CLI::App* command = app.add_subcommand(
      "sensor-effect",
      "Priors from the sensor and from what is left of it without noise, shadow, distances, incidence");
  options->methods = {"two-way"};
  add_common_options(*command, *options, 80);
  add_data_option(*command, *folder);
  command
      ->add_option("--scans", *scans,
                   "scanner: --n scenes as `scanner` draws them; abw: the real scans (skipped without the data)")
      ->check(CLI::IsMember({"scanner", "abw"}))
      ->capture_default_str();
  command->add_option("--cad", options->cad_files, "CAD files, one object each; those of the scans when not given");
  command->add_option("--database", options->database_file,
                      "Database of these CAD files for the scans' sensor; compiled in this process when not given");
  command->add_option("--views", samples->views, "Sample views of all priors, whatever those of the database")
      ->check(CLI::IsMember({20, 80, 320, 1280}))
      ->capture_default_str();
  add_method_options(*command, *options);
  return {command, [options, folder, scans, samples] {
            if (*scans == "scanner" || has_abw_scans(*folder, "sensor-effect"))
              run_sensor_effect(*options, *samples, *scans, *folder + "/abw");
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
