#include "compiler/cad_model.h"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/IO/reader/OFFReader.hh>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "common/errors.h"
#include "compiler/flat_vertices.h"
#include "compiler/solid_check.h"
#include "compiler/triangle_mesh.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

// Takes what OpenMesh's readers find as it is. Its own importer drops faces and splits vertices where a mesh is not
// manifold; here the faults must arrive to be named.
class SoupImporter : public OpenMesh::IO::ImporterT<OpenMesh::PolyMesh_ArrayKernelT<>> {
 public:
  using Base = OpenMesh::IO::ImporterT<OpenMesh::PolyMesh_ArrayKernelT<>>;
  // most: more vertices or faces than this the file cannot hold, whatever its header promises.
  explicit SoupImporter(std::size_t most) : Base(unused_), most_(most) {}

  OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3f& point) override {
    return add(Vector3d(point[0], point[1], point[2]));
  }
  OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3d& point) override {
    return add(Vector3d(point[0], point[1], point[2]));
  }
  OpenMesh::VertexHandle add_vertex() override { return add(Vector3d::Zero()); }
  void set_point(OpenMesh::VertexHandle vertex, const OpenMesh::Vec3f& point) override {
    if (is_vertex(vertex))
      mesh.vertices[static_cast<std::size_t>(vertex.idx())] = Vector3d(point[0], point[1], point[2]);
  }
  OpenMesh::FaceHandle add_face(const VHandles& corners) override {
    if (++faces_ > most_) throw std::length_error("more faces than the file has bytes");
    if (!std::all_of(corners.begin(), corners.end(), [this](auto v) { return is_vertex(v); })) {
      ++faces_without_vertices;
      return OpenMesh::FaceHandle();
    }
    std::vector<Vector3d> polygon;
    for (const auto corner : corners) polygon.push_back(mesh.vertices[static_cast<std::size_t>(corner.idx())]);
    for (const Triangle& t : triangulate(polygon)) {
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) triangle[k] = corners[static_cast<std::size_t>(t[k])].idx();
      mesh.triangles.push_back(triangle);
    }
    return OpenMesh::FaceHandle(static_cast<int>(faces_) - 1);
  }
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle, const std::vector<OpenMesh::Vec2f>&) override {}
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle, const std::vector<OpenMesh::Vec3f>&) override {}
  void reserve(unsigned, unsigned, unsigned) override {}  // a damaged header may promise billions
  std::size_t n_vertices() const override { return mesh.vertices.size(); }
  std::size_t n_faces() const override { return faces_; }

  TriangleMesh mesh;
  int faces_without_vertices = 0;

 private:
  OpenMesh::VertexHandle add(const Vector3d& point) {
    if (mesh.vertices.size() >= most_) throw std::length_error("more vertices than the file has bytes");
    mesh.vertices.push_back(point);
    return OpenMesh::VertexHandle(static_cast<int>(mesh.vertices.size()) - 1);
  }
  bool is_vertex(OpenMesh::VertexHandle v) const {
    return v.is_valid() && v.idx() < static_cast<int>(mesh.vertices.size());
  }

  OpenMesh::PolyMesh_ArrayKernelT<> unused_;
  std::size_t most_;
  std::size_t faces_ = 0;
};

// Two significant digits at least, never an exponent for the lengths objects have.
std::string two_digits(double value) {
  std::ostringstream text;
  if (value >= 10.0 && value < 1e15) {
    text << static_cast<std::int64_t>(std::llround(value));
  } else {
    text.precision(2);
    text << value;
  }
  return text.str();
}

std::string lower_extension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void check_file(const std::string& file) {
  const std::string extension = lower_extension(file);
  if (!std::filesystem::exists(file)) throw InputError(file, "there is no such file", "check the path");
  if (std::filesystem::is_directory(file)) throw InputError(file, "is a folder", "name a CAD file in it");
  if (extension != ".obj" && extension != ".stl" && extension != ".ply" && extension != ".off") {
    throw InputError(file, "is not a kind of CAD file known here", "export it as .obj, .stl, .ply or .off");
  }
  if (!std::ifstream(file)) throw InputError(file, "cannot be opened", "check its permissions");
  if (std::filesystem::file_size(file) == 0) throw InputError(file, "is empty", "export it again");
}

