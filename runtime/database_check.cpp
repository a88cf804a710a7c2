#include "runtime/database_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include "common/errors.h"

namespace foresight {
namespace {

constexpr double kMassTolerance = 1e-3;     // masses are floats, up to some thousand of them
constexpr double kNormalTolerance = 1e-5;   // of doubles; template normals are floats and share it
constexpr double kLargestLength = 1e6;      // a kilometre; keeps products of lengths finite. Unit: mm.
constexpr std::size_t kMostFaces = 20000;   // of one model; the pair table of the runtime grows with their square
constexpr std::size_t kLongestName = 1000;  // Unit: bytes.

// Where in the file we are; texts are put together only when something is wrong.
struct Place {
  const std::string& file;
  const CompiledModel& model;
};

[[noreturn]] void refuse(const Place& place, const std::string& cause) {
  refuse_inconsistent(place.file, "model '" + place.model.name + "': " + cause);
}

void require(bool holds, const Place& place, const char* cause) {
  if (!holds) refuse(place, cause);
}

void require(bool holds, const Place& place, const char* list, std::size_t index, const char* cause) {
  if (!holds) refuse(place, std::string(list) + " " + std::to_string(index) + ": " + cause);
}

bool is_length(double value) { return std::abs(value) <= kLargestLength; }  // false for NaN

template <typename Vector>
bool is_position(const Vector& point) {
  return is_length(point.x()) && is_length(point.y()) && is_length(point.z());
}

template <typename Vector>
bool is_unit(const Vector& normal) {
  return std::abs(normal.template cast<double>().norm() - 1.0) <= kNormalTolerance;  // false for NaN
}

bool is_index(int index, std::size_t count) { return index >= 0 && static_cast<std::size_t>(index) < count; }

// Ascending, none twice, all below count.
bool are_indices(const std::vector<int>& indices, std::size_t count) {
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (!is_index(indices[i], count) || (i > 0 && indices[i] <= indices[i - 1])) return false;
  return true;
}

bool is_name(const std::string& name) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  return !name.empty() && name.size() <= kLongestName && std::none_of(name.begin(), name.end(), is_control);
}

bool is_digest(const std::string& text) {
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return text.empty() || (text.size() == 64 && std::all_of(text.begin(), text.end(), is_hex));
}

bool is_unit_of_length(const std::string& text) { return text == "mm" || text == "cm" || text == "m" || text == "in"; }

// What is wrong with a density, or nullptr.
const char* fault_of(const Density& density, const DensityOptions& options) {
  if (density.mass.empty()) return "is empty";
  if (!std::isfinite(density.lower)) return "has a lower edge that is not finite";
  if (!(density.bin_width > 0) || !std::isfinite(density.bin_width)) return "has a bin width that is not positive";
  // Smoothing reaches some standard deviations beyond the range, and the largest value opens one bin more.
  const auto reach = 1 + static_cast<std::ptrdiff_t>(std::ceil(10.0 * options.kernel));
  const std::ptrdiff_t first = density.first_bin;
  const auto size = static_cast<std::ptrdiff_t>(density.mass.size());
  if (first < -reach || size > options.bins + 2 * reach || first + size > options.bins + reach)
    return "has bins outside its range";
  double sum = 0.0;
  for (const float mass : density.mass) {
    if (!(mass >= 0.0F) || !std::isfinite(mass)) return "has a probability that is negative or not finite";
    sum += static_cast<double>(mass);
  }
  return std::abs(sum - 1.0) <= kMassTolerance ? nullptr : "does not sum to 1";
}

template <std::size_t count>
void check_densities(const std::array<Density, count>& densities, const std::array<const char*, count>& names,
                     const DensityOptions& options, const Place& place, const std::string& owner) {
  for (std::size_t k = 0; k < count; ++k)
    if (const char* fault = fault_of(densities[k], options))
      refuse(place, owner + ": the density of " + names[k] + " " + fault);
}

void check_description(const Place& place) {
  const CompiledModel& model = place.model;
  require(is_digest(model.cad_sha256), place, "cad_sha256 is not a digest of 64 hex digits");
  require(is_unit_of_length(model.cad_unit), place, "cad_unit is not mm, cm, m or in");
  require(model.diameter > 0 && is_length(model.diameter), place, "the diameter is not between 0 and a kilometre");
  require(is_position(model.centre), place, "the centre is not finite");
  require(model.views > 0, place, "it has no sample views");
}

void check_faces(const DensityOptions& options, const Place& place) {
  const CompiledModel& model = place.model;
  require(!model.faces.empty(), place, "it has no faces");
  require(model.faces.size() <= kMostFaces, place, "it has more than 20000 faces");
  const ModelFace* bins = nullptr;  // of the first face that has them
  for (std::size_t i = 0; i < model.faces.size(); ++i) {
    const ModelFace& face = model.faces[i];
    require(is_unit(face.normal), place, "face", i, "the normal is not of unit length");
    require(is_length(face.offset), place, "face", i, "the offset is not finite");
    require(is_position(face.centroid), place, "face", i, "the centroid is not finite");
    require(face.area >= 0 && std::isfinite(face.area), place, "face", i, "the area is negative or not finite");
    require(face.views_found >= 0 && face.views_found <= model.views, place, "face", i,
            "views_found is not between 0 and the number of views");
    if (face.views_found == 0) {
      for (const Density& density : face.densities)
        require(density.mass.empty(), place, "face", i, "it was never found, but has densities");
      continue;
    }
    check_densities(face.densities, kAttributeNames, options, place, "face " + std::to_string(i));
    if (bins == nullptr) bins = &face;
    for (std::size_t k = 0; k < face.densities.size(); ++k)
      require(face.densities[k].lower == bins->densities[k].lower &&
                  face.densities[k].bin_width == bins->densities[k].bin_width,
              place, "face", i, "its bins differ from those of other faces");
  }
}

void check_pairs(const DensityOptions& options, const Place& place) {
  const CompiledModel& model = place.model;
  for (std::size_t i = 0; i < model.pairs.size(); ++i) {
    const FacePair& pair = model.pairs[i];
    require(is_index(pair.first, model.faces.size()) && is_index(pair.second, model.faces.size()), place, "pair", i,
            "it names a face that does not exist");
    require(pair.first < pair.second, place, "pair", i, "first is not less than second");
    if (i > 0) {
      const FacePair& before = model.pairs[i - 1];
      require(std::pair(before.first, before.second) < std::pair(pair.first, pair.second), place, "pair", i,
              "pairs are not in ascending order");
    }
    const int most = std::min(model.faces[static_cast<std::size_t>(pair.first)].views_found,
                              model.faces[static_cast<std::size_t>(pair.second)].views_found);
    require(pair.views_found > 0 && pair.views_found <= most, place, "pair", i,
            "views_found is not between 1 and that of its faces");
    check_densities(pair.densities, kRelationNames, options, place, "pair " + std::to_string(i));
  }
}

void check_surface(const Place& place) {
  const SurfaceTemplate& surface = place.model.surface;
  const std::size_t faces = place.model.faces.size();
  require(surface.spacing > 0 && is_length(surface.spacing), place, "the spacing of the template is not positive");
  require(!surface.points.empty(), place, "the template has no points");
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const TemplatePoint& point = surface.points[i];
    require(is_position(point.position), place, "template point", i, "the position is not finite");
    require(is_unit(point.normal), place, "template point", i, "the normal is not of unit length");
    require(!point.faces.empty() && are_indices(point.faces, faces), place, "template point", i,
            "faces is not an ascending list of existing faces");
    require(are_indices(point.neighbours, surface.points.size()), place, "template point", i,
            "neighbours is not an ascending list of existing points");
    require(!std::binary_search(point.neighbours.begin(), point.neighbours.end(), static_cast<int>(i)), place,
            "template point", i, "it is its own neighbour");
  }
  for (std::size_t cell = 0; cell < surface.aspects.size(); ++cell)
    require(are_indices(surface.aspects[cell], faces), place, "aspect", cell,
            "it is not an ascending list of existing faces");
}

