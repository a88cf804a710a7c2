#include "compiler/cad_model.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <OpenMesh/Core/IO/MeshIO.hh>
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
#include <numeric>
#include <sstream>

#include "common/errors.h"
#include "compiler/mesh_bodies.h"
#include "compiler/triangle_mesh.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

// Takes what OpenMesh's readers find as it is. Its own importer drops faces and splits vertices where a mesh is not
// manifold; here the faults must arrive to be named.
class SoupImporter : public OpenMesh::IO::ImporterT<OpenMesh::PolyMesh_ArrayKernelT<>> {
 public:
  using Base = OpenMesh::IO::ImporterT<OpenMesh::PolyMesh_ArrayKernelT<>>;
  SoupImporter() : Base(unused_) {}

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
    ++faces_;
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
    mesh.vertices.push_back(point);
    return OpenMesh::VertexHandle(static_cast<int>(mesh.vertices.size()) - 1);
  }
  bool is_vertex(OpenMesh::VertexHandle v) const {
    return v.is_valid() && v.idx() < static_cast<int>(mesh.vertices.size());
  }

  OpenMesh::PolyMesh_ArrayKernelT<> unused_;
  std::size_t faces_ = 0;
};

std::string count_of(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string position_text(const Vector3d& p) {
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
}

void check_file(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!std::filesystem::exists(file)) throw InputError(file, "there is no such file", "check the path");
  if (std::filesystem::is_directory(file)) throw InputError(file, "is a folder", "name a CAD file in it");
  if (extension != ".obj" && extension != ".stl" && extension != ".ply" && extension != ".off") {
    throw InputError(file, "is not a kind of CAD file known here", "export it as .obj, .stl, .ply or .off");
  }
  if (!std::ifstream(file)) throw InputError(file, "cannot be opened", "check its permissions");
  if (std::filesystem::file_size(file) == 0) throw InputError(file, "is empty", "export it again");
}

TriangleMesh read_soup(const std::string& file) {
  omerr().disable();  // its messages name neither file nor mend
  omlog().disable();
  SoupImporter importer;
  OpenMesh::IO::Options options;
  bool read = false;
  try {
    read = OpenMesh::IO::IOManager().read(file, importer, options);
  } catch (const std::exception&) {  // a damaged header can make a reader ask for more memory than there is
    read = false;
  }
  if (!read) throw InputError(file, "its content is damaged or not what its extension says", "export it again");
  if (importer.faces_without_vertices > 0) {
    throw InputError(file,
                     count_of(static_cast<std::size_t>(importer.faces_without_vertices), "face refers", "faces refer") +
                         " to vertices that are not in the file",
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

// Welds and drops what can be mended without changing the surface; says what it did.
std::vector<std::string> clean(TriangleMesh& mesh) {
  std::vector<std::string> repairs;
  const auto note = [&repairs](int count, const std::string& verb, const std::string& one, const std::string& many) {
    if (count > 0) repairs.push_back(verb + " " + count_of(static_cast<std::size_t>(count), one, many));
  };
  drop_unused_vertices(mesh);
  note(weld_vertices(mesh, weld_tolerance(mesh)), "welded", "duplicate vertex", "duplicate vertices");
  note(drop_degenerate_triangles(mesh), "dropped", "degenerate triangle", "degenerate triangles");
  note(drop_duplicate_triangles(mesh), "dropped", "duplicate triangle", "duplicate triangles");
  drop_unused_vertices(mesh);
  return repairs;
}

bool is_flat(const TriangleMesh& mesh) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& v : mesh.vertices) mean += v / static_cast<double>(mesh.vertices.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& v : mesh.vertices) spread += (v - mean) * (v - mean).transpose();
  const Vector3d eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
  return eigenvalues[0] <= 1e-12 * eigenvalues[2];
}

// True when a vertex lies in the middle of one of these edges. A bounded search: it only sharpens a message.
bool has_t_junction(const TriangleMesh& mesh, const std::vector<EdgeUse>& open) {
  const std::size_t searched = std::min<std::size_t>(open.size(), 2000);
  const double tolerance = 10.0 * weld_tolerance(mesh);
  for (std::size_t e = 0; e < searched; ++e) {
    const Vector3d& a = mesh.vertices[static_cast<std::size_t>(open[e].low)];
    const Vector3d along = mesh.vertices[static_cast<std::size_t>(open[e].high)] - a;
    const double length = along.norm();
    for (std::size_t o = 0; o < searched; ++o) {
      const Vector3d to = mesh.vertices[static_cast<std::size_t>(open[o].low)] - a;
      const double place = to.dot(along) / length;
      if (place > tolerance && place < length - tolerance && (to - along * (place / length)).norm() <= tolerance)
        return true;
    }
  }
  return false;
}

// Every edge must have exactly two triangles.
void check_closed(const std::string& file, const TriangleMesh& mesh) {
  std::vector<EdgeUse> open, crowded;
  const std::vector<EdgeUse> uses = edge_uses(mesh.triangles);
  for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
    while (end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high) ++end;
    if (end - i == 1) open.push_back(uses[i]);
    if (end - i > 2) crowded.push_back(uses[i]);
  }
  const auto middle = [&mesh](const EdgeUse& edge) {
    const Vector3d sum =
        mesh.vertices[static_cast<std::size_t>(edge.low)] + mesh.vertices[static_cast<std::size_t>(edge.high)];
    return position_text(0.5 * sum);
  };
  std::string cause, mend;
  if (!open.empty()) {
    const bool split = has_t_junction(mesh, open);
    cause = "the surface is not closed: " + count_of(open.size(), "open edge", "open edges") + ", the first at " +
            middle(open.front()) + " in the file's unit" +
            (split ? "; some have a vertex in their middle (T-junctions) that the neighbouring triangle does not share"
                   : "");
    mend = split ? "let the CAD program split the triangles at these vertices when it exports"
                 : "close the holes in the CAD program";
  }
  if (!crowded.empty()) {
    cause += (cause.empty() ? "the surface is not manifold: " : "; and ") +
             count_of(crowded.size(), "edge is", "edges are") +
             " shared by more than two triangles (non-manifold), the first at " + middle(crowded.front()) +
             " in the file's unit";
    if (mend.empty()) mend = "join touching bodies, or leave a gap between them, in the CAD program";
  }
  if (!cause.empty()) throw InputError(file, cause, mend);
}

