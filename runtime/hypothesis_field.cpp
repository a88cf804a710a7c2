#include "runtime/hypothesis_field.h"

#include <cassert>
#include <cmath>

#include "common/relation_attributes.h"

namespace foresight {
namespace {

// 1-clique potential minus log-likelihood of the observation: the terms of eq. (3) that one match decides alone.
std::array<double, 2> unary_energies(const Match& match, double prior, PriorSign sign) {
  // Paper: V = +log P(M) when ON and +log(1 - P(M)) when OFF. Here by default with a minus, because U is minimised.
  const double factor = sign == PriorSign::minus_log ? -1.0 : 1.0;
  return {factor * std::log1p(-prior) - match.log_likelihood_off, factor * std::log(prior) - match.log_likelihood_on};
}

// The rule of eq. (2). A relation without samples in training has zero probability.
bool consistent(const Database& database, const FaceIndex& a, const FaceIndex& b, const RelationVector& relation) {
  // The paper asks only for a positive probability. One region cannot be two faces and, as faces are maximal planar
  // patches, one face is rarely two regions: distinct faces keep two halves of one face from making a pose.
  if (a.model != b.model || a.face == b.face) return false;
  const FacePair* pair = database.pair(a.model, a.face, b.face);
  if (pair == nullptr) return false;
  for (int k = 0; k < kRelationCount; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (!(pair->densities[at].probability(relation[at]) > 0.0)) return false;
  }
  return true;
}

// Adds the supporting pairs between the matches of two regions. Both lists ascend, so faces of one model stand together
// in the same order: walk both at once, model by model.
void link_regions(HypothesisField& field, const PoolVector<int>& of_a, const PoolVector<int>& of_b,
                  const RelationVector& relation, const Database& database) {
  const auto face_of = [&](int match) -> const FaceIndex& {
    return database.faces()[static_cast<std::size_t>(field.matches[static_cast<std::size_t>(match)].face)];
  };
  std::size_t first = 0;  // of of_b with a model not below that of a
  for (const int a : of_a) {
    const FaceIndex& face_a = face_of(a);
    while (first < of_b.size() && face_of(of_b[first]).model < face_a.model) ++first;
    for (std::size_t i = first; i < of_b.size() && face_of(of_b[i]).model == face_a.model; ++i) {
      const int b = of_b[i];
      if (!consistent(database, face_a, face_of(b), relation)) continue;
      field.supports[static_cast<std::size_t>(a)].push_back(b);
      field.supports[static_cast<std::size_t>(b)].push_back(a);
    }
  }
}

double support_energy(const HypothesisField& field, const PoolVector<Label>& labels) {
  double sum = 0.0;
  for (std::size_t a = 0; a < labels.size(); ++a) {
    for (const int neighbour : field.supports[a]) {
      const auto b = static_cast<std::size_t>(neighbour);
      if (b < a || labels[a] != labels[b]) continue;
      sum += labels[a] == kOn ? field.potentials.support_on_on : field.potentials.support_off_off;
    }
  }
  return sum;
}

double contradiction_energy(const HypothesisField& field, const PoolVector<Label>& labels) {
  double sum = 0.0;
  for (const PoolVector<int>& region : field.by_region) {
    double on = 0.0;
    for (const int match : region) on += labels[static_cast<std::size_t>(match)] == kOn ? 1.0 : 0.0;
    const double off = static_cast<double>(region.size()) - on;
    sum += on * (on - 1.0) / 2.0 * field.potentials.contradiction_on_on;
    sum += on * off * field.potentials.contradiction_on_off;
  }
  return sum;
}

}  // namespace

HypothesisField build_hypothesis_field(const PoolVector<DescribedRegion>& regions, const PoolVector<Match>& matches,
                                       const Database& database, const BackgroundOptions& background,
                                       const Potentials& potentials) {
  HypothesisField field;
  field.matches = matches;
  field.potentials = potentials;
  field.supports.resize(matches.size());
  field.by_region.resize(regions.size());
  field.unary.reserve(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double prior = database.prior(matches[i].face, background.prior);
    field.unary.push_back(unary_energies(matches[i], prior, potentials.prior_sign));
    field.by_region[static_cast<std::size_t>(matches[i].region)].push_back(static_cast<int>(i));
  }
  for (std::size_t a = 0; a < regions.size(); ++a) {
    if (field.by_region[a].empty()) continue;
    for (std::size_t b = a + 1; b < regions.size(); ++b) {
      if (field.by_region[b].empty()) continue;
      link_regions(field, field.by_region[a], field.by_region[b], relate(regions[a], regions[b]), database);
    }
  }
  return field;
}

double energy(const HypothesisField& field, const PoolVector<Label>& labels) {
  assert(labels.size() == field.matches.size());
  double unaries = 0.0;
  for (std::size_t i = 0; i < labels.size(); ++i) unaries += field.unary[i][labels[i]];
  return unaries + support_energy(field, labels) + contradiction_energy(field, labels);
}

}  // namespace foresight
