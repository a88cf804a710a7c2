// Ways through an image that look at cells one by one only where that is needed: most lie amid their own kind.
#pragma once

#include <algorithm>

namespace foresight {

// Loops over a fixed number of cells without a way out early are what compilers turn into vector instructions.
inline constexpr int kBlock = 16;  // Unit: cells.

// Whether a block of cells is all of one label.
[[nodiscard]] inline bool all_are(int label, const int* labels) {
  int different = 0;
  for (int i = 0; i < kBlock; ++i) different |= labels[i] ^ label;
  return different == 0;
}

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
