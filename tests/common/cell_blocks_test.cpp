#include "common/cell_blocks.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "common/random.h"

namespace foresight {
namespace {

constexpr int kColumns = 40;
constexpr int kRows = 30;

// Patches of few labels, so that most neighbours are of one.
std::vector<int> patchy_labels(std::uint64_t seed) {
  Random random(seed);
  std::vector<int> labels(kColumns * kRows, 0);
  for (int i = 0; i < 6; ++i) {
    const int row = random.integer(0, kRows - 8), column = random.integer(0, kColumns - 25);
    for (int r = row; r < row + 8; ++r) {
      for (int c = column; c < column + 25; ++c) labels[static_cast<std::size_t>(r * kColumns + c)] = i;
    }
  }
  return labels;
}

TEST(VisitCells, calls_for_all_cells_in_order_unless_their_block_is_skipped) {
  for (const int end : {0, 7, 16, 17, 100}) {
    std::vector<int> visited;
    visit_cells(
        3, end, [](int first) { return first == 19; }, [&](int cell) { visited.push_back(cell); });
    std::vector<int> expected;
    for (int cell = 3; cell < end; ++cell) {
      if (cell < 19 || cell >= 19 + kBlock || end < 19 + kBlock) expected.push_back(cell);
    }
    EXPECT_EQ(visited, expected) << end;
  }
}

TEST(VisitMarked, calls_for_the_marked_cells_and_the_rest_of_a_block) {
  const auto mark_every_third = [](int first, Marks& marks) {
    for (int i = 0; i < kBlock; ++i) marks[static_cast<std::size_t>(i)] = (first + i) % 3 == 0 ? 1 : 0;
    return true;
  };
  std::vector<int> visited;
  visit_marked(0, 2 * kBlock + 5, mark_every_third, [&](int cell) { visited.push_back(cell); });
  std::vector<int> expected;
  for (int cell = 0; cell < 2 * kBlock + 5; ++cell) {
    if (cell % 3 == 0 || cell >= 2 * kBlock) expected.push_back(cell);
  }
  EXPECT_EQ(visited, expected);
}

TEST(Blocks, are_of_one_label_only_when_every_cell_is) {
  for (int odd = 0; odd <= kBlock; ++odd) {
    std::vector<int> labels(kBlock + 1, 7);
    labels[static_cast<std::size_t>(odd)] = 0;
    EXPECT_EQ(all_are(7, labels.data()), odd == kBlock);
    EXPECT_EQ(any_is_free(labels.data()), odd != kBlock);
  }
}

TEST(Marks, are_where_the_labels_differ) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<int> labels = patchy_labels(seed);
    const auto label = [&](int cell) { return labels[static_cast<std::size_t>(cell)]; };
    for (int first = kColumns; first + kBlock + kColumns < kRows * kColumns; first += kBlock) {
      Marks contacts{}, borders{};
      const bool any_contact = mark_contacts(labels.data() + first, kColumns, contacts);
      const bool any_border = mark_borders(labels.data() + first, kColumns, borders);
      int count_contacts = 0, count_borders = 0;
      for (int i = 0; i < kBlock; ++i) {
        const int cell = first + i;
        const bool contact = label(cell) != label(cell + 1) || label(cell) != label(cell + kColumns);
        const bool border = contact || label(cell) != label(cell - 1) || label(cell) != label(cell - kColumns);
        EXPECT_EQ(contacts[static_cast<std::size_t>(i)] != 0, contact);
        EXPECT_EQ(borders[static_cast<std::size_t>(i)] != 0, border);
        count_contacts += contact ? 1 : 0;
        count_borders += border ? 1 : 0;
      }
      EXPECT_EQ(any_contact, count_contacts > 0);
      EXPECT_EQ(any_border, count_borders > 0);
    }
  }
}

}  // namespace
}  // namespace foresight