// Turns all triangles so that they face outward, those of voids into the void; says what it did.
std::vector<std::string> turn_outward(const std::string& file, TriangleMesh& mesh) {
  const std::optional<Bodies> bodies = orient_bodies(mesh);
  if (!bodies) {
    throw InputError(file, "its triangles cannot be turned to agree on one outside (the surface is one-sided)",
                     "repair the surface in the CAD program");
  }
  std::vector<std::string> repairs;
  if (bodies->turned > 0) {
    repairs.push_back("turned " +
                      count_of(static_cast<std::size_t>(bodies->turned), "triangle that faces", "triangles that face") +
                      " another way than the neighbours");
  }
  const std::vector<double> volumes = body_volumes(mesh, *bodies);
  const std::vector<int> depths = nesting_depths(mesh, *bodies);
  const double tolerance = weld_tolerance(mesh);
  std::size_t turned = 0, voids = 0;
  for (int b = 0; b < bodies->count; ++b) {
    const auto body = static_cast<std::size_t>(b);
    if (std::abs(volumes[body]) <= tolerance * tolerance * tolerance) {
      throw InputError(file, "a body of it has no volume", "give it a thickness or delete it in the CAD program");
    }
    const bool is_void = depths[body] % 2 == 1;
    if ((volumes[body] > 0.0) != is_void) continue;
    turn_body(mesh, *bodies, b);
    ++(is_void ? voids : turned);
  }
  if (turned > 0) repairs.push_back("turned " + count_of(turned, "body that was", "bodies that were") + " inside out");
  if (voids > 0) {
    repairs.push_back("took " + count_of(voids, "body", "bodies") + " inside another for " +
                      (voids == 1 ? "a void" : "voids"));
  }
  return repairs;
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
    throw InputError(file, "there are no triangles in it", "export the surface of the object");
  CadModel model;
  model.name = std::filesystem::path(file).stem().string();
  model.repairs = clean(mesh);
  if (mesh.triangles.empty() || is_flat(mesh)) {
    throw InputError(file, "the object is flat: it has no volume", "give it a thickness in the CAD program");
  }
  check_closed(file, mesh);
  const std::vector<std::string> turned = turn_outward(file, mesh);
  model.repairs.insert(model.repairs.end(), turned.begin(), turned.end());
  model.vertices = std::move(mesh.vertices);
  for (Vector3d& v : model.vertices) v *= options.unit_mm;
  model.triangles = std::move(mesh.triangles);
  find_planar_faces(model, options);
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
  cause.precision(2);
  cause << "the object is " << (diameter >= 100.0 ? std::round(diameter) : diameter) << " mm in diameter, "
        << 100.0 * diameter / field_of_view << " % of the field of view (" << std::round(field_of_view) << " mm)";
  for (const Unit& unit : units) {
    if (!fits(diameter / unit_mm * unit.mm)) continue;
    mend << (mend.tellp() > 0 ? ", or if in " : "if the file is in ") << unit.name << ", pass --unit " << unit.flag;
  }
  if (mend.tellp() <= 0) mend << "scale the object, or use a sensor whose field of view suits it";
  throw InputError(file, cause.str(), mend.str());
}

}  // namespace foresight
