// Where planes touch in the image.
#pragma once

#include <vector>

#include "common/cell_connectivity.h"

namespace foresight {

// Connected cells of different planes: one and the next to its right or below it.
struct Contact {
  int cell, next;
};

// By cell, those to the right first. labels: by cell; 0 = of no plane.
[[nodiscard]] std::vector<Contact> contacts_of(const CellConnectivity& connectivity, const std::vector<int>& labels);

}  // namespace foresight
