// Ways through an image that look at cells one by one only where that is needed: most lie amid their own kind.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace foresight {

inline constexpr int kBlock = 16;  // Unit: cells.

// Whether a block of cells is all of one label.
[[nodiscard]] bool all_are(int label, const int* labels);

// Whether any cell of a block is of no label.
[[nodiscard]] bool any_is_free(const int* labels);

using Marks = std::array<int, kBlock>;  // of a block's cells: not 0 where it is marked

// Marks the cells with another label than the one to the right or `below` cells further. Whether there are any.
[[nodiscard]] bool mark_contacts(const int* labels, int below, Marks& marks);

// Marks the cells with another label than any of the four beside them. Whether there are any.
[[nodiscard]] bool mark_borders(const int* labels, int columns, Marks& marks);

// Calls visit(cell) for cells from `begin` to before `end`, in order, without whole blocks for whose first cell
// skip(cell) is true.
template <typename Skip, typename Visit>
void visit_cells(int begin, int end, Skip&& skip, Visit&& visit) {
  for (int first = begin; first < end; first += kBlock) {
    if (first + kBlock <= end && skip(first)) continue;
    const int last = std::min(first + kBlock, end);
    for (int cell = first; cell < last; ++cell) visit(cell);
  }
}

// Calls visit(cell) for cells from `begin` to before `end`, in order: for those that mark(first cell, marks) marks of
// whole blocks, and for all of a rest.
template <typename Mark, typename Visit>
void visit_marked(int begin, int end, Mark&& mark, Visit&& visit) {
  Marks marks{};
  int first = begin;
  for (; first + kBlock <= end; first += kBlock) {
    if (!mark(first, marks)) continue;
    for (int i = 0; i < kBlock; ++i) {
      if (marks[static_cast<std::size_t>(i)] != 0) visit(first + i);
    }
  }
  for (; first < end; ++first) visit(first);
}

}  // namespace foresight
