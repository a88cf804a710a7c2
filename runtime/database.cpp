#include "runtime/database.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "foresight/v1/database.pb.h"
#include "runtime/database_check.h"
#include "schema/container.h"

namespace foresight {
namespace {

constexpr double kRightAngle = 1.5707963267948966;  // rad

template <typename Message>
bool parse(std::string_view bytes, Message& message) {
  return bytes.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max()) &&
         message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

Eigen::Vector3d from_message(const v1::Vector3& v) { return {v.x(), v.y(), v.z()}; }

SensorModel from_message(const v1::SensorModel& message) {
  SensorModel sensor;
  const v1::Camera& camera = message.camera();
  sensor.name = message.name();
  sensor.camera = {camera.rows(), camera.columns(), camera.fx(), camera.fy(), camera.cx(), camera.cy()};
  if (message.has_projector_mm()) sensor.projector = from_message(message.projector_mm());
  sensor.nearest_distance = message.nearest_distance_mm();
  sensor.farthest_distance = message.farthest_distance_mm();
  sensor.depth_quantization = message.depth_quantization_mm();
  sensor.depth_noise = message.depth_noise_mm();
  sensor.largest_incidence = message.has_largest_incidence_deg() ? message.largest_incidence_deg() / 90.0 * kRightAngle
                                                                 : message.largest_incidence_rad();
  sensor.background = message.background();
  if (message.matching_window_cells() != 0) sensor.matching_window = message.matching_window_cells();
  return sensor;
}

SegmentationOptions from_message(const v1::SegmentationOptions& message) {
  SegmentationOptions options;
  options.plane_sigma = message.plane_sigma();
  options.merge_tolerance = message.merge_tolerance();
  options.grow_tolerance = message.grow_tolerance();
  options.seed_block = message.seed_block();
  options.smallest_region = message.smallest_region();
  options.largest_depth_step = message.largest_depth_step();
  return options;
}

Density from_message(const v1::Density& message) {
  Density density;
  density.lower = message.lower();
  density.bin_width = message.bin_width();
  density.first_bin = message.first_bin();
  density.mass.assign(message.mass().begin(), message.mass().end());
  return density;
}

std::array<Density, kAttributeCount> from_message(const v1::AttributeDensities& message) {
  std::array<Density, kAttributeCount> densities;
  densities[kArea] = from_message(message.area());
  densities[kMaxSecondMoment] = from_message(message.max_second_moment());
  densities[kMinSecondMoment] = from_message(message.min_second_moment());
  densities[kMaxDiameter] = from_message(message.max_diameter());
  return densities;
}

std::array<Density, kRelationCount> from_message(const v1::RelationDensities& message) {
  std::array<Density, kRelationCount> densities;
  densities[kOrientation] = from_message(message.relative_orientation());
  densities[kMaxDistance] = from_message(message.max_distance());
  return densities;
}

// Numbers beyond int become negative here, and are refused as counts or indices out of range.
int to_int(std::uint32_t number) { return static_cast<int>(number); }

ModelFace from_message(const v1::ModelFace& message) {
  ModelFace face;
  face.normal = from_message(message.normal());
  face.offset = message.offset();
  face.centroid = from_message(message.centroid());
  face.area = message.area();
  face.views_found = to_int(message.views_found());
  if (message.has_densities()) face.densities = from_message(message.densities());
  return face;
}

using Numbers = google::protobuf::RepeatedField<std::uint32_t>;
using Reals = google::protobuf::RepeatedField<float>;

// Cuts the numbers of all lists in a row into lists.
class Lists {
 public:
  Lists(const Numbers& counts, const Numbers& numbers) : count_(counts.begin()), number_(numbers.begin()) {}
  [[nodiscard]] static bool fit(const Numbers& counts, const Numbers& numbers, int lists) {
    return counts.size() == lists && std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}) ==
                                         static_cast<std::uint64_t>(numbers.size());
  }
  [[nodiscard]] std::vector<int> next() {
    const auto end = number_ + static_cast<std::ptrdiff_t>(*count_++);
    std::vector<int> list(number_, end);
    number_ = end;
    return list;
  }

