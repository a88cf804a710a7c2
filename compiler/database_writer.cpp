#include "compiler/database_writer.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "common/errors.h"
#include "foresight/v1/database.pb.h"
#include "schema/container.h"

namespace foresight {
namespace {

void fill(v1::Vector3& message, const Eigen::Vector3d& v) {
  message.set_x(v.x());
  message.set_y(v.y());
  message.set_z(v.z());
}

void fill(v1::SensorModel& message, const SensorModel& sensor) {
  v1::Camera& camera = *message.mutable_camera();
  camera.set_rows(sensor.camera.rows);
  camera.set_columns(sensor.camera.columns);
  camera.set_fx(sensor.camera.fx);
  camera.set_fy(sensor.camera.fy);
  camera.set_cx(sensor.camera.cx);
  camera.set_cy(sensor.camera.cy);
  message.set_name(sensor.name);
  if (sensor.projector) fill(*message.mutable_projector_mm(), *sensor.projector);
  message.set_nearest_distance_mm(sensor.nearest_distance);
  message.set_farthest_distance_mm(sensor.farthest_distance);
  message.set_depth_quantization_mm(sensor.depth_quantization);
  message.set_depth_noise_mm(sensor.depth_noise);
  message.set_largest_incidence_rad(sensor.largest_incidence);
  message.set_background(sensor.background);
  // 1 is what a reader takes an absent one for: databases of other sensors keep their bytes.
  if (sensor.matching_window != 1) message.set_matching_window_cells(sensor.matching_window);
}

void fill(v1::SegmentationOptions& message, const SegmentationOptions& options) {
  message.set_plane_sigma(options.plane_sigma);
  message.set_merge_tolerance(options.merge_tolerance);
  message.set_grow_tolerance(options.grow_tolerance);
  message.set_seed_block(options.seed_block);
  message.set_smallest_region(options.smallest_region);
  message.set_largest_depth_step(options.largest_depth_step);
}

void fill(v1::Density& message, const Density& density) {
  message.set_lower(density.lower);
  message.set_bin_width(density.bin_width);
  message.set_first_bin(density.first_bin);
  message.mutable_mass()->Add(density.mass.begin(), density.mass.end());
}

void fill(v1::ModelFace& message, const ModelFace& face) {
  fill(*message.mutable_normal(), face.normal);
  message.set_offset(face.offset);
  fill(*message.mutable_centroid(), face.centroid);
  message.set_area(face.area);
  message.set_views_found(static_cast<std::uint32_t>(face.views_found));
  if (face.views_found == 0) return;
  v1::AttributeDensities& densities = *message.mutable_densities();
  fill(*densities.mutable_area(), face.densities[kArea]);
  fill(*densities.mutable_max_second_moment(), face.densities[kMaxSecondMoment]);
  fill(*densities.mutable_min_second_moment(), face.densities[kMinSecondMoment]);
  fill(*densities.mutable_max_diameter(), face.densities[kMaxDiameter]);
}

void fill(v1::FacePair& message, const FacePair& pair) {
  message.set_first(static_cast<std::uint32_t>(pair.first));
  message.set_second(static_cast<std::uint32_t>(pair.second));
  message.set_views_found(static_cast<std::uint32_t>(pair.views_found));
  fill(*message.mutable_densities()->mutable_relative_orientation(), pair.densities[kOrientation]);
  fill(*message.mutable_densities()->mutable_max_distance(), pair.densities[kMaxDistance]);
}

using Numbers = google::protobuf::RepeatedField<std::uint32_t>;
using Reals = google::protobuf::RepeatedField<float>;

void append(Numbers& counts, Numbers& numbers, const std::vector<int>& list) {
  counts.Add(static_cast<std::uint32_t>(list.size()));
  for (const int number : list) numbers.Add(static_cast<std::uint32_t>(number));
}

void append(Reals& reals, const Eigen::Vector3f& point) { reals.Add(point.data(), point.data() + 3); }

void fill(v1::SurfaceTemplate& message, const SurfaceTemplate& surface) {
  message.set_spacing(surface.spacing);
  for (const TemplatePoint& point : surface.points) {
    append(*message.mutable_positions(), point.position);
    append(*message.mutable_normals(), point.normal);
    append(*message.mutable_face_counts(), *message.mutable_faces(), point.faces);
    append(*message.mutable_neighbour_counts(), *message.mutable_neighbours(), point.neighbours);
  }
  for (const std::vector<int>& aspect : surface.aspects)
    append(*message.mutable_aspect_counts(), *message.mutable_aspect_faces(), aspect);
}

void fill(v1::AcceptanceModel& message, const AcceptanceModel& acceptance) {
  message.set_owned_share(acceptance.weights[kOwnedShare]);
  message.set_contradicted_share(acceptance.weights[kContradictedShare]);
  message.set_missing(acceptance.weights[kMissing]);
  message.set_hidden_share(acceptance.weights[kHiddenShare]);
  message.set_found_faces(acceptance.weights[kFoundFaces]);
  message.set_amount(acceptance.weights[kAmount]);
  message.set_other_surfaces(acceptance.weights[kOtherSurfaces]);
  message.set_hidden_behind_one(acceptance.weights[kHiddenBehindOne]);
  message.set_bias(acceptance.bias);
  message.set_least_quality(acceptance.least_quality);
  message.set_least_probability(acceptance.least_probability);
  message.set_samples(static_cast<std::uint32_t>(acceptance.samples));
}

// Messages that hold a pose have it in fields of these names.
template <typename Message>
void fill_pose(Message& message, const Pose& pose) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) message.add_rotation(pose.rotation(row, column));
  }
  fill(*message.mutable_translation(), pose.translation);
}

