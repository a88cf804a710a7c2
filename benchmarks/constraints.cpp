// Sections III and VI.A: how well the compiled distributions of attributes constrain matches, against what systems
// without a sensor model use (Fig. 2) and on views they were not compiled from (Fig. 6).
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/constraint_scores.h"
#include "benchmarks/plot.h"
#include "benchmarks/real_scans.h"
#include "common/errors.h"

namespace foresight {
namespace {

// What is drawn, and how the sensor model's distributions are compiled.
struct ConstraintOptions {
  DensityOptions density;
  std::vector<std::string> objects = {"pencil_box", "castle", "rolodex", "stapler"};
  int face = -1;  // -1: of each object the one whose area varies most from view to view
};

const char* unit_of(const std::string& attribute) {
  if (attribute == kAttributeNames[kArea]) return "mm²";
  return attribute == kRelationNames[kOrientation] ? "rad" : "mm";
}

constexpr int kDrawnBins = 60;  // finer than the compiled ones, which span all faces of a model

// What one plot shows, in equal bins.
struct DrawnRange {
  double from = 0.0;
  double to = 0.0;

  [[nodiscard]] double bin_width() const { return (to - from) / kDrawnBins; }
};

// All samples and the bounds about the CAD value, with a margin.
DrawnRange range_of(const AttributeSamples& attribute, const Constraint& bounds) {
  DrawnRange range{bounds.low, bounds.high};
  for (const std::vector<double>* values : {&attribute.samples, &attribute.held_out}) {
    for (const double value : *values) {
      range.from = std::min(range.from, value);
      range.to = std::max(range.to, value);
    }
  }
  const double margin = 0.03 * (range.to - range.from);
  return {std::max(0.0, range.from - margin), range.to + margin};  // no attribute is negative
}

// Share of the values in each bin.
Curve shares(const std::vector<double>& values, const DrawnRange& range) {
  std::vector<long> counts(kDrawnBins, 0);
  for (const double value : values)
    ++counts[static_cast<std::size_t>(std::clamp((value - range.from) / range.bin_width(), 0.0, kDrawnBins - 1.0))];
  Curve curve;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    curve.x.push_back(range.from + (static_cast<double>(bin) + 0.5) * range.bin_width());
    curve.y.push_back(static_cast<double>(counts[bin]) / static_cast<double>(std::max<std::size_t>(1, values.size())));
  }
  return curve;
}

// The compiled distribution: the mass of its bins, spread evenly over each.
Curve compiled_curve(const AttributeSamples& attribute, const DrawnRange& range) {
  constexpr int kPlaces = 1200;
  Curve curve;
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = range.from + (range.to - range.from) * i / kPlaces;
    curve.x.push_back(x);
    curve.y.push_back(attribute.density.probability(x) * range.bin_width() / attribute.bin_width);
  }
  return curve;
}

// A normal distribution as the mass of a drawn bin about each place.
Curve normal_curve(const Constraint& normal, const DrawnRange& range) {
  constexpr int kPlaces = 300;
  const double width = range.bin_width();
  Curve curve;
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = range.from + (range.to - range.from) * i / kPlaces;
    Constraint moved = normal;  // so that x is the middle of bin 0
    moved.mean = normal.mean - x + 0.5 * width;
    curve.x.push_back(x);
    curve.y.push_back(moved.probability(0.5 * width, width));
  }
  return curve;
}

// Two vertical lines, joined along the axis.
Curve bounds_curve(double low, double high, double top) {
  return {"", {low, low, high, high}, {top, 0, 0, top}, {}, {}};
}

double highest(const Curve& curve) { return *std::max_element(curve.y.begin(), curve.y.end()); }

