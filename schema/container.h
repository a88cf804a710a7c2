// The envelope of a database file: magic, versions, a table of sections with length and checksum, then the sections.
// Every length and checksum is checked before a byte of content is parsed. schema/README.md has the layout byte by
// byte.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace foresight {

inline constexpr std::uint32_t kContainerVersion = 1;  // of files written now, and the newest this reader knows
inline constexpr std::uint32_t kOldestReader = 1;      // the oldest reader that may read files written now
inline constexpr std::uint32_t kSchemaVersion = 1;     // what the messages inside mean; the header section carries it

struct Section {
  std::string name;  // 1 to 32 bytes, printable ASCII without blanks; several sections may have one name
  std::string content;
};

// Same sections, same bytes. REQUIRES: names as above.
[[nodiscard]] std::string encode_container(const std::vector<Section>& sections);

// Views into `bytes`, in file order. `file` names the source in errors. Throws DatabaseError: wrong_kind (magic),
// newer_version, truncated, corrupt.
struct SectionView {
  std::string_view name;
  std::string_view content;
};
[[nodiscard]] std::vector<SectionView> decode_container(std::string_view bytes, const std::string& file);

// CRC-64/XZ: polynomial 0x42F0E1EBA9EA3693 of ECMA-182, reflected, all ones before and after. "123456789" gives
// 0x995DC9BBDF1939FA. It finds every change of one bit, and every burst of up to 64 bits.
[[nodiscard]] std::uint64_t checksum(std::string_view bytes);

}  // namespace foresight
