// CompiledDatabase to bytes: the container of schema/ with foresight.v1 messages inside.
#pragma once

#include <string>

#include "common/compiled_model.h"

namespace foresight {

// Same content, same bytes. Throws InputError when the name of a model or of its CAD file is not UTF-8, or when a
// model takes more than 2 GB.
[[nodiscard]] std::string encode_database(const CompiledDatabase& database);

}  // namespace foresight
