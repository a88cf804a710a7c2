// CompiledDatabase to bytes: the container of schema/ with foresight.v1 messages inside.
#pragma once

#include <string>

#include "common/compiled_model.h"

namespace foresight {

// Same content, same bytes.
[[nodiscard]] std::string encode_database(const CompiledDatabase& database);

}  // namespace foresight