// In the manner of Figs. 2 and 6.
Plot attribute_plot(const AttributeSamples& attribute, const std::string& title, const std::string& held_out) {
  const auto constraints = constraints_on(attribute);
  const DrawnRange range = range_of(attribute, constraints[5]);
  Plot plot;
  plot.title = title;
  plot.x_label = attribute.name + " (" + unit_of(attribute.name) + ")";
  plot.y_label = "share in a bin";
  const auto add = [&](Curve curve, const std::string& label, Curve::Style style) {
    curve.label = label;
    curve.style = style;
    plot.curves.push_back(std::move(curve));
  };
  const auto count = [](const std::vector<double>& values) { return " (" + std::to_string(values.size()) + ")"; };
  add(shares(attribute.samples, range), "sample views" + count(attribute.samples), Curve::Style::bars);
  add(shares(attribute.held_out, range), held_out + count(attribute.held_out), Curve::Style::steps);
  add(compiled_curve(attribute, range), "sensor model, compiled", Curve::Style::line);
  for (const std::size_t c : {1, 2}) {
    if (constraints[c].kind == ConstraintKind::normal)
      add(normal_curve(constraints[c], range), kConstraintNames[c], Curve::Style::line);
  }
  double top = 0.0;
  for (const Curve& curve : plot.curves) top = std::max(top, highest(curve));
  add(bounds_curve(std::max(range.from, constraints[5].low), constraints[5].high, top),
      attribute.angle ? "CAD value ± 3 sigma" : "CAD value × 0.8 to 1.1", Curve::Style::line);
  add(bounds_curve(attribute.cad_value, attribute.cad_value, top), "CAD value", Curve::Style::line);
  return plot;
}

// Standard deviation over mean of the area in the sample views; 0 for faces seen too rarely to tell.
double area_spread(const ConstraintSubject& subject) {
  constexpr std::size_t kFewestSamples = 80;  // a quarter of the sample views
  const AttributeSamples& area = subject.attributes[kArea];
  const Constraint fitted = constraints_on(area)[1];
  return area.samples.size() < kFewestSamples ? 0.0 : fitted.sigma / fitted.mean;
}

// The face that was chosen, or that with the largest spread; -1 when no view shows it.
int subject_to_draw(const std::vector<ConstraintSubject>& subjects, const std::string& object, int face) {
  int chosen = -1;
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    const ConstraintSubject& subject = subjects[s];
    if (subject.object != object || subject.faces.size() != 1) continue;
    if (face >= 0 ? subject.faces[0] == face
                  : chosen < 0 || area_spread(subject) > area_spread(subjects[static_cast<std::size_t>(chosen)]))
      chosen = static_cast<int>(s);
  }
  return chosen;
}

// The pair with this face that most held-out views show, or null.
const ConstraintSubject* partner_to_draw(const std::vector<ConstraintSubject>& subjects,
                                         const ConstraintSubject& face) {
  const ConstraintSubject* best = nullptr;
  for (const ConstraintSubject& pair : subjects) {
    if (pair.object != face.object || pair.faces.size() != 2) continue;
    if (pair.faces[0] != face.faces[0] && pair.faces[1] != face.faces[0]) continue;
    if (best == nullptr || pair.attributes[0].held_out.size() > best->attributes[0].held_out.size()) best = &pair;
  }
  return best;
}

void draw_face(const ConstraintResult& result, const std::string& object, int face, const std::string& output) {
  const int index = subject_to_draw(result.subjects, object, face);
  if (index < 0) {
    std::cout << "constraints: no view shows face " << face << " of " << object << ", nothing is drawn\n";
    return;
  }
  const ConstraintSubject& subject = result.subjects[static_cast<std::size_t>(index)];
  std::vector<Plot> plots;
  for (const AttributeSamples& attribute : subject.attributes)
    plots.push_back(attribute_plot(attribute, subject.name(), result.scans));
  const ConstraintSubject* pair = partner_to_draw(result.subjects, subject);
  if (pair != nullptr) {
    for (const AttributeSamples& attribute : pair->attributes)
      plots.push_back(attribute_plot(attribute, pair->name(), result.scans));
  }
  write_plots(output + "/constraints_" + object + "_" + std::to_string(subject.faces[0]) + ".svg", plots, 2);
}

void check_choice(const ConstraintOptions& choice, const std::vector<CadModel>& models) {
  for (const std::string& object : choice.objects) {
    const auto found =
        std::find_if(models.begin(), models.end(), [&](const CadModel& model) { return model.name == object; });
    if (found == models.end())
      throw UsageError("--object", "no CAD file is named " + object, "give the name of a CAD file without its ending");
    if (choice.face >= static_cast<int>(found->faces.size()))
      throw UsageError("--face", object + " has " + std::to_string(found->faces.size()) + " faces",
                       "give a number from 0 to " + std::to_string(found->faces.size() - 1));
  }
}

void score_all(const ExperimentOptions& options, ConstraintResult& result) {
  result.scores.resize(result.subjects.size());
  run_in_parallel(options, "score " + result.scans, static_cast<int>(result.subjects.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    result.scores[index] = score_subject(result.subjects, index);
  });
}

