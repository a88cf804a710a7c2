#include "runtime/hypothesis_cliques.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "common/random.h"

namespace foresight {
namespace {

// Models of some faces each, all found.
Database database_of(int models, int faces) {
  CompiledDatabase content;
  for (int m = 0; m < models; ++m) {
    CompiledModel model;
    model.name = "model " + std::to_string(m);
    model.views = 320;
    for (int f = 0; f < faces; ++f) {
      ModelFace face;
      face.views_found = 10;
      for (Density& density : face.densities) {
        density.bin_width = 1.0;
        density.mass = {1.0F};
      }
      model.faces.push_back(face);
    }
    content.models.push_back(std::move(model));
  }
  return Database(std::move(content));
}

// Every region matched with every face of the database; supports at random, but only between matches that may support
// each other: same model, distinct faces and regions.
HypothesisField random_field(Random& random, const Database& database, int regions, double support_share) {
  HypothesisField field;
  const int faces = static_cast<int>(database.faces().size());
  field.by_region.resize(static_cast<std::size_t>(regions));
  for (int i = 0; i < regions * faces; ++i) {
    Match match;
    match.region = i / faces;
    match.face = i % faces;
    field.matches.push_back(match);
    field.by_region[static_cast<std::size_t>(match.region)].push_back(i);
    field.unary.push_back({random.uniform(-9.0, 9.0), static_cast<double>(random.integer(-9, 9))});
  }
  field.supports.resize(field.matches.size());
  const auto model_of = [&](const Match& match) {
    return database.faces()[static_cast<std::size_t>(match.face)].model;
  };
  for (std::size_t a = 0; a < field.matches.size(); ++a) {
    for (std::size_t b = a + 1; b < field.matches.size(); ++b) {
      const Match& left = field.matches[a];
      const Match& right = field.matches[b];
      if (left.region == right.region || left.face == right.face || model_of(left) != model_of(right)) continue;
      if (random.uniform() >= support_share) continue;
      field.supports[a].push_back(static_cast<int>(b));
      field.supports[b].push_back(static_cast<int>(a));
    }
  }
  for (PoolVector<int>& list : field.supports) std::sort(list.begin(), list.end());
  return field;
}

PoolVector<Label> random_labels(Random& random, const HypothesisField& field) {
  PoolVector<Label> labels(field.matches.size());
  for (Label& label : labels) label = random.uniform() < 0.7 ? kOn : kOff;
  return labels;
}

std::set<PoolVector<int>> cliques_by_definition(const HypothesisField& field, const PoolVector<Label>& labels) {
  const int count = static_cast<int>(field.matches.size());
  const auto linked = [&](int a, int b) {
    const auto& list = field.supports[static_cast<std::size_t>(a)];
    return labels[static_cast<std::size_t>(a)] == kOn && labels[static_cast<std::size_t>(b)] == kOn &&
           std::find(list.begin(), list.end(), b) != list.end();
  };
  std::set<PoolVector<int>> cliques;
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      if (!linked(a, b)) continue;
      bool contained = false;
      for (int c = 0; c < count; ++c) {
        if (!linked(a, c) || !linked(b, c)) continue;
        contained = true;
        PoolVector<int> clique = {a, b, c};
        std::sort(clique.begin(), clique.end());
        cliques.insert(clique);
      }
      if (!contained) cliques.insert({a, b});
    }
  }
  return cliques;
}

TEST(HypothesisCliques, are_exactly_those_of_the_definition_each_once) {
  Random random(1);
  const Database database = database_of(2, 5);
  std::size_t pairs = 0;
  std::size_t triples = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const auto field = random_field(random, database, 6, random.uniform(0.05, 0.4));
    const auto labels = random_labels(random, field);
    const auto hypotheses = hypothesis_cliques(field, database, labels);
    std::set<PoolVector<int>> found;
    for (const ObjectHypothesis& hypothesis : hypotheses) {
      found.insert(hypothesis.matches);
      ++(hypothesis.matches.size() == 2 ? pairs : triples);
    }
    EXPECT_EQ(found.size(), hypotheses.size());
    EXPECT_EQ(found, cliques_by_definition(field, labels));
  }
  EXPECT_GT(pairs, 50U);
  EXPECT_GT(triples, 50U);
}

