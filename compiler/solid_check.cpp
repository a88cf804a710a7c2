#include "compiler/solid_check.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "common/errors.h"
#include "compiler/mesh_bodies.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

std::string count_of(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string position_text(const Vector3d& p) {
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
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
    const auto holds = [&](int vertex) {
      const Vector3d to = mesh.vertices[static_cast<std::size_t>(vertex)] - a;
      const double place = to.dot(along) / length;
      return place > tolerance && place < length - tolerance && (to - along * (place / length)).norm() <= tolerance;
    };
    for (std::size_t o = 0; o < searched; ++o) {
      if (holds(open[o].low) || holds(open[o].high)) return true;
    }
  }
  return false;
}

// Edges that do not have exactly two triangles: one use of each.
struct EdgeFaults {
  std::vector<EdgeUse> open, crowded;
};

EdgeFaults find_edge_faults(const TriangleMesh& mesh) {
  EdgeFaults faults;
  const std::vector<EdgeUse> uses = edge_uses(mesh.triangles);
  for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
    while (end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high) ++end;
    if (end - i == 1) faults.open.push_back(uses[i]);
    if (end - i > 2) faults.crowded.push_back(uses[i]);
  }
  return faults;
}

// Welds and drops what can be mended without changing the surface; says what it did.
std::vector<std::string> clean(TriangleMesh& mesh) {
  std::vector<std::string> repairs;
  const auto note = [&repairs](int count, const std::string& verb, const std::string& one, const std::string& many) {
    if (count > 0) repairs.push_back(verb + " " + count_of(static_cast<std::size_t>(count), one, many));
  };
  drop_unused_vertices(mesh);
  // A mesh that is closed as it stands keeps its vertices: bodies that only touch along an edge stay apart.
  const EdgeFaults faults = find_edge_faults(mesh);
  const bool closed = faults.open.empty() && faults.crowded.empty();
  if (!closed) note(weld_vertices(mesh, weld_tolerance(mesh)), "welded", "duplicate vertex", "duplicate vertices");
  note(drop_degenerate_triangles(mesh), "dropped", "degenerate triangle", "degenerate triangles");
  note(drop_duplicate_triangles(mesh), "dropped", "duplicate triangle", "duplicate triangles");
  drop_unused_vertices(mesh);
  return repairs;
}

void check_closed(const std::string& file, const TriangleMesh& mesh) {
  const auto [open, crowded] = find_edge_faults(mesh);
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

std::vector<std::string> check_solid(const std::string& file, TriangleMesh& mesh) {
  std::vector<std::string> repairs = clean(mesh);
  if (mesh.triangles.empty() || is_flat(mesh)) {
    throw InputError(file, "the object is flat: it has no volume", "give it a thickness in the CAD program");
  }
  check_closed(file, mesh);
  const std::vector<std::string> turned = turn_outward(file, mesh);
  repairs.insert(repairs.end(), turned.begin(), turned.end());
  return repairs;
}

}  // namespace foresight