// views(model index): the held-out views of a model.
ConstraintResult compare(const ExperimentOptions& options, const DensityOptions& density, const std::string& scans,
                         const std::vector<CadModel>& models, const SensorModel& compile_sensor,
                         const SensorModel& scan_sensor,
                         const std::function<std::vector<ViewSample>(std::size_t)>& views) {
  std::vector<std::vector<ConstraintSubject>> subjects(models.size());
  run_in_parallel(options, "views " + scans, static_cast<int>(models.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const std::vector<ViewSample> samples =
        sample_views(models[index], compile_sensor, segmentation_options_for(compile_sensor), {});
    subjects[index] = subjects_of(models[index], samples, views(index), scan_sensor, density);
  });
  ConstraintResult result{scans, {}, {}};
  for (std::vector<ConstraintSubject>& of_model : subjects) {
    for (ConstraintSubject& subject : of_model) result.subjects.push_back(std::move(subject));
  }
  score_all(options, result);
  return result;
}

ConstraintResult compare_simulated(const ExperimentOptions& options, const ConstraintOptions& choice) {
  const SensorModel sensor =
      sensor_of(options.sensor_file.empty() ? project_path("models/sensors/scanner.textproto") : options.sensor_file);
  const SensorModel compile_sensor =
      options.compile_sensor_file.empty() ? sensor : sensor_of(options.compile_sensor_file);
  const std::vector<CadModel> models = read_objects(options, sensor);
  check_choice(choice, models);
  ConstraintResult result =
      compare(options, choice.density, "held-out views", models, compile_sensor, sensor,
              [&](std::size_t i) { return random_views(models[i], sensor, options.n, options.seed); });
  for (const std::string& object : choice.objects) draw_face(result, object, choice.face, options.output);
  return result;
}

// The objects of the real scans are those of the data folder, and a face of each is drawn.
ConstraintResult compare_real(ExperimentOptions options, const DensityOptions& density, const std::string& abw) {
  options.cad_files = cad_files_in(abw + "/models");
  options.unit = "mm";
  const SensorModel sensor = sensor_of(project_path("models/sensors/abw.textproto"));
  const std::vector<CadModel> models = read_objects(options, sensor);
  const std::vector<std::vector<ViewSample>> measured = measured_views(models, sensor, abw);
  ConstraintResult result =
      compare(options, density, "real scans", models, sensor, sensor, [&](std::size_t i) { return measured[i]; });
  for (const CadModel& model : models) draw_face(result, model.name, -1, options.output);
  return result;
}

Table short_summary(const Table& summary) {
  Table table;
  for (const auto& row : summary.rows)
    table.rows.push_back({row[0], row[1], row[2], row[3], row[4], row[7], row[8], row[11]});
  const auto& header = summary.header;
  table.header = {header[0], header[1], header[2], header[3], header[4], header[7], header[8], header[11]};
  return table;
}

void run_constraints(const ExperimentOptions& options, const ConstraintOptions& choice, const std::string& folder) {
  make_folder(options.output);
  std::vector<ConstraintResult> results = {compare_simulated(options, choice)};
  if (has_abw_scans(folder, "constraints on real scans"))
    results.push_back(compare_real(options, choice.density, folder + "/abw"));
  const Table summary = constraint_summary(results, options.seed);
  write_csv(options, "constraints", constraint_table(results, options.seed));
  write_csv(options, "constraints_summary", summary);
  std::cout << "constraints, seed " << options.seed << "\n" << to_text(short_summary(summary));
}

}  // namespace

Experiment add_constraints(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  const auto choice = std::make_shared<ConstraintOptions>();
  const auto folder = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("constraints",
                         "Figs. 2 and 6: compiled distributions of attributes against simpler constraints, on held-out "
                         "views and, where the data is, on real scans");
  add_common_options(*command, *options, 320);
  command->get_option("--n")->description("Held-out views of each object");
  add_data_option(*command, *folder);
  add_object_options(*command, *options);
  command->remove_option(command->get_option("--database"));  // it keeps densities, not samples
  command
      ->add_option("--bins", choice->density.bins,
                   "Bins of the sensor model's distributions, as foresightc compile has")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("--kernel", choice->density.kernel, "Gaussian that smooths them, in bins; 0 = raw histogram")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--object", choice->objects, "Objects to draw a face of")->capture_default_str();
  command
      ->add_option("--face", choice->face, "Face to draw, by its number; the one whose area varies most when not given")
      ->check(CLI::NonNegativeNumber);
  return {command, [options, choice, folder] {
            run_constraints(*options, *choice, *folder);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
