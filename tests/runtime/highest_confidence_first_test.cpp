#include "runtime/highest_confidence_first.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/random.h"

namespace foresight {
namespace {

// Matches spread over the regions in turn; each pair of matches of distinct regions supports with the given share.
// Unaries are eighths, so that energies are exact and their order is not a matter of rounding.
HypothesisField random_field(Random& random, int matches, int regions, double support_share) {
  HypothesisField field;
  field.by_region.resize(static_cast<std::size_t>(regions));
  for (int i = 0; i < matches; ++i) {
    Match match;
    match.region = i * regions / matches;
    field.matches.push_back(match);
    field.by_region[static_cast<std::size_t>(match.region)].push_back(i);
    field.unary.push_back({random.integer(-160, 160) / 8.0, random.integer(-160, 160) / 8.0});
  }
  field.supports.resize(field.matches.size());
  for (std::size_t a = 0; a < field.matches.size(); ++a) {
    for (std::size_t b = a + 1; b < field.matches.size(); ++b) {
      if (field.matches[a].region == field.matches[b].region || random.uniform() >= support_share) continue;
      field.supports[a].push_back(static_cast<int>(b));
      field.supports[b].push_back(static_cast<int>(a));
    }
  }
  for (PoolVector<int>& list : field.supports) std::sort(list.begin(), list.end());
  return field;
}

// A field without any pair.
HypothesisField independent_field(const PoolVector<std::array<double, 2>>& unary) {
  HypothesisField field;
  for (std::size_t i = 0; i < unary.size(); ++i) {
    Match match;
    match.region = static_cast<int>(i);
    field.matches.push_back(match);
    field.by_region.push_back({static_cast<int>(i)});
  }
  field.unary = unary;
  field.supports.resize(unary.size());
  return field;
}

double least_energy(const HypothesisField& field) {
  const std::size_t count = field.matches.size();
  PoolVector<Label> labels(count);
  double least = INFINITY;
  for (std::size_t bits = 0; bits < (std::size_t{1} << count); ++bits) {
    for (std::size_t i = 0; i < count; ++i) labels[i] = (bits >> i & 1U) != 0 ? kOn : kOff;
    least = std::min(least, energy(field, labels));
  }
  return least;
}

void expect_no_flip_lowers_energy(const HypothesisField& field, PoolVector<Label> labels) {
  const double reached = energy(field, labels);
  for (Label& label : labels) {
    const Label kept = label;
    label = kept == kOn ? kOff : kOn;
    EXPECT_GE(energy(field, labels), reached - 1e-7);
    label = kept;
  }
}

// Chou and Brown's definition without heap and counters: every stability from scratch at every step.
class SlowHcf {
 public:
  explicit SlowHcf(const HypothesisField& field) : field_(field), labels_(field.matches.size(), -1) {}

  PoolVector<Label> labels() {
    while (step()) {
    }
    PoolVector<Label> result;
    for (const int label : labels_) result.push_back(label == 1 ? kOn : kOff);
    return result;
  }

 private:
  [[nodiscard]] double local_energy(std::size_t match, Label label) const {
    const Potentials& v = field_.potentials;
    double sum = field_.unary[match][label];
    for (const int b : field_.supports[match]) {
      const int other = labels_[static_cast<std::size_t>(b)];
      if (other == label) sum += label == kOn ? v.support_on_on : v.support_off_off;
    }
    for (const int b : field_.by_region[static_cast<std::size_t>(field_.matches[match].region)]) {
      const int other = labels_[static_cast<std::size_t>(b)];
      if (b == static_cast<int>(match) || other < 0) continue;
      if (label == kOn && other == kOn) sum += v.contradiction_on_on;
      if (label != other) sum += v.contradiction_on_off;
    }
    return sum;
  }

  bool step() {
    std::size_t chosen = labels_.size();
    double least = INFINITY;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      const double gain = local_energy(i, kOff) - local_energy(i, kOn);
      const double stability = labels_[i] < 0 ? -std::abs(gain) : labels_[i] == kOn ? gain : -gain;
      const bool first_uncommitted =
          stability == least && labels_[i] < 0 && chosen < labels_.size() && labels_[chosen] >= 0;
      if (stability < least || first_uncommitted) {
        least = stability;
        chosen = i;
      }
    }
    if (chosen == labels_.size() || (labels_[chosen] >= 0 && least >= 0.0)) return false;
    labels_[chosen] = local_energy(chosen, kOn) < local_energy(chosen, kOff) ? kOn : kOff;
    return true;
  }