void fill(v1::Symmetry& message, const Symmetry& symmetry) {
  fill_pose(message, symmetry.T_model_model);
  message.set_exact(symmetry.exact);
  message.set_overlap(symmetry.overlap);
}

void fill(v1::GoldenScan& message, const GoldenScan& scan) {
  message.set_first_row(static_cast<std::uint32_t>(scan.first_row));
  message.set_first_column(static_cast<std::uint32_t>(scan.first_column));
  message.set_rows(static_cast<std::uint32_t>(scan.rows));
  message.set_columns(static_cast<std::uint32_t>(scan.columns));
  message.set_depth_step(scan.depth_step);
  message.set_depths(scan.depths);
  fill_pose(message, scan.T_sensor_model);
}

void fill(v1::Model& message, const CompiledModel& model) {
  message.set_name(model.name);
  message.set_cad_file(model.cad_file);
  message.set_cad_sha256(model.cad_sha256);
  message.set_cad_unit(model.cad_unit);
  message.set_diameter(model.diameter);
  fill(*message.mutable_centre(), model.centre);
  message.set_views(static_cast<std::uint32_t>(model.views));
  for (const ModelFace& face : model.faces) fill(*message.add_faces(), face);
  for (const FacePair& pair : model.pairs) fill(*message.add_pairs(), pair);
  for (const Symmetry& symmetry : model.symmetries) fill(*message.add_symmetries(), symmetry);
  fill(*message.mutable_surface(), model.surface);
  for (const Eigen::Vector3f& vertex : model.vertices) append(*message.mutable_vertices(), vertex);
  for (const std::array<int, 3>& triangle : model.triangles)
    for (const int vertex : triangle) message.add_triangles(static_cast<std::uint32_t>(vertex));
  for (const int face : model.triangle_faces) message.add_triangle_faces(static_cast<std::uint32_t>(face));
  if (model.acceptance.samples > 0) fill(*message.mutable_acceptance(), model.acceptance);
  if (model.golden_scan) fill(*message.mutable_golden_scan(), *model.golden_scan);
}

// Protocol Buffers promise the same bytes for the same message from one build of the library as long as no map is in
// it.
template <typename Message>
std::string serialize(const Message& message, const std::string& name) {
  std::string bytes;
  if (message.ByteSizeLong() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw InputError(name, "the compiled model is larger than 2 GB", "simplify the CAD model or widen the spacing");
  message.SerializeToString(&bytes);
  return bytes;
}

// Length of the UTF-8 sequence these bytes begin with, 0 when they begin with none (RFC 3629).
std::size_t utf8_length(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U; };
  const auto follows = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xBF) {
    return byte(i) >= low && byte(i) <= high;
  };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) return follows(1) ? 2 : 0;
  if (lead >= 0xE0 && lead <= 0xEF)  // neither over-long nor a surrogate
    return follows(1, lead == 0xE0 ? 0xA0 : 0x80, lead == 0xED ? 0x9F : 0xBF) && follows(2) ? 3 : 0;
  if (lead >= 0xF0 && lead <= 0xF4)  // neither over-long nor beyond U+10FFFF
    return follows(1, lead == 0xF0 ? 0x90 : 0x80, lead == 0xF4 ? 0x8F : 0xBF) && follows(2) && follows(3) ? 4 : 0;
  return 0;
}

bool is_utf8(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t length = utf8_length(bytes);
    if (length == 0) return false;
    bytes.remove_prefix(length);
  }
  return true;
}

void check_names(const CompiledModel& model) {
  for (const std::string& name : {model.name, model.cad_file})
    if (!is_utf8(name)) throw InputError(name, "the name is not UTF-8 text", "rename the CAD file, or name the object");
}

}  // namespace

std::string encode_database(const CompiledDatabase& database) {
  v1::Header header;
  header.set_schema_version(kSchemaVersion);
  header.set_tool_version(database.tool_version);
  header.set_ray_isa(database.ray_isa);
  fill(*header.mutable_sensor(), database.sensor);
  fill(*header.mutable_segmentation(), database.segmentation);
  header.mutable_density()->set_bins(database.density.bins);
  header.mutable_density()->set_kernel(database.density.kernel);
  header.set_model_count(static_cast<std::uint32_t>(database.models.size()));

  std::vector<Section> sections;
  sections.push_back({"header", serialize(header, "header")});
  for (const CompiledModel& model : database.models) {
    check_names(model);
    v1::Model message;
    fill(message, model);
    sections.push_back({"model", serialize(message, model.name)});
  }
  return encode_container(sections);
}

}  // namespace foresight
