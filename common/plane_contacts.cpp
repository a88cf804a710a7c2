#include "common/plane_contacts.h"

namespace foresight {

std::vector<Contact> contacts_of(const CellConnectivity& connectivity, const std::vector<int>& labels) {
  std::vector<Contact> contacts;
  const auto differs = [&](int cell, int next) {
    const int other = next < 0 ? 0 : labels[static_cast<std::size_t>(next)];
    if (other != 0 && other != labels[static_cast<std::size_t>(cell)]) contacts.push_back({cell, next});
  };
  const int columns = connectivity.columns();
  const int cells = static_cast<int>(labels.size());
  for (int first = 0; first < cells; first += columns) {
    const int last = first + columns - 1;
    const int below = last + 1 < cells ? columns : 0;
    for (int cell = first; cell <= last; ++cell) {
      const int* label = labels.data() + cell;
      if (*label == 0) continue;
      // Most cells lie amid their own kind, which needs no look at the connectivity.
      if (cell < last && label[1] != *label) differs(cell, connectivity.right(cell));
      if (label[below] != *label) differs(cell, connectivity.down(cell));
    }
  }
  return contacts;
}

}  // namespace foresight
