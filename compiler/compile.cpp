#include "compiler/compile.h"

#include <algorithm>
#include <set>

#include "common/errors.h"
#include "compiler/golden_scan.h"
#include "compiler/near_symmetries.h"
#include "compiler/sensor_simulator.h"
#include "compiler/statistics.h"

namespace foresight {
namespace {

CompiledModel geometry_of(const CadModel& cad) {
  CompiledModel model;
  model.name = cad.name;
  model.diameter = cad.diameter();
  model.centre = 0.5 * (cad.lowest() + cad.highest());
  for (const CadFace& face : cad.faces) {
    ModelFace& added = model.faces.emplace_back();
    added.normal = face.normal;
    added.offset = face.offset;
    added.centroid = face.centroid;
    added.area = face.area;
  }
  for (const Eigen::Vector3d& vertex : cad.vertices) model.vertices.push_back(vertex.cast<float>());
  model.triangles = cad.triangles;
  model.triangle_faces = cad.triangle_face;
  return model;
}

bool finds_a_face(const CompiledModel& model) {
  return std::any_of(model.faces.begin(), model.faces.end(), [](const ModelFace& face) { return face.views_found > 0; });
}

void refuse_different(const CompiledDatabase& first, const NamedDatabase& other, const std::string& first_file) {
  const auto refuse = [&](bool same, const std::string& what) {
    if (same) return;
    throw DatabaseError(DatabaseFault::incompatible, other.file, what + " differs from that of " + first_file,
                        "compile both with the same sensor file, options and version of foresightc");
  };
  refuse(first.sensor == other.database.sensor, "the sensor");
  refuse(first.segmentation == other.database.segmentation, "the extraction settings");
  refuse(first.density == other.database.density, "the density settings");
  refuse(first.tool_version == other.database.tool_version, "the compiler version");
  refuse(first.ray_isa == other.database.ray_isa, "the instruction set of the rays");
}

}  // namespace

CompiledModel compile_model(const CadModel& cad, const SensorModel& sensor, const CompileOptions& options,
                            const std::function<void(int)>& progress,
                            const std::function<void(const char*)>& finished) {
  const auto end = [&](const char* stage) {
    if (finished) finished(stage);
  };
  CompiledModel model = geometry_of(cad);
  auto samples = sample_views(cad, sensor, segmentation_options_for(sensor), options.samples, progress);
  keep_faces_found_most(samples, options.most_faces);
  end("views");
  estimate_statistics(samples, options.density, model);
  end("statistics");
  if (!finds_a_face(model)) return model;  // nothing to learn from: callers refuse it
  SurfaceTemplateOptions surface = options.surface;
  surface.distance = sensor.working_distance();
  model.surface = build_surface_template(cad, surface);
  end("template");
  model.symmetries = list_symmetries(cad, sensor);
  end("symmetries");
  const CompiledDatabase settings = new_database(sensor, options);
  model.acceptance = train_acceptance(cad, model, settings, options.acceptance);
  end("acceptance");
  model.golden_scan = choose_golden_scan(cad, model, settings);
  end("golden scan");
  return model;
}

CompiledDatabase new_database(const SensorModel& sensor, const CompileOptions& options) {
  return {FORESIGHT_VERSION, ray_isa(), sensor, segmentation_options_for(sensor), options.density, {}};
}

CompiledDatabase link_databases(std::vector<NamedDatabase> parts) {
  CompiledDatabase linked = std::move(parts.front().database);
  std::set<std::string> names;
  for (const CompiledModel& model : linked.models) names.insert(model.name);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    refuse_different(linked, parts[i], parts.front().file);
    for (CompiledModel& model : parts[i].database.models) {
      if (!names.insert(model.name).second) {
        throw DatabaseError(DatabaseFault::incompatible, parts[i].file, "an object named " + model.name + " is there already",
                            "name each object once, see foresightc compile --name");
      }
      linked.models.push_back(std::move(model));
    }
  }
  return linked;
}

}  // namespace foresight