void check_mesh(const Place& place) {
  const CompiledModel& model = place.model;
  require(!model.vertices.empty() && !model.triangles.empty(), place, "it has no triangles");
  for (std::size_t i = 0; i < model.vertices.size(); ++i)
    require(is_position(model.vertices[i]), place, "vertex", i, "the position is not finite");
  for (std::size_t i = 0; i < model.triangles.size(); ++i)
    for (const int vertex : model.triangles[i])
      require(is_index(vertex, model.vertices.size()), place, "triangle", i, "it names a vertex that does not exist");
  if (model.triangle_faces.empty()) return;  // a database of an earlier compiler
  require(model.triangle_faces.size() == model.triangles.size(), place, "not every triangle has a face");
  for (std::size_t i = 0; i < model.triangles.size(); ++i)
    require(is_index(model.triangle_faces[i], model.faces.size()), place, "triangle", i,
            "it names a face that does not exist");
}

void check_acceptance(const Place& place) {
  const AcceptanceModel& acceptance = place.model.acceptance;
  require(acceptance.samples >= 0, place, "the acceptance model has too many samples");
  const auto finite = [](double weight) { return std::isfinite(weight); };
  require(std::all_of(acceptance.weights.begin(), acceptance.weights.end(), finite) && finite(acceptance.bias), place,
          "a weight of the acceptance model is not finite");
  for (const double least : {acceptance.least_quality, acceptance.least_probability})
    require(least >= 0.0 && least <= 1.0, place, "what the acceptance model asks of a start is outside 0 to 1");
}