 private:
  Numbers::const_iterator count_, number_;
};

// REQUIRES: size of flat a multiple of three.
std::vector<Eigen::Vector3f> triples(const Reals& flat) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(static_cast<std::size_t>(flat.size()) / 3);
  for (int i = 0; i + 2 < flat.size(); i += 3) points.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  return points;
}

// None when the lengths of the lists do not fit together.
std::optional<SurfaceTemplate> from_message(const v1::SurfaceTemplate& message) {
  const int points = message.positions_size() / 3;
  if (message.positions_size() % 3 != 0 || message.normals_size() != message.positions_size() ||
      !Lists::fit(message.face_counts(), message.faces(), points) ||
      !Lists::fit(message.neighbour_counts(), message.neighbours(), points) ||
      !Lists::fit(message.aspect_counts(), message.aspect_faces(), kAspectCells))
    return std::nullopt;
  SurfaceTemplate surface;
  surface.spacing = message.spacing();
  surface.points.resize(static_cast<std::size_t>(points));
  const std::vector<Eigen::Vector3f> positions = triples(message.positions()), normals = triples(message.normals());
  Lists faces(message.face_counts(), message.faces()), neighbours(message.neighbour_counts(), message.neighbours());
  for (std::size_t i = 0; i < surface.points.size(); ++i)
    surface.points[i] = {positions[i], normals[i], faces.next(), neighbours.next()};
  Lists aspects(message.aspect_counts(), message.aspect_faces());
  for (std::vector<int>& aspect : surface.aspects) aspect = aspects.next();
  return surface;
}

// All zero where the message is absent.
AcceptanceModel from_message(const v1::AcceptanceModel& message) {
  AcceptanceModel acceptance;
  acceptance.weights[kOwnedShare] = message.owned_share();
  acceptance.weights[kContradictedShare] = message.contradicted_share();
  acceptance.weights[kMissing] = message.missing();
  acceptance.weights[kHiddenShare] = message.hidden_share();
  acceptance.weights[kFoundFaces] = message.found_faces();
  acceptance.weights[kAmount] = message.amount();
  acceptance.weights[kOtherSurfaces] = message.other_surfaces();
  acceptance.weights[kHiddenBehindOne] = message.hidden_behind_one();
  acceptance.bias = message.bias();
  acceptance.least_quality = message.least_quality();
  acceptance.least_probability = message.least_probability();
  acceptance.samples = to_int(message.samples());
  return acceptance;
}

// Of a message with rotation and translation. REQUIRES: nine numbers in the rotation.
template <typename Message>
Pose pose_in(const Message& message) {
  Pose pose;
  for (int i = 0; i < 9; ++i) pose.rotation(i / 3, i % 3) = message.rotation(i);
  pose.translation = from_message(message.translation());
  return pose;
}

// REQUIRES: nine numbers in the rotation.
Symmetry from_message(const v1::Symmetry& message) {
  Symmetry symmetry;
  symmetry.T_model_model = pose_in(message);
  symmetry.exact = message.exact();
  symmetry.overlap = message.overlap();
  return symmetry;
}

// REQUIRES: nine numbers in the rotation.
GoldenScan from_message(const v1::GoldenScan& message) {
  GoldenScan scan;
  scan.first_row = to_int(message.first_row());
  scan.first_column = to_int(message.first_column());
  scan.rows = to_int(message.rows());
  scan.columns = to_int(message.columns());
  scan.depth_step = message.depth_step();
  scan.depths = message.depths();
  scan.T_sensor_model = pose_in(message);
  return scan;
}

