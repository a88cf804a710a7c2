#include "benchmarks/constraint_samples.h"

#include <algorithm>
#include <map>
#include <numbers>

#include "benchmarks/cad_attributes.h"
#include "benchmarks/real_scans.h"
#include "compiler/sensor_simulator.h"
#include "compiler/statistics.h"

namespace foresight {
namespace {

// A subject with its CAD values and without samples.
ConstraintSubject empty_subject(const CadModel& model, const std::vector<int>& faces, const SensorModel& sensor) {
  ConstraintSubject subject{model.name, faces, {}};
  const auto add = [&](const auto& names, const auto& values, const auto& sigmas) {
    for (std::size_t k = 0; k < names.size(); ++k) {
      AttributeSamples& attribute = subject.attributes.emplace_back();
      attribute.name = names[k];
      attribute.cad_value = values[k];
      attribute.cad_sigma = sigmas[k];
    }
  };
  if (faces.size() == 1) {
    add(kAttributeNames, cad_attributes(model, faces[0]), cad_attribute_sigmas(model, faces[0], sensor.cell_size()));
  } else {
    add(kRelationNames, cad_relations(model, faces[0], faces[1]),
        cad_relation_sigmas(model, faces[0], faces[1], sensor.cell_size(), sensor.depth_sigma()));
    subject.attributes[kOrientation].angle = true;
  }
  return subject;
}

using Subjects = std::map<std::pair<std::size_t, std::vector<int>>, ConstraintSubject>;  // faces before pairs

void add_views(const CadModel& model, const SensorModel& sensor, const std::vector<ViewSample>& views,
               std::vector<double> AttributeSamples::*list, Subjects& subjects) {
  const auto add = [&](const std::vector<int>& faces, const auto& values) {
    const auto key = std::pair(faces.size(), faces);
    if (!subjects.contains(key)) subjects.emplace(key, empty_subject(model, faces, sensor));
    ConstraintSubject& subject = subjects.at(key);
    for (std::size_t k = 0; k < values.size(); ++k) (subject.attributes[k].*list).push_back(values[k]);
  };
  for (const ViewSample& view : views) {
    for (const auto& [face, attributes] : view.faces) add({face}, attributes);
    for (const auto& [first, second, relations] : view.pairs) add({first, second}, relations);
  }
}

// Of what the compiler made, to the subjects it is about.
template <std::size_t N>
void set_densities(const std::array<Density, N>& densities, ConstraintSubject& subject) {
  for (std::size_t k = 0; k < N; ++k) subject.attributes[k].density = densities[k];
}

// The bins of an attribute are those of the whole model, so that any of its densities tells their width.
void set_bin_widths(Subjects& subjects) {
  std::map<std::string, double> widths;
  for (const auto& [key, subject] : subjects) {
    for (const AttributeSamples& attribute : subject.attributes)
      widths[attribute.name] = std::max(widths[attribute.name], attribute.density.bin_width);
  }
  for (auto& [key, subject] : subjects) {
    for (AttributeSamples& attribute : subject.attributes) attribute.bin_width = widths[attribute.name];
  }
}

// The scene of a real scan as its truth has it.
std::vector<CellLabel> true_labels(const std::vector<CadModel>& models, const std::vector<TrueObject>& truth,
                                   const SensorModel& sensor) {
  std::vector<PlacedObject> placed;
  for (const TrueObject& object : truth)
    placed.push_back({&models[static_cast<std::size_t>(object.object)], object.poses.front()});
  return SimulatedScene(placed).scan(sensor, Random(1)).labels;
}

// The faces of all objects, numbered through: those of object i start at first[i].
std::vector<int> number_faces(const std::vector<CadModel>& models, const std::vector<TrueObject>& truth,
                              std::vector<CellLabel>& labels) {
  std::vector<int> first = {0};
  for (const TrueObject& object : truth)
    first.push_back(first.back() + static_cast<int>(models[static_cast<std::size_t>(object.object)].faces.size()));
  for (CellLabel& label : labels) {
    if (label.object >= 0) label.face += first[static_cast<std::size_t>(label.object)];
  }
  return first;
}

}  // namespace

std::string ConstraintSubject::name() const {
  std::string text = object + " " + std::to_string(faces[0]);
  if (faces.size() > 1) text += "+" + std::to_string(faces[1]);
  return text;
}

std::vector<ViewSample> random_views(const CadModel& model, const SensorModel& sensor, int n, std::uint64_t seed) {
  Random random(seed);
  const std::uint64_t view_seed = random.next();  // the compiler numbers its views from small seeds
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < n; ++i) directions.push_back(random.direction());
  return sample_directions(model, sensor, segmentation_options_for(sensor), directions, view_seed);
}

std::vector<std::vector<ViewSample>> measured_views(const std::vector<CadModel>& models, const SensorModel& sensor,
                                                    const std::string& abw) {
  std::vector<std::vector<ViewSample>> views(models.size());
  const std::string truth_file = abw + "/truth.json";
  for (const ScanTruth& scan_truth : read_truth_file(truth_file)) {
    const Scan scan = read_abw_scan(abw, scan_truth);
    SensorModel used = sensor;
    used.camera = *scan.camera;
    const std::vector<TrueObject> truth = check_truth(scan_truth, models, truth_file);
    std::vector<CellLabel> labels = true_labels(models, truth, used);
    const std::vector<int> first = number_faces(models, truth, labels);
    const auto regions = extract_regions(scan.image, used.camera, segmentation_options_for(sensor));
    const std::vector<RegionFace> paired = pair_regions_with_faces(regions, labels);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      std::vector<RegionFace> of_object;
      for (const RegionFace& pair : paired) {
        if (pair.face >= first[i] && pair.face < first[i + 1]) of_object.push_back({pair.region, pair.face - first[i]});
      }
      views[static_cast<std::size_t>(truth[i].object)].push_back(view_sample(regions, of_object));
    }
  }
  return views;
}

std::vector<ConstraintSubject> subjects_of(const CadModel& model, const std::vector<ViewSample>& samples,
                                           const std::vector<ViewSample>& held_out, const SensorModel& sensor,
                                           const DensityOptions& density) {
  Subjects subjects;
  add_views(model, sensor, samples, &AttributeSamples::samples, subjects);
  add_views(model, sensor, held_out, &AttributeSamples::held_out, subjects);

  CompiledModel compiled;
  compiled.faces.resize(model.faces.size());
  estimate_statistics(samples, density, compiled);
  for (std::size_t face = 0; face < compiled.faces.size(); ++face) {
    const auto found = subjects.find({1, {static_cast<int>(face)}});
    if (found != subjects.end()) set_densities(compiled.faces[face].densities, found->second);
  }
  for (const FacePair& pair : compiled.pairs)
    set_densities(pair.densities, subjects.at({2, {pair.first, pair.second}}));
  set_bin_widths(subjects);

  std::vector<ConstraintSubject> result;
  for (auto& [key, subject] : subjects) result.push_back(std::move(subject));
  return result;
}

}  // namespace foresight
