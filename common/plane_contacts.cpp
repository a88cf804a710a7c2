#include "common/plane_contacts.h"

namespace foresight {

PoolVector<Contact> contacts_of(const CellConnectivity& connectivity, const PoolVector<int>& labels) {
  PoolVector<Contact> contacts;
  const auto differs = [&](int cell, int next) {
    const int other = next < 0 ? 0 : labels[static_cast<std::size_t>(next)];
    if (other != 0 && other != labels[static_cast<std::size_t>(cell)]) contacts.push_back({cell, next});
  };
  const int columns = connectivity.columns();
  const int cells = static_cast<int>(labels.size());
  const auto visit = [&](int cell) {
    if (labels[static_cast<std::size_t>(cell)] == 0) return;
    differs(cell, connectivity.right(cell));
    differs(cell, connectivity.down(cell));
  };
  const auto mark_above = [&](int first, Marks& marks) { return mark_contacts(labels.data() + first, columns, marks); };
  const auto mark_last_row = [&](int first, Marks& marks) { return mark_contacts(labels.data() + first, 0, marks); };
  visit_marked(0, cells - columns, mark_above, visit);
  visit_marked(cells - columns, cells - 1, mark_last_row, visit);
  return contacts;
}

}  // namespace foresight
