// Where planes touch in the image.
#pragma once

#include "common/cell_connectivity.h"
#include "common/memory_pool.h"

namespace foresight {

// Connected cells of different planes: one and the next to its right or below it.
struct Contact {
  int cell, next;
};

// By cell, those to the right first. labels: by cell; 0 = of no plane.
[[nodiscard]] PoolVector<Contact> contacts_of(const CellConnectivity& connectivity, const PoolVector<int>& labels);

}  // namespace foresight