  const HypothesisField& field_;
  std::vector<int> labels_;  // -1 = uncommitted
};

TEST(HighestConfidenceFirst, of_an_empty_field_is_empty) { EXPECT_TRUE(highest_confidence_first({}).empty()); }

TEST(HighestConfidenceFirst, takes_the_better_label_of_independent_matches_and_off_on_a_tie) {
  const auto field = independent_field({{1.0, 2.0}, {2.0, 1.0}, {3.0, 3.0}, {-5.0, 7.0}, {-1.0, -1.5}});
  EXPECT_EQ(highest_confidence_first(field), (PoolVector<Label>{kOff, kOn, kOff, kOff, kOn}));
}

TEST(HighestConfidenceFirst, commits_matches_without_any_confidence) {
  // All energies zero at first: the first match falls to OFF, and OFF costs its supporting neighbour 40.
  HypothesisField field = independent_field({{0.0, 0.0}, {0.0, 0.0}});
  field.supports = {{1}, {0}};
  EXPECT_EQ(highest_confidence_first(field), (PoolVector<Label>{kOn, kOn}));
  // A neighbour of zero weight decides nothing: every match must still get its label.
  field.potentials = {0.0, 0.0, 0.0, 0.0, PriorSign::minus_log};
  EXPECT_EQ(highest_confidence_first(field), (PoolVector<Label>{kOff, kOff}));
}

TEST(HighestConfidenceFirst, commits_the_undecided_even_behind_a_decided_match_without_confidence) {
  // Match 0 stays at zero stability once decided. Were it taken for the end, 1 and 2 would never turn each other ON.
  HypothesisField field = independent_field({{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}});
  field.supports = {{}, {2}, {1}};
  EXPECT_EQ(highest_confidence_first(field), (PoolVector<Label>{kOff, kOn, kOn}));
}

TEST(HighestConfidenceFirst, lets_mutual_support_win_over_a_lone_contradiction) {
  // Regions 0, 1, 2 each with the match of one model (0, 2, 4), all consistent, and a rival (1, 3, 5) with a better
  // unary energy but no support, as in Fig. 3. The rivals weigh against: too few contradict to hold them.
  HypothesisField field;
  for (int i = 0; i < 6; ++i) {
    Match match;
    match.region = i / 2;
    field.matches.push_back(match);
    field.unary.push_back({0.0, i % 2 == 0 ? 5.0 : -5.0});
  }
  field.by_region = {{0, 1}, {2, 3}, {4, 5}};
  field.supports = {{2, 4}, {}, {0, 4}, {}, {0, 2}, {}};
  EXPECT_EQ(highest_confidence_first(field), (PoolVector<Label>{kOn, kOff, kOn, kOff, kOn, kOff}));
}

TEST(HighestConfidenceFirst, is_a_local_minimum) {
  Random random(1);
  for (int trial = 0; trial < 60; ++trial) {
    const auto field = random_field(random, random.integer(1, 120), random.integer(1, 20), random.uniform(0.0, 0.3));
    expect_no_flip_lowers_energy(field, highest_confidence_first(field));
  }
}

TEST(HighestConfidenceFirst, is_a_local_minimum_of_any_potentials) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    auto field = random_field(random, 40, random.integer(1, 10), 0.2);
    field.potentials = {random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(-60, 60),
                        random.uniform(-60, 60), PriorSign::minus_log};
    expect_no_flip_lowers_energy(field, highest_confidence_first(field));
  }
}

TEST(HighestConfidenceFirst, comes_near_the_optimum_of_tiny_fields_and_never_below) {
  Random random(3);
  int optimal = 0;
  const int trials = 200;
  for (int trial = 0; trial < trials; ++trial) {
    const auto field = random_field(random, 10, random.integer(2, 5), random.uniform(0.1, 0.6));
    const double reached = energy(field, highest_confidence_first(field));
    const double least = least_energy(field);
    EXPECT_GE(reached, least);
    if (reached <= least) ++optimal;
  }
  EXPECT_GT(optimal, trials / 2);
}

TEST(HighestConfidenceFirst, equals_its_definition_without_heap_and_counters) {
  Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const auto field = random_field(random, random.integer(1, 60), random.integer(1, 12), random.uniform(0.0, 0.5));
    EXPECT_EQ(highest_confidence_first(field), SlowHcf(field).labels());
  }
}

TEST(HighestConfidenceFirst, does_not_depend_on_the_unit_of_energy) {
  Random random(6);
  const double unit = std::ldexp(1.0, -20);  // a power of two scales without rounding
  for (int trial = 0; trial < 50; ++trial) {
    auto field = random_field(random, 60, random.integer(2, 12), random.uniform(0.0, 0.5));
    const auto labels = highest_confidence_first(field);
    for (auto& unary : field.unary) unary = {unit * unary[kOff], unit * unary[kOn]};
    field.potentials = {-60.0 * unit, 40.0 * unit, 60.0 * unit, -10.0 * unit, PriorSign::minus_log};
    EXPECT_EQ(highest_confidence_first(field), labels);
  }
}

TEST(HighestConfidenceFirst, ends_where_a_change_gains_only_rounding_error) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    auto field = random_field(random, 60, 10, 0.3);
    for (auto& unary : field.unary) unary = {random.uniform(-1e-13, 1e-13), random.uniform(-1e-13, 1e-13)};
    field.potentials = {-0.1, 0.1, 0.1, -0.1, PriorSign::minus_log};
    expect_no_flip_lowers_energy(field, highest_confidence_first(field));
  }
}

}  // namespace
}  // namespace foresight
