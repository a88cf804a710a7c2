// A loaded database: everything recognition needs, checked, immutable.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/compiled_model.h"

namespace foresight {

// Decodes and validates: container, version, then content (indices, sizes, finite numbers, unit normals, histogram
// mass). `file` names the source in errors. Throws DatabaseError with its fault.
[[nodiscard]] CompiledDatabase decode_database(std::string_view bytes, const std::string& file);

// The foresight.v1.SensorModel in these bytes, its values as they are (check() is the caller's); none when they are no
// such message.
[[nodiscard]] std::optional<SensorModel> decode_sensor(std::string_view bytes);

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
  // P(f_R|M_j) over all four attributes. Bins span the range of their model, and the mass of a wide bin does not
  // compare with that of a narrow one; so each factor is the probability of a bin as wide as the widest loaded, taking
  // the density as even around the value: min(1, mass * widest bin / own bin). With one model, or equal ranges, this is
  // the plain product of masses.
  [[nodiscard]] double likelihood(int index, const AttributeVector& attributes) const;
  // The pair statistics of two faces of one model, or nullptr when never seen together. Order does not matter.
  [[nodiscard]] const FacePair* pair(int model, int face_a, int face_b) const;

 private:
  CompiledDatabase content_;
  std::vector<FaceIndex> faces_;
  double total_views_found_ = 0.0;
  std::vector<std::array<double, kAttributeCount>> widenings_;  // by model: widest bin loaded / own bin
  std::vector<std::vector<int>> found_rank_;  // by model, by face: rank among the faces found, -1 = never found
  std::vector<std::vector<int>> pair_table_;  // by model: lower triangle over ranks, index into pairs, -1 = none
};

// Throws InputError when the file cannot be read, DatabaseError when its content cannot be used.
[[nodiscard]] Database load_database(const std::string& file);

}  // namespace foresight
