#include "common/cell_blocks.h"

namespace foresight {

// Loops over a fixed number of cells without a way out early, not mixed with other code: those are what compilers turn
// into vector instructions.

bool all_are(int label, const int* labels) {
  int different = 0;
  for (int i = 0; i < kBlock; ++i) different |= labels[i] ^ label;
  return different == 0;
}

bool any_is_free(const int* labels) {
  int free = 0;
  for (int i = 0; i < kBlock; ++i) free |= labels[i] == 0 ? 1 : 0;
  return free != 0;
}

bool mark_contacts(const int* labels, int below, Marks& marks) {
  int any = 0;
  for (int i = 0; i < kBlock; ++i) {
    const int mark = (labels[i] ^ labels[i + 1]) | (labels[i] ^ labels[i + below]);
    marks[static_cast<std::size_t>(i)] = mark;
    any |= mark;
  }
  return any != 0;
}

bool mark_borders(const int* labels, int columns, Marks& marks) {
  int any = 0;
  for (int i = 0; i < kBlock; ++i) {
    const int beside = (labels[i] ^ labels[i - 1]) | (labels[i] ^ labels[i + 1]);
    const int mark = beside | (labels[i] ^ labels[i - columns]) | (labels[i] ^ labels[i + columns]);
    marks[static_cast<std::size_t>(i)] = mark;
    any |= mark;
  }
  return any != 0;
}

}  // namespace foresight
