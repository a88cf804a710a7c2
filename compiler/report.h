// What `foresightc inspect` prints.
#pragma once

#include <cstddef>
#include <string>

#include "common/compiled_model.h"

namespace foresight {

[[nodiscard]] std::string report_text(const CompiledDatabase& database, std::size_t bytes);
[[nodiscard]] std::string report_json(const CompiledDatabase& database, std::size_t bytes);

}  // namespace foresight
