// Results of a selftest as JSON.
#pragma once

#include <string>
#include <vector>

#include "runtime/selftest.h"

namespace foresight {

// Keys in the documented order, numbers so that they read back to the same bits; one line, no line break at the end.
// What was not tested or not found has null for its errors and score.
[[nodiscard]] std::string selftest_json(const std::string& database, const std::string& compiler_version,
                                        const std::vector<ObjectSelftest>& results);

}  // namespace foresight
