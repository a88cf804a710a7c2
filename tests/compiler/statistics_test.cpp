#include "compiler/statistics.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "common/random.h"

namespace foresight {
namespace {

constexpr int kFaces = 5;
constexpr int kNeverSeen = 3;
constexpr int kViews = 40;

CompiledModel model_of_faces(int count) {
  CompiledModel model;
  model.faces.resize(static_cast<std::size_t>(count));
  return model;
}

AttributeVector random_attributes(Random& random, int face) {
  return {random.uniform(100.0, 500.0 * (face + 1)), random.uniform(5.0, 30.0), random.uniform(1.0, 5.0),
          random.uniform(20.0, 90.0)};
}

// Each view shows about half of the faces, all pairs of them; one face is never seen.
std::vector<ViewSample> random_views(std::uint64_t seed) {
  Random random(seed);
  std::vector<ViewSample> views(kViews);
  for (ViewSample& view : views) {
    for (int face = 0; face < kFaces; ++face) {
      if (face == kNeverSeen || random.uniform() < 0.5) continue;
      for (const auto& earlier : view.faces) {
        view.pairs.push_back(
            {earlier.face, face, {random.uniform(0.0, std::numbers::pi), random.uniform(10.0, 120.0)}});
      }
      view.faces.push_back({face, random_attributes(random, face)});
    }
  }
  return views;
}

CompiledModel estimated(const std::vector<ViewSample>& views, const DensityOptions& options = {}) {
  CompiledModel model = model_of_faces(kFaces);
  estimate_statistics(views, options, model);
  return model;
}

double sum_of(const Density& density) { return std::accumulate(density.mass.begin(), density.mass.end(), 0.0); }

const DensityOptions kRaw{24, 0.0};
const DensityOptions kSmooth{24, 0.5};
const DensityOptions kFine{100, 2.0};

TEST(Statistics, every_density_sums_to_one) {
  for (const DensityOptions& options : {kRaw, kSmooth, kFine}) {
    const CompiledModel model = estimated(random_views(1), options);
    for (int face = 0; face < kFaces; ++face) {
      if (face == kNeverSeen) continue;
      for (const Density& density : model.faces[static_cast<std::size_t>(face)].densities)
        EXPECT_NEAR(sum_of(density), 1.0, 1e-5);
    }
    ASSERT_FALSE(model.pairs.empty());
    for (const FacePair& pair : model.pairs) {
      for (const Density& density : pair.densities) EXPECT_NEAR(sum_of(density), 1.0, 1e-5);
    }
  }
}

// Otherwise recognition would prune a match that compilation has seen.
TEST(Statistics, every_sample_has_a_probability_above_zero) {
  const std::vector<ViewSample> views = random_views(2);
  for (const DensityOptions& options : {kRaw, kSmooth, kFine}) {
    const CompiledModel model = estimated(views, options);
    for (const ViewSample& view : views) {
      for (const auto& [face, attributes] : view.faces) {
        for (std::size_t k = 0; k < attributes.size(); ++k) {
          EXPECT_GT(model.faces[static_cast<std::size_t>(face)].densities[k].probability(attributes[k]), 0.0);
        }
      }
      for (const auto& [first, second, relations] : view.pairs) {
        const auto pair =
            std::find_if(model.pairs.begin(), model.pairs.end(),
                         [f = first, s = second](const FacePair& p) { return p.first == f && p.second == s; });
        ASSERT_NE(pair, model.pairs.end());
        for (std::size_t k = 0; k < relations.size(); ++k) EXPECT_GT(pair->densities[k].probability(relations[k]), 0.0);
      }
    }
  }
}

TEST(Statistics, counts_a_view_once_even_where_a_face_gave_two_regions) {
  const AttributeVector some = {100, 10, 5, 40};
  const RelationVector relation = {1.0, 50.0};
  std::vector<ViewSample> views(4);
  views[0].faces = {{0, some}, {0, some}, {1, some}};
  views[0].pairs = {{0, 1, relation}, {0, 1, relation}};
  views[2].faces = {{1, some}};
  const CompiledModel model = estimated(views);
  EXPECT_EQ(model.views, 4);
  EXPECT_EQ(model.faces[0].views_found, 1);
  EXPECT_EQ(model.faces[1].views_found, 2);
  ASSERT_EQ(model.pairs.size(), 1U);
  EXPECT_EQ(model.pairs[0].views_found, 1);
}

TEST(Statistics, both_regions_of_a_face_count_for_its_density) {
  std::vector<ViewSample> views(1);
  views[0].faces = {{0, {100, 10, 5, 40}}, {0, {900, 10, 5, 40}}};
  const Density area = estimated(views, kRaw).faces[0].densities[kArea];
  EXPECT_NEAR(area.probability(100), 0.5, 1e-6);
  EXPECT_NEAR(area.probability(900), 0.5, 1e-6);
}

TEST(Statistics, all_faces_of_a_model_share_their_bins) {
  const CompiledModel model = estimated(random_views(3));
  for (std::size_t k = 0; k < kAttributeCount; ++k) {
    for (int face = 1; face < kFaces; ++face) {
      if (face == kNeverSeen) continue;
      EXPECT_EQ(model.faces[static_cast<std::size_t>(face)].densities[k].bin_width,
                model.faces[0].densities[k].bin_width);
      EXPECT_EQ(model.faces[static_cast<std::size_t>(face)].densities[k].lower, 0.0);
    }
  }
  for (const FacePair& pair : model.pairs) {
    EXPECT_EQ(pair.densities[kMaxDistance].bin_width, model.pairs[0].densities[kMaxDistance].bin_width);
    EXPECT_DOUBLE_EQ(pair.densities[kOrientation].bin_width, std::numbers::pi / 24.0);
  }
}

TEST(Statistics, pairs_ascend_and_have_views_no_more_than_their_faces) {
  const CompiledModel model = estimated(random_views(4));
  ASSERT_EQ(model.pairs.size(), 6U);  // of the four faces seen
  for (std::size_t i = 0; i < model.pairs.size(); ++i) {
    const FacePair& pair = model.pairs[i];
    EXPECT_LT(pair.first, pair.second);
    if (i > 0) {
      EXPECT_LT(std::pair(model.pairs[i - 1].first, model.pairs[i - 1].second), std::pair(pair.first, pair.second));
    }
    EXPECT_LE(pair.views_found, model.faces[static_cast<std::size_t>(pair.first)].views_found);
    EXPECT_LE(pair.views_found, model.faces[static_cast<std::size_t>(pair.second)].views_found);
  }
}

TEST(Statistics, a_face_never_seen_has_no_densities) {
  const CompiledModel model = estimated(random_views(5));
  const ModelFace& unseen = model.faces[kNeverSeen];
  EXPECT_EQ(unseen.views_found, 0);
  for (const Density& density : unseen.densities) EXPECT_TRUE(density.mass.empty());
}

TEST(Statistics, of_views_that_show_nothing_are_none) {
  const CompiledModel model = estimated(std::vector<ViewSample>(7));
  EXPECT_EQ(model.views, 7);
  EXPECT_TRUE(model.pairs.empty());
  for (const ModelFace& face : model.faces) EXPECT_EQ(face.views_found, 0);
}

TEST(Statistics, do_not_depend_on_the_order_of_views) {
  std::vector<ViewSample> views = random_views(6);
  const CompiledModel model = estimated(views, kRaw);
  std::reverse(views.begin(), views.end());
  const CompiledModel reversed = estimated(views, kRaw);
  for (std::size_t face = 0; face < kFaces; ++face) {
    EXPECT_EQ(model.faces[face].views_found, reversed.faces[face].views_found);
    for (std::size_t k = 0; k < kAttributeCount; ++k)
      EXPECT_EQ(model.faces[face].densities[k].mass, reversed.faces[face].densities[k].mass);
  }
}

}  // namespace
}  // namespace foresight
