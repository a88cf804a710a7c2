// The envelope of a database file: magic, versions, a table of sections with length and checksum, then the sections.
// Every length and checksum is checked before a byte of content is parsed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace foresight {

inline constexpr std::uint32_t kContainerVersion = 1;       // of files written now
inline constexpr std::uint32_t kOldestReader = 1;           // the oldest reader that may read them

struct Section {
  std::string name;      // 1 to 32 bytes, printable
  std::string content;
};

// Same sections, same bytes.
[[nodiscard]] std::string encode_container(const std::vector<Section>& sections);

// Views into `bytes`, in file order. `file` names the source in errors. Throws DatabaseError: wrong_kind (magic), newer_version, truncated, corrupt.
struct SectionView {
  std::string_view name;
  std::string_view content;
};
[[nodiscard]] std::vector<SectionView> decode_container(std::string_view bytes, const std::string& file);

}  // namespace foresight
