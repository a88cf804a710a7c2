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

// What is drawn.
struct FaceChoice {
  std::vector<std::string> objects = {"pencil_box", "castle", "rolodex", "stapler"};
  int face = -1;  // -1: the largest of each object
};

const char* unit_of(const std::string& attribute) {
  if (attribute == kAttributeNames[kArea]) return "mm²";
  return attribute == kRelationNames[kOrientation] ? "rad" : "mm";
}

// Share of the values in each bin from `first` on, bins counted from 0.
Curve shares(const std::vector<double>& values, double bin_width, int first, int last) {
  Curve curve;
  for (int bin = first; bin <= last; ++bin) {
    const auto inside = std::count_if(values.begin(), values.end(), [&](double value) {
      return static_cast<int>(std::floor(value / bin_width)) == bin;
    });
    curve.x.push_back((bin + 0.5) * bin_width);
    curve.y.push_back(static_cast<double>(inside) / static_cast<double>(std::max<std::size_t>(1, values.size())));
  }
  return curve;
}

// A normal distribution as the mass of a bin about each place.
Curve normal_curve(const Constraint& normal, double bin_width, double from, double to) {
  constexpr int kPlaces = 300;
  Curve curve;
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = from + (to - from) * i / kPlaces;
    Constraint moved = normal;  // so that x is the middle of bin 0
    moved.mean = normal.mean - x + 0.5 * bin_width;
    curve.x.push_back(x);
    curve.y.push_back(moved.probability(0.5 * bin_width, bin_width));
  }
  return curve;
}

// Vertical lines.
Curve lines_at(const std::vector<double>& places, double top) {
  Curve curve;
  for (const double x : places) {
    curve.x.insert(curve.x.end(), {x, x, x});
    curve.y.insert(curve.y.end(), {0.0, top, std::nan("")});
  }
  return curve;
}

double highest(const Curve& curve) { return *std::max_element(curve.y.begin(), curve.y.end()); }

// In the manner of Figs. 2 and 6.
Plot attribute_plot(const AttributeSamples& attribute, const std::string& title, const std::string& held_out) {
  const auto constraints = constraints_on(attribute);
  double from = 0.8 * attribute.cad_value, to = 1.1 * attribute.cad_value;
  for (const std::vector<double>* values : {&attribute.samples, &attribute.held_out}) {
    for (const double value : *values) {
      from = std::min(from, value);
      to = std::max(to, value);
    }
  }
  const double width = attribute.bin_width;
  const int first = std::max(0, static_cast<int>(std::floor(from / width)) - 1);
  const int last = static_cast<int>(std::floor(to / width)) + 1;

  Plot plot;
  plot.title = title;
  plot.x_label = attribute.name + " (" + unit_of(attribute.name) + ")";
  plot.y_label = "share in a bin";
  const auto add = [&](Curve curve, const std::string& label, Curve::Style style) {
    curve.label = label;
    curve.style = style;
    plot.curves.push_back(std::move(curve));
  };
  add(shares(attribute.samples, width, first, last),
      "sensor model (" + std::to_string(attribute.samples.size()) + " samples)", Curve::Style::bars);
  add(shares(attribute.held_out, width, first, last),
      held_out + " (" + std::to_string(attribute.held_out.size()) + " samples)", Curve::Style::steps);
  const double left = first * width, right = (last + 1) * width;
  for (const std::size_t c : {1, 2}) {
    if (constraints[c].kind == ConstraintKind::normal)
      add(normal_curve(constraints[c], width, left, right), kConstraintNames[c], Curve::Style::line);
  }
  double top = 0.0;
  for (const Curve& curve : plot.curves) top = std::max(top, highest(curve));
  add(lines_at({constraints[5].low, constraints[5].high}, top), attribute.angle ? "CAD ± 3 sigma" : "CAD 0.8 to 1.1",
      Curve::Style::line);
  add(lines_at({attribute.cad_value}, top), "CAD value", Curve::Style::line);
  return plot;
}

