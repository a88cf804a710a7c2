// Sections III and VI.A: how well the compiled distributions of attributes constrain matches, against what systems
// without a sensor model use (Fig. 2) and on views they were not compiled from (Fig. 6).
#include <algorithm>
#include <array>
#include <functional>
#include <iostream>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/constraint_plots.h"
#include "benchmarks/constraint_scores.h"
#include "benchmarks/real_scans.h"
#include "common/errors.h"

namespace foresight {
namespace {

constexpr std::array<const char*, 4> kDrawnObjects = {"pencil_box", "castle", "rolodex", "stapler"};

// What is drawn, and how the sensor model's distributions are compiled.
struct ConstraintOptions {
  DensityOptions density;
  std::vector<std::string> objects;  // empty: kDrawnObjects, or all where there are none of these
  int face = -1;                     // -1: of each object the one whose area varies most from view to view
};

// Standard deviation over mean of the area in the sample views; 0 for faces seen too rarely to tell.
double area_spread(const ConstraintSubject& subject) {
  constexpr std::size_t kFewestSamples = 80;  // a quarter of the sample views
  const AttributeSamples& area = subject.attributes[kArea];
  const Constraint fitted = constraints_on(area)[1];
  return area.samples.size() < kFewestSamples ? 0.0 : fitted.sigma / fitted.mean;
}

double held_out_count(const ConstraintSubject& subject) {
  return static_cast<double>(subject.attributes[kArea].held_out.size());
}

// The chosen face of an object, or that for which `worth` is most; null when no view shows it.
const ConstraintSubject* face_to_draw(const std::vector<ConstraintSubject>& subjects, const std::string& object,
                                      int face, double (*worth)(const ConstraintSubject&)) {
  const ConstraintSubject* best = nullptr;
  for (const ConstraintSubject& subject : subjects) {
    if (subject.object != object || subject.faces.size() != 1) continue;
    if (face >= 0 ? subject.faces[0] == face : best == nullptr || worth(subject) > worth(*best)) best = &subject;
  }
  return best;
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

void draw_face(const ConstraintResult& result, const ConstraintSubject& subject, const std::string& output) {
  std::vector<Plot> plots;
  for (const AttributeSamples& attribute : subject.attributes)
    plots.push_back(attribute_plot(attribute, subject.name(), result.scans));
  const ConstraintSubject* pair = partner_to_draw(result.subjects, subject);
  if (pair != nullptr) {
    for (const AttributeSamples& attribute : pair->attributes)
      plots.push_back(attribute_plot(attribute, pair->name(), result.scans));
  }
  write_plots(output + "/constraints_" + subject.object + "_" + std::to_string(subject.faces[0]) + ".svg", plots, 2);
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

std::vector<std::string> objects_to_draw(const ConstraintOptions& choice, const std::vector<CadModel>& models) {
  if (!choice.objects.empty()) return choice.objects;
  std::vector<std::string> all, drawn;
  for (const CadModel& model : models) {
    all.push_back(model.name);
    if (std::find(kDrawnObjects.begin(), kDrawnObjects.end(), model.name) != kDrawnObjects.end())
      drawn.push_back(model.name);
  }
  return drawn.empty() ? all : drawn;
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
  for (const std::string& object : objects_to_draw(choice, models)) {
    const ConstraintSubject* face = face_to_draw(result.subjects, object, choice.face, area_spread);
    if (face != nullptr) {
      draw_face(result, *face, options.output);
    } else {
      std::cout << "constraints: no view shows that face of " << object << ", nothing is drawn\n";
    }
  }
  return result;
}

// The objects of the real scans are those of the data folder; of each, the face measured most often is drawn.
ConstraintResult compare_real(ExperimentOptions options, const DensityOptions& density, const std::string& abw) {
  options.cad_files = cad_files_in(abw + "/models");
  options.unit = "mm";
  const SensorModel sensor = sensor_of(project_path("models/sensors/abw.textproto"));
  const std::vector<CadModel> models = read_objects(options, sensor);
  const std::vector<std::vector<ViewSample>> measured = measured_views(models, sensor, abw);
  ConstraintResult result =
      compare(options, density, "real scans", models, sensor, sensor, [&](std::size_t i) { return measured[i]; });
  for (const CadModel& model : models) {
    const ConstraintSubject* face = face_to_draw(result.subjects, model.name, -1, held_out_count);
    if (face != nullptr) draw_face(result, *face, options.output);
  }
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
  command->add_option("--object", choice->objects, "Objects to draw a face of; four of the eight when not given");
  command
      ->add_option("--face", choice->face, "Face to draw, by its number; the one whose area varies most when not given")
      ->check(CLI::NonNegativeNumber);
  return {command, [options, choice, folder] {
            run_constraints(*options, *choice, *folder);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
