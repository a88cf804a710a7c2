// The laws a database keeps, checked on our own structs once it is decoded. After this, no code looks again.
#pragma once

#include <string>

#include "common/compiled_model.h"

namespace foresight {

// Throws DatabaseError{inconsistent} that names the file, the model and the field: sensor and settings within their
// limits; names unique; numbers finite; indices in range and ascending; normals of unit length; densities that sum to 1
// within 1e-3, non-negative, within the bins of the settings; all faces of a model on the same bins; symmetries proper
// rigid motions, the exact ones first, at most 512 and 32 near ones.
void check(const CompiledDatabase& database, const std::string& file);

[[noreturn]] void refuse_inconsistent(const std::string& file, const std::string& cause);

}  // namespace foresight