// The face that was chosen, or the largest; -1 when no view shows it.
int subject_to_draw(const std::vector<ConstraintSubject>& subjects, const std::string& object, int face) {
  int chosen = -1;
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    const ConstraintSubject& subject = subjects[s];
    if (subject.object != object || subject.faces.size() != 1) continue;
    if (face >= 0 ? subject.faces[0] == face
                  : chosen < 0 || subject.attributes[kArea].cad_value >
                                      subjects[static_cast<std::size_t>(chosen)].attributes[kArea].cad_value)
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

void check_choice(const FaceChoice& choice, const std::vector<CadModel>& models) {
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
ConstraintResult compare(const ExperimentOptions& options, const std::string& scans,
                         const std::vector<CadModel>& models, const SensorModel& compile_sensor,
                         const SensorModel& scan_sensor,
                         const std::function<std::vector<ViewSample>(std::size_t)>& views) {
  std::vector<std::vector<ConstraintSubject>> subjects(models.size());
  run_in_parallel(options, "views " + scans, static_cast<int>(models.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const std::vector<ViewSample> samples =
        sample_views(models[index], compile_sensor, segmentation_options_for(compile_sensor), {});
    subjects[index] = subjects_of(models[index], samples, views(index), scan_sensor);
  });
  ConstraintResult result{scans, {}, {}};
  for (std::vector<ConstraintSubject>& of_model : subjects) {
    for (ConstraintSubject& subject : of_model) result.subjects.push_back(std::move(subject));
  }
  score_all(options, result);
  return result;
}

ConstraintResult compare_simulated(const ExperimentOptions& options, const FaceChoice& choice) {
  const SensorModel sensor =
      sensor_of(options.sensor_file.empty() ? project_path("models/sensors/scanner.textproto") : options.sensor_file);
  const SensorModel compile_sensor =
      options.compile_sensor_file.empty() ? sensor : sensor_of(options.compile_sensor_file);
  const std::vector<CadModel> models = read_objects(options, sensor);
  check_choice(choice, models);
  ConstraintResult result = compare(options, "held-out views", models, compile_sensor, sensor, [&](std::size_t i) {
    return random_views(models[i], sensor, options.n, options.seed);
  });
  for (const std::string& object : choice.objects) draw_face(result, object, choice.face, options.output);
  return result;
}

// The objects of the real scans are those of the data folder, and a face of each is drawn.
ConstraintResult compare_real(ExperimentOptions options, const std::string& abw) {
  options.cad_files = cad_files_in(abw + "/models");
  options.unit = "mm";
  const SensorModel sensor = sensor_of(project_path("models/sensors/abw.textproto"));
  const std::vector<CadModel> models = read_objects(options, sensor);
  const std::vector<std::vector<ViewSample>> measured = measured_views(models, sensor, abw);
  ConstraintResult result =
      compare(options, "real scans", models, sensor, sensor, [&](std::size_t i) { return measured[i]; });
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

void run_constraints(const ExperimentOptions& options, const FaceChoice& choice, const std::string& folder) {
  make_folder(options.output);
  std::vector<ConstraintResult> results = {compare_simulated(options, choice)};
  if (has_abw_scans(folder, "constraints on real scans")) results.push_back(compare_real(options, folder + "/abw"));
  const Table summary = constraint_summary(results, options.seed);
  write_csv(options, "constraints", constraint_table(results, options.seed));
  write_csv(options, "constraints_summary", summary);
  std::cout << "constraints, seed " << options.seed << "\n" << to_text(short_summary(summary));
}

}  // namespace

Experiment add_constraints(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  const auto choice = std::make_shared<FaceChoice>();
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
  command->add_option("--object", choice->objects, "Objects to draw a face of")->capture_default_str();
  command->add_option("--face", choice->face, "Face to draw, by its number; the largest of each object when not given")
      ->check(CLI::NonNegativeNumber);
  return {command, [options, choice, folder] {
            run_constraints(*options, *choice, *folder);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
