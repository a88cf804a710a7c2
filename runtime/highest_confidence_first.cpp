#include "runtime/highest_confidence_first.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace foresight {
namespace {

// Below this the change of a committed label gains nothing but rounding error, and could be taken back for ever.
constexpr double kLeastGain = 1e-9;

// Order of decision: least stability first; at equal stability the uncommitted first, so that none is left over when
// stability reaches zero; then the lowest match, so that the result is the same everywhere.
struct Key {
  double stability = 0.0;
  bool committed = false;

  [[nodiscard]] bool before(const Key& other, std::size_t self, std::size_t other_self) const {
    return std::tie(stability, committed, self) < std::tie(other.stability, other.committed, other_self);
  }
};

// Binary heap of 0..n-1 with the least key on top; it knows the place of every item, so a key changes in O(log n).
class IndexedHeap {
 public:
  explicit IndexedHeap(PoolVector<Key> keys) : keys_(std::move(keys)), items_(keys_.size()), places_(keys_.size()) {
    for (std::size_t i = 0; i < items_.size(); ++i) items_[i] = places_[i] = i;
    for (std::size_t i = items_.size() / 2; i-- > 0;) sink(i);
  }

  [[nodiscard]] std::size_t top() const { return items_.front(); }
  [[nodiscard]] const Key& key(std::size_t item) const { return keys_[item]; }

  void update(std::size_t item, const Key& key) {
    keys_[item] = key;
    rise(places_[item]);
    sink(places_[item]);
  }

 private:
  [[nodiscard]] bool before(std::size_t a, std::size_t b) const {
    return keys_[items_[a]].before(keys_[items_[b]], items_[a], items_[b]);
  }
  void exchange(std::size_t a, std::size_t b) {
    std::swap(items_[a], items_[b]);
    places_[items_[a]] = a;
    places_[items_[b]] = b;
  }
  void rise(std::size_t place) {
    while (place > 0 && before(place, (place - 1) / 2)) {
      exchange(place, (place - 1) / 2);
      place = (place - 1) / 2;
    }
  }
  void sink(std::size_t place) {
    while (true) {
      std::size_t least = place;
      for (std::size_t child = 2 * place + 1; child <= 2 * place + 2 && child < items_.size(); ++child) {
        if (before(child, least)) least = child;
      }
      if (least == place) return;
      exchange(place, least);
      place = least;
    }
  }

  PoolVector<Key> keys_;            // of each item
  PoolVector<std::size_t> items_;   // in heap order
  PoolVector<std::size_t> places_;  // of each item in items_
};

using LabelCounts = std::array<int, 2>;  // committed matches [label]

// The labels decided so far. Energies of a label count only committed neighbours, as Chou and Brown define them: the
// counts per match (N+) and per region (N-, where all matches contradict each other) make them O(1).
class Assignment {
 public:
  explicit Assignment(const HypothesisField& field)
      : field_(field),
        committed_(field.matches.size(), false),
        labels_(field.matches.size(), kOff),
        supporting_(field.matches.size()),
        in_region_(field.by_region.size()) {}

  [[nodiscard]] const PoolVector<Label>& labels() const { return labels_; }

  // The label of least energy; OFF on a tie.
  [[nodiscard]] Label best(std::size_t match) const { return gain_of_on(match) > 0.0 ? kOn : kOff; }

  // Uncommitted: minus the energy by which the second best label is worse, the confidence in the decision. Committed:
  // the energy by which the other label is worse, negative when a change would lower the energy.
  [[nodiscard]] Key key(std::size_t match) const {
    const double gain = gain_of_on(match);
    if (!committed_[match]) return {-std::abs(gain), false};
    const double stability = labels_[match] == kOn ? gain : -gain;
    return {stability > -kLeastGain ? std::max(stability, 0.0) : stability, true};
  }

  void commit(std::size_t match, Label label) {
    LabelCounts& region = in_region_[region_of(match)];
    if (committed_[match]) --region[labels_[match]];
    ++region[label];
    for (const int neighbour : field_.supports[match]) {
      LabelCounts& counts = supporting_[static_cast<std::size_t>(neighbour)];
      if (committed_[match]) --counts[labels_[match]];
      ++counts[label];
    }
    committed_[match] = true;
    labels_[match] = label;
  }

  [[nodiscard]] std::size_t region_of(std::size_t match) const {
    return static_cast<std::size_t>(field_.matches[match].region);
  }

 private:
  // Energy of OFF minus energy of ON, given the committed neighbours.
  [[nodiscard]] double gain_of_on(std::size_t match) const {
    const Potentials& v = field_.potentials;
    LabelCounts against = in_region_[region_of(match)];
    if (committed_[match]) --against[labels_[match]];
    const double on = supporting_[match][kOn] * v.support_on_on + against[kOn] * v.contradiction_on_on +
                      against[kOff] * v.contradiction_on_off;
    const double off = supporting_[match][kOff] * v.support_off_off + against[kOn] * v.contradiction_on_off;
    return (field_.unary[match][kOff] - field_.unary[match][kOn]) + (off - on);
  }

  const HypothesisField& field_;
  PoolVector<bool> committed_;
  PoolVector<Label> labels_;
  PoolVector<LabelCounts> supporting_;  // N+ neighbours of each match
  PoolVector<LabelCounts> in_region_;   // matches of each region
};

}  // namespace

PoolVector<Label> highest_confidence_first(const HypothesisField& field) {
  const std::size_t count = field.matches.size();
  if (count == 0) return {};
  Assignment assignment(field);
  PoolVector<Key> keys(count);
  for (std::size_t i = 0; i < count; ++i) keys[i] = assignment.key(i);
  IndexedHeap heap(std::move(keys));

  // Each match is committed once, and every later change lowers the energy of the committed part by kLeastGain or more,
  // so this ends. About one change a match is usual (Section IV.C).
  [[maybe_unused]] std::size_t changes = 0;
  while (true) {
    const std::size_t match = heap.top();
    const Key& key = heap.key(match);
    if (key.committed && key.stability >= 0.0) return assignment.labels();
    assert(++changes < 1000 * count + 1000);
    assignment.commit(match, assignment.best(match));
    for (const int neighbour : field.supports[match]) {
      const auto i = static_cast<std::size_t>(neighbour);
      heap.update(i, assignment.key(i));
    }
    for (const int contradicting : field.by_region[assignment.region_of(match)]) {  // the match itself included
      const auto i = static_cast<std::size_t>(contradicting);
      heap.update(i, assignment.key(i));
    }
  }
}

}  // namespace foresight
