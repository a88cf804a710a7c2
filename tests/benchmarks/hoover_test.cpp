#include "benchmarks/hoover.h"

#include <gtest/gtest.h>

#include "common/random.h"

namespace foresight {
namespace {

// Runs of equal labels: {{label, cells}, ...}.
std::vector<int> row(const std::vector<std::pair<int, int>>& runs) {
  std::vector<int> labels;
  for (const auto& [label, cells] : runs) labels.insert(labels.end(), static_cast<std::size_t>(cells), label);
  return labels;
}

std::vector<long> measures(const std::vector<int>& truth, const std::vector<int>& found, double tolerance) {
  const HooverCounts c = count_instances(classify_regions(truth, found, tolerance));
  return {c.correct, c.over_segmented, c.under_segmented, c.missed, c.noise};
}

using Measures = std::vector<long>;  // correct, over, under, missed, noise

TEST(Hoover, calls_every_region_of_an_identical_image_correct) {
  const std::vector<int> truth = row({{3, 10}, {0, 4}, {1, 1}, {9, 7}});
  const std::vector<int> renamed = row({{1, 10}, {0, 4}, {7, 1}, {2, 7}});
  for (const double tolerance : {0.51, 0.8, 1.0}) {
    EXPECT_EQ(measures(truth, truth, tolerance), (Measures{3, 0, 0, 0, 0}));
    EXPECT_EQ(measures(truth, renamed, tolerance), (Measures{3, 0, 0, 0, 0})) << "names of labels mean nothing";
  }
}

TEST(Hoover, calls_a_region_split_in_two_over_segmented) {
  EXPECT_EQ(measures(row({{1, 20}}), row({{1, 9}, {2, 11}}), 0.8), (Measures{0, 1, 0, 0, 0}));
}

TEST(Hoover, calls_two_regions_in_one_under_segmented) {
  EXPECT_EQ(measures(row({{1, 9}, {2, 11}}), row({{5, 20}}), 0.8), (Measures{0, 0, 1, 0, 0}));
}

TEST(Hoover, counts_what_is_absent_missed_and_what_is_extra_noise) {
  EXPECT_EQ(measures(row({{1, 10}, {2, 10}}), row({{1, 10}, {0, 10}}), 0.8), (Measures{1, 0, 0, 1, 0}));
  EXPECT_EQ(measures(row({{1, 10}, {0, 10}}), row({{1, 10}, {2, 10}}), 0.8), (Measures{1, 0, 0, 0, 1}));
  EXPECT_EQ(measures(row({{0, 5}}), row({{0, 5}}), 0.8), (Measures{0, 0, 0, 0, 0}));
}

TEST(Hoover, exchanges_over_and_under_missed_and_noise_with_the_images) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<int> truth, found;
    for (int run = 0; run < 12; ++run) {
      const int t = random.integer(0, 5), f = random.integer(0, 3) == 0 ? random.integer(0, 5) : t;
      for (int cell = random.integer(1, 9); cell > 0; --cell) {
        truth.push_back(t);
        found.push_back(f);
      }
    }
    const Measures there = measures(truth, found, 0.7), back = measures(found, truth, 0.7);
    EXPECT_EQ(there, (Measures{back[0], back[2], back[1], back[4], back[3]})) << trial;
  }
}

TEST(Hoover, holds_both_regions_to_the_tolerance) {
  const std::vector<int> truth = row({{1, 10}, {0, 10}});
  const std::vector<int> smaller = row({{1, 8}, {0, 12}});                 // covers 0.8 of the true region
  const std::vector<int> larger = row({{1, 10}, {2, 0}, {1, 2}, {0, 8}});  // 10 of its 12 cells are right
  EXPECT_EQ(measures(truth, smaller, 0.8), (Measures{1, 0, 0, 0, 0})) << "the tolerance itself is enough";
  EXPECT_EQ(measures(truth, smaller, 0.81), (Measures{0, 0, 0, 1, 1}));
  EXPECT_EQ(measures(truth, larger, 0.83), (Measures{1, 0, 0, 0, 0}));
  EXPECT_EQ(measures(truth, larger, 0.84), (Measures{0, 0, 0, 1, 1}));
}

TEST(Hoover, lets_cells_without_a_true_label_be_no_region_but_part_of_the_found_one) {
  const std::vector<int> truth = row({{1, 10}, {0, 5}, {-4, 5}});
  EXPECT_EQ(measures(truth, row({{1, 10}, {0, 10}}), 0.95), (Measures{1, 0, 0, 0, 0})) << "nothing else is missed";
  EXPECT_EQ(measures(truth, row({{1, 15}, {0, 5}}), 0.7), (Measures{0, 0, 0, 1, 1})) << "10 of 15 cells are right";
  EXPECT_EQ(measures(truth, row({{1, 15}, {0, 5}}), 0.66), (Measures{1, 0, 0, 0, 0}));
}

TEST(Hoover, needs_every_part_inside_and_the_parts_to_cover_the_whole) {
  // Part 2 has 6 of 10 cells inside region 1.
  const std::vector<int> truth = row({{1, 20}, {0, 4}});
  EXPECT_EQ(measures(truth, row({{1, 14}, {2, 10}}), 0.8), (Measures{0, 0, 0, 1, 2}));
  EXPECT_EQ(measures(truth, row({{1, 14}, {2, 10}}), 0.6), (Measures{0, 1, 0, 0, 0}));
  // Two parts inside that cover 12 of 20.
  EXPECT_EQ(measures(truth, row({{1, 6}, {2, 6}, {0, 12}}), 0.8), (Measures{0, 0, 0, 1, 2}));
  EXPECT_EQ(measures(truth, row({{1, 6}, {2, 6}, {0, 12}}), 0.6), (Measures{0, 1, 0, 0, 0}));
}

TEST(Hoover, keeps_the_classification_that_covers_more) {
  // Found region 1 covers 16 of the 20 cells; with part 2 it is all of them: (1 + 1) / 2 against (1 + 0.8) / 2.
  EXPECT_EQ(measures(row({{1, 20}}), row({{1, 16}, {2, 4}}), 0.8), (Measures{0, 1, 0, 0, 0}));
  // The part beside it lies half outside: one correct region and noise.
  EXPECT_EQ(measures(row({{1, 20}, {0, 4}}), row({{1, 16}, {2, 8}}), 0.8), (Measures{1, 0, 0, 0, 1}));
}

TEST(Hoover, puts_every_region_into_exactly_one_instance) {
  Random random(8);
  std::vector<int> truth, found;
  for (int cell = 0; cell < 600; ++cell) {
    truth.push_back(cell / 50);
    found.push_back(random.integer(0, 3) == 0 ? random.integer(0, 14) : cell / 40);
  }
  for (const double tolerance : {0.51, 0.7, 0.9}) {
    std::vector<int> of_truth(12, 0), of_found(16, 0);
    for (const HooverInstance& instance : classify_regions(truth, found, tolerance)) {
      for (const int label : instance.truth) ++of_truth[static_cast<std::size_t>(label)];
      for (const int label : instance.found) ++of_found[static_cast<std::size_t>(label)];
    }
    for (std::size_t label = 1; label < 12; ++label) EXPECT_EQ(of_truth[label], 1) << label;
    for (std::size_t label = 1; label < 15; ++label) EXPECT_EQ(of_found[label], 1) << label;
  }
}

}  // namespace
}  // namespace foresight
