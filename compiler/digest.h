// Digest of a file's bytes, for provenance.
#pragma once

#include <string>
#include <string_view>

namespace foresight {

// SHA-256 as 64 lower-case hex digits: what sha256sum prints.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

}  // namespace foresight
