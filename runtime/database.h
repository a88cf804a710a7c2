// A loaded database: everything recognition needs, checked, immutable.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/compiled_model.h"

namespace foresight {

// Decodes and validates: container, version, then content (indices, sizes, finite numbers, unit normals, histogram mass).
// `file` names the source in errors. Throws DatabaseError with its fault.
[[nodiscard]] CompiledDatabase decode_database(std::string_view bytes, const std::string& file);

// One face of one model, numbered through the whole database.
struct FaceIndex {
  int model = 0;
  int face = 0;
};

class Database {
 public:
  // REQUIRES: content as decode_database returns it.
  explicit Database(CompiledDatabase content);

  [[nodiscard]] const CompiledDatabase& content() const { return content_; }
  [[nodiscard]] const std::vector<CompiledModel>& models() const { return content_.models; }
  // All faces of all models, model by model: the M_j of Section IV. Faces never found by extraction are left out.
  [[nodiscard]] const std::vector<FaceIndex>& faces() const { return faces_; }
  [[nodiscard]] const ModelFace& face(int index) const;
  // P(M_j), normalised over all loaded faces: sum over j P(M_j) = 1 - background_prior (Section IV.A).
  [[nodiscard]] double prior(int index, double background_prior) const;
  // P(f_R|M_j) over all four attributes, as probability of bins of common width (each model's bins are rescaled to the widest range loaded).
  [[nodiscard]] double likelihood(int index, const AttributeVector& attributes) const;
  // The pair statistics of two faces of one model, or nullptr when never seen together. Order does not matter.
  [[nodiscard]] const FacePair* pair(int model, int face_a, int face_b) const;

 private:
  CompiledDatabase content_;
  std::vector<FaceIndex> faces_;
  double total_views_found_ = 0.0;
  std::array<double, kAttributeCount> widest_range_{};
  std::vector<std::vector<int>> pair_table_;  // by model: faces*faces indices into pairs, -1 = none
};

[[nodiscard]] Database load_database(const std::string& file);

}  // namespace foresight