CompiledModel from_message(const v1::Model& message, const std::string& file) {
  CompiledModel model;
  model.name = message.name();
  model.cad_file = message.cad_file();
  model.cad_sha256 = message.cad_sha256();
  model.cad_unit = message.cad_unit();
  model.diameter = message.diameter();
  model.centre = from_message(message.centre());
  model.views = to_int(message.views());
  model.faces.reserve(static_cast<std::size_t>(message.faces_size()));
  for (const v1::ModelFace& face : message.faces()) model.faces.push_back(from_message(face));
  model.pairs.reserve(static_cast<std::size_t>(message.pairs_size()));
  for (const v1::FacePair& pair : message.pairs())
    model.pairs.push_back(
        {to_int(pair.first()), to_int(pair.second()), to_int(pair.views_found()), from_message(pair.densities())});
  std::optional<SurfaceTemplate> surface = from_message(message.surface());
  if (!surface) refuse_inconsistent(file, "model '" + model.name + "': the lists of the template do not fit together");
  model.surface = std::move(*surface);
  if (message.vertices_size() % 3 != 0 || message.triangles_size() % 3 != 0)
    refuse_inconsistent(file, "model '" + model.name + "': a vertex or triangle is incomplete");
  model.vertices = triples(message.vertices());
  const auto corner = [&](int i) { return to_int(message.triangles(i)); };
  model.triangles.reserve(static_cast<std::size_t>(message.triangles_size()) / 3);
  for (int i = 0; i < message.triangles_size(); i += 3)
    model.triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
  model.triangle_faces.reserve(static_cast<std::size_t>(message.triangle_faces_size()));
  for (const std::uint32_t face : message.triangle_faces()) model.triangle_faces.push_back(to_int(face));
  model.acceptance = from_message(message.acceptance());
  for (const v1::Symmetry& symmetry : message.symmetries()) {
    if (symmetry.rotation_size() != 9)
      refuse_inconsistent(file, "model '" + model.name + "': the rotation of a symmetry has not nine numbers");
    model.symmetries.push_back(from_message(symmetry));
  }
  if (message.has_golden_scan()) {
    if (message.golden_scan().rotation_size() != 9)
      refuse_inconsistent(file, "model '" + model.name + "': the rotation of the golden scan has not nine numbers");
    model.golden_scan = from_message(message.golden_scan());
  }
  return model;
}

v1::Header parse_header(const std::vector<SectionView>& sections, const std::string& file) {
  v1::Header header;
  if (sections.empty() || sections.front().name != "header" || !parse(sections.front().content, header))
    refuse_inconsistent(file, "the database does not begin with a header");
  if (header.schema_version() > kSchemaVersion)
    throw DatabaseError(DatabaseFault::newer_version, file,
                        "the file has schema version " + std::to_string(header.schema_version()) +
                            ", this program knows " + std::to_string(kSchemaVersion),
                        "use a newer foresight, or compile the database again with the foresightc of this version");
  if (header.schema_version() == 0) refuse_inconsistent(file, "the header has no schema version");
  return header;
}

}  // namespace

std::optional<SensorModel> decode_sensor(std::string_view bytes) {
  v1::SensorModel message;
  if (!parse(bytes, message)) return std::nullopt;
  return from_message(message);
}

CompiledDatabase decode_database(std::string_view bytes, const std::string& file) {
  const std::vector<SectionView> sections = decode_container(bytes, file);
  const v1::Header header = parse_header(sections, file);
  CompiledDatabase database;
  database.tool_version = header.tool_version();
  database.ray_isa = header.ray_isa();
  database.sensor = from_message(header.sensor());
  database.segmentation = from_message(header.segmentation());
  database.density = {header.density().bins(), header.density().kernel()};
  for (const SectionView& section : sections) {
    if (section.name != "model") continue;  // the header, or something a later writer added that we may skip
    v1::Model message;
    if (!parse(section.content, message))
      refuse_inconsistent(file, "model " + std::to_string(database.models.size()) + " cannot be parsed");
    database.models.push_back(from_message(message, file));
  }
  if (database.models.size() != header.model_count())
    refuse_inconsistent(file, "the header counts " + std::to_string(header.model_count()) + " models, the file has " +
                                  std::to_string(database.models.size()));
  check(database, file);
  return database;
}

Database load_database(const std::string& file) { return Database(decode_database(read_whole_file(file), file)); }