void check_symmetries(const Place& place) {
  const std::vector<Symmetry>& symmetries = place.model.symmetries;
  const auto is_exact = [](const Symmetry& symmetry) { return symmetry.exact; };
  const auto exact = std::count_if(symmetries.begin(), symmetries.end(), is_exact);
  require(exact <= kMostExactSymmetries, place, "it has more than 512 exact symmetries");
  require(static_cast<std::ptrdiff_t>(symmetries.size()) - exact <= kMostNearSymmetries, place,
          "it has more than 32 near symmetries");
  require(std::is_partitioned(symmetries.begin(), symmetries.end(), is_exact), place,
          "the exact symmetries do not come first");
  for (std::size_t i = 0; i < symmetries.size(); ++i) {
    const Symmetry& symmetry = symmetries[i];
    require(is_rotation(symmetry.T_model_model.rotation), place, "symmetry", i, "it has no proper rotation");
    require(is_position(symmetry.T_model_model.translation), place, "symmetry", i, "the translation is not finite");
    require(symmetry.overlap >= 0.0 && symmetry.overlap <= 1.0, place, "symmetry", i, "the overlap is outside 0 to 1");
  }
}

void check_golden_scan(const PinholeCamera& camera, const Place& place) {
  if (!place.model.golden_scan) return;
  const GoldenScan& scan = *place.model.golden_scan;
  require(is_rotation(scan.T_sensor_model.rotation), place, "the golden scan has no proper rotation");
  require(is_position(scan.T_sensor_model.translation), place, "the translation of the golden scan is not finite");
  if (const char* fault = fault_of(scan, camera))
    refuse(place, std::string("the golden scan cannot be used: ") + fault);
}

void check_settings(const CompiledDatabase& database, const std::string& file) {
  try {
    check(database.sensor, file);
    check(database.segmentation);
    check(database.density);
  } catch (const Error& error) {
    refuse_inconsistent(file, "the settings inside are outside their limits: " + error.cause());
  }
}

}  // namespace

void refuse_inconsistent(const std::string& file, const std::string& cause) {
  throw DatabaseError(DatabaseFault::inconsistent, file, cause,
                      "compile it again; if this happens again, foresightc has a bug worth a report");
}

void check(const CompiledDatabase& database, const std::string& file) {
  check_settings(database, file);
  if (database.models.empty()) refuse_inconsistent(file, "the database holds no model");
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < database.models.size(); ++i) {
    const CompiledModel& model = database.models[i];
    if (!is_name(model.name))
      refuse_inconsistent(file,
                          "model " + std::to_string(i) + ": the name is empty, too long or has control characters");
    const Place place{file, model};
    require(names.insert(model.name).second, place, "two models have this name");
    check_description(place);
    check_faces(database.density, place);
    check_pairs(database.density, place);
    check_surface(place);
    check_mesh(place);
    check_acceptance(place);
    check_symmetries(place);
    check_golden_scan(database.sensor.camera, place);
  }
}

}  // namespace foresight
