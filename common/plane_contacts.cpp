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
    const int* const row = labels.data();
    const auto lie_amid = [&](int block) {
      const int* own = row + block;
      return (block + kBlock > last || own[kBlock] == *own) && all_are(*own, own) && all_are(*own, own + below);
    };
    visit_cells(first, last + 1, lie_amid, [&](int cell) {
      const int* own = row + cell;
      if (*own == 0) return;
      if (cell < last && own[1] != *own) differs(cell, connectivity.right(cell));
      if (own[below] != *own) differs(cell, connectivity.down(cell));
    });
  }
  return contacts;
}

}  // namespace foresight