namespace {

// Index into the lower triangle of a symmetric table. REQUIRES: 0 <= low < high.
std::size_t triangle_index(int high, int low) {
  const auto h = static_cast<std::size_t>(high);
  return h * (h - 1) / 2 + static_cast<std::size_t>(low);
}

// Width of the bins all faces of a model share; 0 when none was ever found.
std::array<double, kAttributeCount> bin_widths(const CompiledModel& model) {
  std::array<double, kAttributeCount> widths{};
  const auto found =
      std::find_if(model.faces.begin(), model.faces.end(), [](const ModelFace& face) { return face.views_found > 0; });
  if (found == model.faces.end()) return widths;
  for (std::size_t k = 0; k < widths.size(); ++k) widths[k] = found->densities[k].bin_width;
  return widths;
}

// Models whose faces were found have positive widths; the others have no entry in faces() that could ask.
std::vector<std::array<double, kAttributeCount>> widenings(const std::vector<CompiledModel>& models) {
  std::array<double, kAttributeCount> widest{};
  std::vector<std::array<double, kAttributeCount>> widths;
  for (const CompiledModel& model : models) {
    widths.push_back(bin_widths(model));
    for (std::size_t k = 0; k < widest.size(); ++k) widest[k] = std::max(widest[k], widths.back()[k]);
  }
  for (auto& own : widths)
    for (std::size_t k = 0; k < own.size(); ++k) own[k] = own[k] > 0 ? widest[k] / own[k] : 1.0;
  return widths;
}

std::vector<int> pair_table(const CompiledModel& model, const std::vector<int>& rank, int found) {
  std::vector<int> table(found > 0 ? triangle_index(found, 0) : 0, -1);
  for (std::size_t i = 0; i < model.pairs.size(); ++i) {
    const FacePair& pair = model.pairs[i];  // ranks ascend with faces, so second has the higher one
    const int high = rank[static_cast<std::size_t>(pair.second)], low = rank[static_cast<std::size_t>(pair.first)];
    assert(high > low && low >= 0);
    table[triangle_index(high, low)] = static_cast<int>(i);
  }
  return table;
}

}  // namespace

Database::Database(CompiledDatabase content) : content_(std::move(content)), widenings_(widenings(content_.models)) {
  for (int m = 0; m < static_cast<int>(content_.models.size()); ++m) {
    const CompiledModel& model = content_.models[static_cast<std::size_t>(m)];
    std::vector<int> rank(model.faces.size(), -1);
    int found = 0;
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      if (model.faces[f].views_found == 0) continue;
      rank[f] = found++;
      faces_.push_back({m, static_cast<int>(f)});
      total_views_found_ += model.faces[f].views_found;
    }
    pair_table_.push_back(pair_table(model, rank, found));
    found_rank_.push_back(std::move(rank));
  }
}

const ModelFace& Database::face(int index) const {
  const FaceIndex at = faces_[static_cast<std::size_t>(index)];
  return content_.models[static_cast<std::size_t>(at.model)].faces[static_cast<std::size_t>(at.face)];
}

double Database::prior(int index, double background_prior) const {
  return (1.0 - background_prior) * face(index).views_found / total_views_found_;
}

double Database::likelihood(int index, const AttributeVector& attributes) const {
  const auto& widening = widenings_[static_cast<std::size_t>(faces_[static_cast<std::size_t>(index)].model)];
  const ModelFace& model_face = face(index);
  double product = 1.0;
  for (std::size_t k = 0; k < attributes.size(); ++k)
    product *= std::min(1.0, model_face.densities[k].probability(attributes[k]) * widening[k]);
  return product;
}

const FacePair* Database::pair(int model, int face_a, int face_b) const {
  const auto m = static_cast<std::size_t>(model);
  const std::vector<int>& rank = found_rank_[m];
  const int a = rank[static_cast<std::size_t>(face_a)], b = rank[static_cast<std::size_t>(face_b)];
  if (a < 0 || b < 0 || a == b) return nullptr;
  const int index = pair_table_[m][triangle_index(std::max(a, b), std::min(a, b))];
  return index < 0 ? nullptr : &content_.models[m].pairs[static_cast<std::size_t>(index)];
}

}  // namespace foresight