TEST(HypothesisCliques, come_least_energy_first_then_by_matches) {
  Random random(2);
  const Database database = database_of(2, 5);
  const auto field = random_field(random, database, 6, 0.3);
  const auto hypotheses = hypothesis_cliques(field, database, PoolVector<Label>(field.matches.size(), kOn));
  int ties = 0;
  for (std::size_t i = 1; i < hypotheses.size(); ++i) {
    const ObjectHypothesis& left = hypotheses[i - 1];
    const ObjectHypothesis& right = hypotheses[i];
    EXPECT_LE(left.energy, right.energy);
    if (left.energy != right.energy) continue;
    EXPECT_LT(left.matches, right.matches);
    ++ties;
  }
  EXPECT_GT(ties, 0);
}

TEST(HypothesisCliques, carry_their_model_and_their_share_of_the_energy) {
  Random random(3);
  const Database database = database_of(3, 4);
  const auto field = random_field(random, database, 5, 0.4);
  for (const ObjectHypothesis& hypothesis : hypothesis_cliques(field, database, random_labels(random, field))) {
    // The field of the clique's own matches, each in a region of its own, all supporting, all ON.
    HypothesisField alone;
    const int size = static_cast<int>(hypothesis.matches.size());
    for (int i = 0; i < size; ++i) {
      const auto match = static_cast<std::size_t>(hypothesis.matches[static_cast<std::size_t>(i)]);
      alone.matches.push_back(field.matches[match]);
      alone.unary.push_back(field.unary[match]);
      alone.by_region.push_back({i});
      alone.supports.emplace_back();
      for (int j = 0; j < size; ++j) {
        if (j != i) alone.supports.back().push_back(j);
      }
      const auto face = static_cast<std::size_t>(field.matches[match].face);
      EXPECT_EQ(database.faces()[face].model, hypothesis.model);
    }
    const PoolVector<Label> on(static_cast<std::size_t>(size), kOn);
    EXPECT_DOUBLE_EQ(hypothesis.energy, energy(alone, on));
  }
}

TEST(HypothesisCliques, of_four_mutually_supporting_matches_are_four_triples) {
  Random random(4);
  const Database database = database_of(1, 4);
  HypothesisField field;
  for (int i = 0; i < 4; ++i) {
    Match match;
    match.region = match.face = i;
    field.matches.push_back(match);
    field.unary.push_back({0.0, 1.0});
    field.by_region.push_back({i});
    field.supports.emplace_back();
    for (int j = 0; j < 4; ++j) {
      if (j != i) field.supports.back().push_back(j);
    }
  }
  const auto hypotheses = hypothesis_cliques(field, database, PoolVector<Label>(4, kOn));
  ASSERT_EQ(hypotheses.size(), 4U);
  EXPECT_EQ(hypotheses.front().matches, (PoolVector<int>{0, 1, 2}));
  EXPECT_EQ(hypotheses.front().energy, 3.0 - 180.0);
  const auto without_last = hypothesis_cliques(field, database, {kOn, kOn, kOff, kOff});
  ASSERT_EQ(without_last.size(), 1U);
  EXPECT_EQ(without_last.front().matches, (PoolVector<int>{0, 1}));
}

TEST(HypothesisCliques, are_none_without_two_active_matches) {
  Random random(5);
  const Database database = database_of(1, 4);
  EXPECT_TRUE(hypothesis_cliques({}, database, {}).empty());
  const auto field = random_field(random, database, 3, 1.0);
  PoolVector<Label> labels(field.matches.size(), kOff);
  EXPECT_TRUE(hypothesis_cliques(field, database, labels).empty());
  labels.front() = kOn;
  EXPECT_TRUE(hypothesis_cliques(field, database, labels).empty());
}

}  // namespace
}  // namespace foresight
