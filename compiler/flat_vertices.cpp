#include "compiler/flat_vertices.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "compiler/triangle_mesh.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

constexpr double kTrusted = 1e-6;          // of the object's size: what coordinates of CAD files are good for
constexpr std::size_t kFewTriangles = 10;  // about a vertex that goes first: fans of hundreds are dear, and needles

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Collapses edges (Hoppe, "Progressive Meshes", 1996), those alone whose collapse moves no surface.
class FlatVertices {
 public:
  FlatVertices(CadModel& model, const CadReadOptions& options) : model_(model), around_(model.vertices.size()) {
    const double trusted = kTrusted * (model.highest() - model.lowest()).norm();
    straight_ = trusted;
    lowest_ = std::min(trusted / options.coplanar_angle, options.coplanar_distance);
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
      for (const int corner : model.triangles[t]) around_[at(corner)].push_back(static_cast<int>(t));
    }
  }

  // In rounds, in each of which no two neighbours go: fans stay small and triangles round.
  int run() {
    int gone = 0;
    for (const std::size_t most : {kFewTriangles, std::numeric_limits<std::size_t>::max()}) {
      for (int in_round = -1; in_round != 0; gone += in_round) in_round = round(most);
    }
    keep_the_rest();
    return gone;
  }

 private:
  // The vertices that one could go to, those along the edge where two faces meet; none where it must stay.
  [[nodiscard]] std::vector<int> ways(int vertex) const {
    const std::span<const int> fan = around_[at(vertex)];
    const auto face = [&](int t) { return model_.triangle_face[at(t)]; };
    std::array<int, 2> faces = {face(fan.front()), face(fan.front())};
    for (const int t : fan) {
      if (face(t) == faces[0] || face(t) == faces[1]) continue;
      if (faces[0] != faces[1]) return {};
      faces[1] = face(t);
    }
    const std::vector<int> all = neighbours(vertex);
    if (all.size() != fan.size()) return {};
    if (faces[0] == faces[1]) return all;
    std::vector<int> edge;
    for (const int other : all) {
      const auto [first, second] = across(vertex, other);
      if (second >= 0 && face(first) != face(second)) edge.push_back(other);
    }
    return edge.size() == 2 && is_between(vertex, edge[0], edge[1]) ? edge : std::vector<int>();
  }

  [[nodiscard]] bool is_between(int vertex, int a, int b) const {
    const Vector3d along = place(b) - place(a);
    const Vector3d to = place(vertex) - place(a);
    const double share = to.dot(along) / along.squaredNorm();
    return share > 0.0 && share < 1.0 && (to - share * along).norm() <= straight_;
  }

  // Ascending.
  [[nodiscard]] std::vector<int> neighbours(int vertex) const {
    std::vector<int> all;
    for (const int t : around_[at(vertex)]) {
      for (const int corner : model_.triangles[at(t)]) {
        if (corner != vertex) all.push_back(corner);
      }
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  // The two triangles at an edge; -1 for the second where they are not two.
  [[nodiscard]] std::pair<int, int> across(int a, int b) const {
    std::array<int, 2> found = {-1, -1};
    std::size_t count = 0;
    for (const int t : around_[at(a)]) {
      const Triangle& corners = model_.triangles[at(t)];
      if (std::find(corners.begin(), corners.end(), b) == corners.end()) continue;
      if (count < 2) found[count] = t;
      ++count;
    }
    return {found[0], count == 2 ? found[1] : -1};
  }

  [[nodiscard]] const Vector3d& place(int vertex) const { return model_.vertices[at(vertex)]; }

  // The least height of the triangles about a vertex once it has gone to another, over their longest sides; negative
  // where one would be turned over, a needle, or the surface no longer closed.
  [[nodiscard]] double roundness(int vertex, int to) const {
    const std::vector<int> of_vertex = neighbours(vertex), of_other = neighbours(to);
    std::vector<int> shared;
    std::set_intersection(of_vertex.begin(), of_vertex.end(), of_other.begin(), of_other.end(),
                          std::back_inserter(shared));
    if (shared.size() != 2 || across(vertex, to).second < 0) return -1.0;
    double least = std::numeric_limits<double>::infinity();
    for (const int t : around_[at(vertex)]) {
      Triangle corners = model_.triangles[at(t)];
      if (std::find(corners.begin(), corners.end(), to) != corners.end()) continue;
      std::replace(corners.begin(), corners.end(), vertex, to);
      const Vector3d ab = place(corners[1]) - place(corners[0]), ac = place(corners[2]) - place(corners[0]);
      const double longest = std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()}));
      const double height = ab.cross(ac).dot(model_.faces[at(model_.triangle_face[at(t)])].normal) / longest;
      if (!(height > lowest_)) return -1.0;
      least = std::min(least, height / longest);
    }
    return least;
  }

  int round(std::size_t most) {
    std::vector<bool> touched(model_.vertices.size(), false);
    int gone = 0;
    for (int vertex = 0; vertex < static_cast<int>(model_.vertices.size()); ++vertex) {
      if (touched[at(vertex)] || around_[at(vertex)].empty() || around_[at(vertex)].size() > most) continue;
      int best = -1;
      double roundest = 0.0;
      for (const int to : ways(vertex)) {
        const double round = roundness(vertex, to);
        if (round <= roundest) continue;
        roundest = round;
        best = to;
      }
      if (best < 0) continue;
      for (const int neighbour : neighbours(vertex)) touched[at(neighbour)] = true;
      collapse(vertex, best);
      ++gone;
    }
    return gone;
  }

  void collapse(int vertex, int to) {
    const std::vector<int> fan = std::move(around_[at(vertex)]);
    around_[at(vertex)].clear();
    for (const int t : fan) {
      Triangle& corners = model_.triangles[at(t)];
      if (std::find(corners.begin(), corners.end(), to) == corners.end()) {
        std::replace(corners.begin(), corners.end(), vertex, to);
        around_[at(to)].push_back(t);
        continue;
      }
      for (const int corner : corners) std::erase(around_[at(corner)], t);
      corners = {-1, -1, -1};
    }
  }

  void keep_the_rest() {
    std::erase_if(model_.triangles, [](const Triangle& triangle) { return triangle[0] < 0; });
    std::vector<int> new_place(model_.vertices.size(), -1);
    int kept = 0;
    for (std::size_t v = 0; v < model_.vertices.size(); ++v) {
      if (around_[v].empty()) continue;
      new_place[v] = kept;
      model_.vertices[at(kept++)] = model_.vertices[v];
    }
    model_.vertices.resize(at(kept));
    for (Triangle& triangle : model_.triangles) {
      for (int& corner : triangle) corner = new_place[at(corner)];
    }
  }

  CadModel& model_;
  std::vector<std::vector<int>> around_;  // triangles about each vertex, none of one that is gone
  double straight_ = 0.0;                 // Unit: mm.
  double lowest_ = 0.0;                   // lower triangles are needles. Unit: mm.
};

}  // namespace

int drop_flat_vertices(CadModel& model, const CadReadOptions& options) {
  assert(model.triangle_face.size() == model.triangles.size());
  const int gone = FlatVertices(model, options).run();
  if (gone > 0) find_planar_faces(model, options);
  return gone;
}

}  // namespace foresight
