// Ways through an image that look at cells one by one only where that is needed: most lie amid their own kind.
#pragma once

#include <algorithm>

namespace foresight {

inline constexpr int kBlock = 16;  // Unit: cells.

// Whether a block of cells is all of one label.
[[nodiscard]] bool all_are(int label, const int* labels);

// Whether any cell of a block is of no label.
[[nodiscard]] bool any_is_free(const int* labels);

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

}  // namespace foresight
