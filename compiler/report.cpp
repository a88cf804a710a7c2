#include "compiler/report.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <sstream>

namespace foresight {
namespace {

using Json = nlohmann::ordered_json;

int faces_found(const CompiledModel& model) {
  int found = 0;
  for (const ModelFace& face : model.faces) found += face.views_found > 0 ? 1 : 0;
  return found;
}

std::ptrdiff_t exact_symmetries(const CompiledModel& model) {
  return std::count_if(model.symmetries.begin(), model.symmetries.end(), [](const Symmetry& s) { return s.exact; });
}

std::ptrdiff_t near_symmetries(const CompiledModel& model) {
  return static_cast<std::ptrdiff_t>(model.symmetries.size()) - exact_symmetries(model);
}

std::size_t golden_scan_bytes(const CompiledModel& model) {
  return model.golden_scan ? model.golden_scan->depths.size() : 0;
}

std::string golden_scan_text(const CompiledModel& model) {
  return model.golden_scan ? "golden scan of " + std::to_string(golden_scan_bytes(model)) + " bytes" : "no golden scan";
}

Json sensor_json(const SensorModel& sensor) {
  const PinholeCamera& camera = sensor.camera;
  Json json = {{"name", sensor.name},
               {"camera", {{"rows", camera.rows}, {"columns", camera.columns}, {"fx", camera.fx}, {"fy", camera.fy}, {"cx", camera.cx}, {"cy", camera.cy}}},
               {"nearest_distance_mm", sensor.nearest_distance},
               {"farthest_distance_mm", sensor.farthest_distance},
               {"depth_quantization_mm", sensor.depth_quantization},
               {"depth_noise_mm", sensor.depth_noise},
               {"largest_incidence_rad", sensor.largest_incidence},
               {"background", sensor.background}};
  if (sensor.projector) json["projector_mm"] = {sensor.projector->x(), sensor.projector->y(), sensor.projector->z()};
  if (sensor.matching_window != 1) json["matching_window_cells"] = sensor.matching_window;
  return json;
}

Json model_json(const CompiledModel& model) {
  Json faces = Json::array();
  for (const ModelFace& face : model.faces) {
    faces.push_back({{"area_mm2", face.area},
                     {"normal", {face.normal.x(), face.normal.y(), face.normal.z()}},
                     {"views_found", face.views_found}});
  }
  return {{"object", model.name},
          {"cad_file", model.cad_file},
          {"cad_sha256", model.cad_sha256},
          {"cad_unit", model.cad_unit},
          {"diameter_mm", model.diameter},
          {"views", model.views},
          {"face_pairs", model.pairs.size()},
          {"template_points", model.surface.points.size()},
          {"template_spacing_mm", model.surface.spacing},
          {"exact_symmetries", exact_symmetries(model)},
          {"near_symmetries", near_symmetries(model)},
          {"faces", faces},
          {"golden_scan_bytes", golden_scan_bytes(model)}};
}

}  // namespace

std::string report_text(const CompiledDatabase& database, std::size_t bytes) {
  std::ostringstream out;
  const SensorModel& sensor = database.sensor;
  out << "compiled by foresightc " << database.tool_version << ", rays cast with " << database.ray_isa << ", " << bytes << " bytes\n"
      << "sensor " << sensor.name << ": " << sensor.camera.rows << " x " << sensor.camera.columns << " cells, "
      << sensor.nearest_distance << " to " << sensor.farthest_distance << " mm, noise " << sensor.depth_noise
      << " mm, depth step " << sensor.depth_quantization << " mm\n"
      << "extraction: plane sigma " << database.segmentation.plane_sigma << " mm, seed block "
      << database.segmentation.seed_block << " cells, smallest region " << database.segmentation.smallest_region << " cells\n"
      << "densities: " << database.density.bins << " bins, kernel " << database.density.kernel << " bins\n";
  for (const CompiledModel& model : database.models) {
    out << "object " << model.name << ": " << model.faces.size() << " faces (" << faces_found(model)
        << " found by extraction), " << model.pairs.size() << " pairs seen together, " << model.surface.points.size()
        << " template points, " << exact_symmetries(model) << " exact and " << near_symmetries(model)
        << " near symmetries, " << golden_scan_text(model) << ", diameter " << model.diameter << " mm, " << model.views << " views, from "
        << model.cad_file << "\n";
  }
  return out.str();
}

std::string report_json(const CompiledDatabase& database, std::size_t bytes) {
  Json models = Json::array();
  for (const CompiledModel& model : database.models) models.push_back(model_json(model));
  const SegmentationOptions& s = database.segmentation;
  const Json json = {{"tool_version", database.tool_version},
                     {"ray_isa", database.ray_isa},
                     {"bytes", bytes},
                     {"sensor", sensor_json(database.sensor)},
                     {"segmentation", {{"plane_sigma_mm", s.plane_sigma}, {"merge_tolerance", s.merge_tolerance}, {"grow_tolerance", s.grow_tolerance}, {"seed_block", s.seed_block}, {"smallest_region", s.smallest_region}, {"largest_depth_step", s.largest_depth_step}}},
                     {"density", {{"bins", database.density.bins}, {"kernel", database.density.kernel}}},
                     {"objects", models}};
  return json.dump(2) + "\n";
}

}  // namespace foresight
