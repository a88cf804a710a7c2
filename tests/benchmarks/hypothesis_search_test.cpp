#include "benchmarks/hypothesis_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/benchmarks/boxes.h"
#include "tests/solids.h"

namespace foresight {
namespace {

// Top, right and front side of a box of 40 x 60 x 100 mm: the second is the largest, the first the smallest.
const PoolVector<DescribedRegion>& three_sides() {
  static const PoolVector<DescribedRegion> regions = {test::rectangle({0, 0, 100}, {40, 0, 0}, {0, 60, 0}),
                                                      test::rectangle({40, 0, 0}, {0, 60, 0}, {0, 0, 100}),
                                                      test::rectangle({0, 0, 0}, {40, 0, 0}, {0, 0, 100})};
  return regions;
}

HypothesisList tree_over(int copies, std::uint64_t seed) {
  const CadModel box = test::make_box(40, 60, 100);
  const Database database = test::database_of_copies(box, copies);
  const CadGeometry geometry = cad_geometry(box);
  const std::vector<const CadGeometry*> geometries(static_cast<std::size_t>(copies), &geometry);
  return tree_hypotheses(three_sides(), database, geometries, {0.8, 1.1}, Random(seed));
}

int face_of_region(const HypothesisList& list, std::size_t i, int region) {
  for (const int index : list.hypotheses[i].matches) {
    const Match& match = list.field.matches[static_cast<std::size_t>(index)];
    if (match.region == region) return match.face;
  }
  return -1;
}

TEST(TreeHypotheses, are_the_consistent_triples_depth_first_by_region_size) {
  const HypothesisList list = tree_over(1, 1);
  ASSERT_EQ(list.hypotheses.size(), 8U);  // two faces for each of three regions
  std::vector<std::array<int, 3>> paths;  // largest region first
  for (std::size_t i = 0; i < 8; ++i) {
    paths.push_back({face_of_region(list, i, 1), face_of_region(list, i, 2), face_of_region(list, i, 0)});
  }
  EXPECT_TRUE(std::is_sorted(paths.begin(), paths.end()));
  EXPECT_EQ(std::set(paths.begin(), paths.end()).size(), 8U);
}

TEST(TreeHypotheses, begin_with_no_model_of_their_own_choice) {
  std::set<int> first_models;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const HypothesisList list = tree_over(3, seed);
    EXPECT_EQ(list.hypotheses.size(), 24U);
    first_models.insert(list.hypotheses.front().model);
  }
  EXPECT_EQ(first_models.size(), 3U);
  EXPECT_EQ(tree_over(3, 5).hypotheses.front().matches, tree_over(3, 5).hypotheses.front().matches);
}

TEST(HypothesisList, names_its_cliques_whatever_the_database) {
  const Database database = test::database_of_copies(test::make_box(40, 60, 100), 3);
  const HypothesisList list = tree_over(3, 1);
  std::set<Clique> cliques;
  for (std::size_t i = 0; i < list.hypotheses.size(); ++i) {
    const Clique clique = list.clique(i, database, 10);
    EXPECT_EQ(clique.model, 10 + list.hypotheses[i].model);
    EXPECT_TRUE(std::is_sorted(clique.matches.begin(), clique.matches.end()));
    for (const RegionAsFace& match : clique.matches) EXPECT_LT(match.face, 6);
    std::vector<int> regions = list.regions(i);
    std::sort(regions.begin(), regions.end());
    EXPECT_EQ(regions, (std::vector<int>{0, 1, 2}));
    cliques.insert(clique);
  }
  EXPECT_EQ(cliques.size(), list.hypotheses.size());
}

TEST(SortByRegionSize, puts_the_largest_total_area_first) {
  HypothesisList list = tree_over(1, 1);
  for (std::size_t i = 0; i < list.hypotheses.size(); ++i) {
    list.hypotheses[i].matches.erase(list.hypotheses[i].matches.begin() + static_cast<std::ptrdiff_t>(i % 3));
  }
  sort_by_region_size(list, three_sides());
  double last = 1e9;
  for (std::size_t i = 0; i < list.hypotheses.size(); ++i) {
    double area = 0.0;
    for (const int region : list.regions(i)) area += three_sides()[static_cast<std::size_t>(region)].attributes[kArea];
    EXPECT_LE(area, last);
    last = area;
  }
}

}  // namespace
}  // namespace foresight