// OFF as OpenMesh takes it: without comments.
std::string without_comments(std::istream& text) {
  std::string kept;
  for (std::string line; std::getline(text, line);) {
    line.erase(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") != std::string::npos) kept += line + "\n";
  }
  return kept;
}

// OpenMesh's OFF and PLY readers do not look for the end of the file between the corners of a face: there a stream
// that throws stops them. The other two read line by line.
bool read_with_openmesh(const std::string& file, const std::string& extension, SoupImporter& importer) {
  OpenMesh::IO::Options options;
  if (extension != ".off" && extension != ".ply") return OpenMesh::IO::IOManager().read(file, importer, options);
  OpenMesh::IO::BaseReader& reader = extension == ".off"
                                         ? static_cast<OpenMesh::IO::BaseReader&>(OpenMesh::IO::OFFReader())
                                         : OpenMesh::IO::PLYReader();
  if (!reader.can_u_read(file)) return false;
  std::ifstream content(file, std::ios::binary);
  std::string first_line;
  std::getline(content, first_line);
  content.clear();
  content.seekg(0);
  const bool text_off = extension == ".off" && first_line.find("BINARY") == std::string::npos;
  std::istringstream text(text_off ? without_comments(content) : std::string());
  std::istream& stream = text_off ? static_cast<std::istream&>(text) : content;
  stream.exceptions(std::ios::failbit | std::ios::badbit);
  return reader.read(stream, importer, options);
}

TriangleMesh read_soup(const std::string& file) {
  static std::mutex one_reader;  // OpenMesh's readers are single objects with a state
  const std::lock_guard lock(one_reader);
  omerr().disable();  // its messages name neither file nor mend
  omlog().disable();
  SoupImporter importer(std::filesystem::file_size(file));
  bool read = false;
  try {
    read = read_with_openmesh(file, lower_extension(file), importer);
  } catch (const std::exception&) {  // the file ends too early, or its header promises more than it holds
    read = false;
  }
  if (!read)
    throw InputError(file, "its content is damaged, cut short or not what its extension says",
                     "export it again, perhaps in another of the formats .obj, .stl, .ply, .off");
  if (importer.faces_without_vertices > 0) {
    throw InputError(file,
                     std::to_string(importer.faces_without_vertices) +
                         " of its faces name vertices that are not in the file or are not numbers",
                     "export it again");
  }
  for (std::size_t i = 0; i < importer.mesh.vertices.size(); ++i) {
    if (!importer.mesh.vertices[i].allFinite()) {
      throw InputError(file, "vertex " + std::to_string(i + 1) + " has a coordinate that is not a finite number",
                       "export it again");
    }
  }
  return std::move(importer.mesh);
}

}  // namespace

Vector3d CadModel::lowest() const {
  assert(!vertices.empty());
  return std::accumulate(vertices.begin(), vertices.end(), vertices.front(),
                         [](const Vector3d& a, const Vector3d& b) -> Vector3d { return a.cwiseMin(b); });
}

Vector3d CadModel::highest() const {
  assert(!vertices.empty());
  return std::accumulate(vertices.begin(), vertices.end(), vertices.front(),
                         [](const Vector3d& a, const Vector3d& b) -> Vector3d { return a.cwiseMax(b); });
}

// Pairs in order of their distance from the centre, until no further pair can be longer: exact, and rarely quadratic.
double CadModel::diameter() const {
  const Vector3d centre = 0.5 * (lowest() + highest());
  std::vector<std::pair<double, Vector3d>> outermost;
  for (const Vector3d& v : vertices) outermost.emplace_back((v - centre).norm(), v);
  std::stable_sort(outermost.begin(), outermost.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  double longest = 0.0;
  for (std::size_t i = 0; i < outermost.size() && 2.0 * outermost[i].first > longest; ++i) {
    for (std::size_t j = i + 1; j < outermost.size() && outermost[i].first + outermost[j].first > longest; ++j) {
      longest = std::max(longest, (outermost[i].second - outermost[j].second).norm());
    }
  }
  return longest;
}

CadModel read_cad_model(const std::string& file, const CadReadOptions& options) {
  assert(options.unit_mm > 0.0);
  check_file(file);
  TriangleMesh mesh = read_soup(file);
  if (mesh.triangles.empty())
    throw InputError(file, "no triangles could be read from it", "export the surface of the object again");
  CadModel model;
  model.name = std::filesystem::path(file).stem().string();
  model.repairs = check_solid(file, mesh);
  model.vertices = std::move(mesh.vertices);
  for (Vector3d& v : model.vertices) v *= options.unit_mm;
  model.triangles = std::move(mesh.triangles);
  find_planar_faces(model, options);
  drop_flat_vertices(model, options);
  return model;
}

void check_size(const CadModel& model, const std::string& file, double unit_mm, double field_of_view) {
  struct Unit {
    const char *flag, *name;
    double mm;
  };
  constexpr Unit units[] = {
      {"mm", "millimetres", 1.0}, {"m", "metres", 1000.0}, {"in", "inches", 25.4}, {"cm", "centimetres", 10.0}};
  const double diameter = model.diameter();
  const auto fits = [field_of_view](double length) {
    return length >= 0.02 * field_of_view && length <= field_of_view;
  };
  if (fits(diameter)) return;
  std::ostringstream cause, mend;
  cause << "the object is " << two_digits(diameter) << " mm in diameter, "
        << two_digits(100.0 * diameter / field_of_view) << " % of the field of view (" << std::round(field_of_view)
        << " mm)";
  for (const Unit& unit : units) {
    const double length = diameter / unit_mm * unit.mm;
    if (!fits(length)) continue;
    mend << (mend.tellp() > 0 ? ", or if in " : "if the file is in ") << unit.name << ", pass --unit " << unit.flag
         << " (" << two_digits(length) << " mm)";
  }
  if (mend.tellp() <= 0) mend << "scale the object, or use a sensor whose field of view suits it";
  throw InputError(file, cause.str(), mend.str());
}

}  // namespace foresight
