#include "schema/container.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#include "common/errors.h"

namespace foresight {
namespace {

// As in PNG: a byte beyond ASCII and both kinds of line end, so that a transfer in text mode shows.
constexpr std::string_view kMagic(
    "\x89"
    "FSD"
    "\r\n\x1a\n",
    8);
constexpr std::size_t kPreambleSize = 40;  // magic, two versions, file length, number of sections, checksum
constexpr std::size_t kNameSize = 32;
constexpr std::size_t kEntrySize = kNameSize + 16;  // name, length, checksum
constexpr std::size_t kChecksumSize = 8;

// Eight tables let eight bytes enter at a time ("slicing by 8", Kounavis and Berry 2005).
using CrcTables = std::array<std::array<std::uint64_t, 256>, 8>;
constexpr CrcTables make_crc_tables() {
  constexpr std::uint64_t kReflectedPolynomial = 0xC96C5795D7870F42;
  CrcTables tables{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? kReflectedPolynomial : 0);
    tables[0][byte] = crc;
  }
  for (std::size_t table = 1; table < 8; ++table)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint64_t before = tables[table - 1][byte];
      tables[table][byte] = (before >> 8) ^ tables[0][before & 0xFF];
    }
  return tables;
}
constexpr CrcTables kCrcTables = make_crc_tables();

template <typename Number>
void append(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof(Number); ++i) bytes.push_back(static_cast<char>((number >> (8 * i)) & 0xFF));
}

template <typename Number>
Number read_number(std::string_view bytes, std::size_t at) {
  Number number = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    number |= static_cast<Number>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return number;
}

bool is_printable(char c) { return c > ' ' && c <= '~'; }

bool is_text(std::string_view bytes) {
  return std::all_of(bytes.begin(), bytes.end(),
                     [](char c) { return is_printable(c) || c == ' ' || c == '\n' || c == '\r' || c == '\t'; });
}

// What a file that does not begin with the magic seems to be.
std::string foreign_kind(std::string_view bytes) {
  if (bytes.empty()) return "the file is empty";
  if (bytes.starts_with(kMagic.substr(0, 4))) return "the database was changed by a transfer in text mode";
  if (bytes.starts_with("\x89PNG")) return "this is a PNG image, not a Foresight database";
  if (bytes.starts_with("ply")) return "this is a PLY file, not a Foresight database";
  if (bytes.starts_with("# .PCD") || bytes.starts_with("VERSION"))
    return "this is a PCD file, not a Foresight database";
  if (is_text(bytes.substr(0, 64))) return "this is a text file, not a Foresight database";
  return "this is not a Foresight database";
}

[[noreturn]] void refuse_kind(std::string_view bytes, const std::string& file) {
  throw DatabaseError(DatabaseFault::wrong_kind, file, foreign_kind(bytes),
                      "give a file that foresightc has written, copied byte by byte");
}

[[noreturn]] void refuse_truncated(const std::string& file, std::size_t size, const std::string& expected) {
  throw DatabaseError(DatabaseFault::truncated, file,
                      "the database ends after " + std::to_string(size) + " bytes of " + expected,
                      "copy it again, or compile it again");
}

[[noreturn]] void refuse_corrupt(const std::string& file, const std::string& cause) {
  throw DatabaseError(DatabaseFault::corrupt, file, cause, "copy it again, or compile it again");
}

// What the first 40 bytes say. Their layout is the same in every container version, past and future.
struct Preamble {
  std::uint32_t version = 0;
  std::uint32_t oldest_reader = 0;
  std::uint64_t file_length = 0;
  std::uint64_t sections = 0;
};

Preamble decode_preamble(std::string_view bytes, const std::string& file) {
  const std::size_t seen = std::min(bytes.size(), kMagic.size());
  if (seen == 0 || bytes.substr(0, seen) != kMagic.substr(0, seen)) refuse_kind(bytes, file);
  if (bytes.size() < kPreambleSize) refuse_truncated(file, bytes.size(), "its preamble");
  const std::size_t end = kPreambleSize - kChecksumSize;
  if (checksum(bytes.substr(0, end)) != read_number<std::uint64_t>(bytes, end))
    refuse_corrupt(file, "the first bytes of the database were changed (their checksum does not hold)");
  return {read_number<std::uint32_t>(bytes, 8), read_number<std::uint32_t>(bytes, 12),
          read_number<std::uint64_t>(bytes, 16), read_number<std::uint64_t>(bytes, 24)};
}

void check(const Preamble& preamble, std::size_t size, const std::string& file) {
  if (preamble.oldest_reader > kContainerVersion)
    throw DatabaseError(DatabaseFault::newer_version, file,
                        "the file has container version " + std::to_string(preamble.version) +
                            " and asks for a reader of " + std::to_string(preamble.oldest_reader) +
                            " or newer; this one knows " + std::to_string(kContainerVersion),
                        "use a newer foresight, or compile the database again with the foresightc of this version");
  if (size < preamble.file_length) refuse_truncated(file, size, std::to_string(preamble.file_length));
  if (size > preamble.file_length)
    refuse_corrupt(file, std::to_string(size - preamble.file_length) + " bytes follow after the end of the database");
  const std::uint64_t most = (size - kPreambleSize) / kEntrySize;
  if (preamble.version == 0 || preamble.oldest_reader == 0 || preamble.sections > most ||
      size - kPreambleSize - preamble.sections * kEntrySize < kChecksumSize)
    refuse_corrupt(file, "the preamble of the database contradicts itself");
}

SectionView decode_entry(std::string_view entry, std::string_view rest, const std::string& file) {
  const std::string_view padded = entry.substr(0, kNameSize);
  const std::string_view name = padded.substr(0, padded.find('\0'));
  const bool filled = std::all_of(padded.begin() + static_cast<std::ptrdiff_t>(name.size()), padded.end(),
                                  [](char c) { return c == '\0'; });
  if (name.empty() || !filled || !std::all_of(name.begin(), name.end(), is_printable))
    refuse_corrupt(file, "a section of the database has an unprintable name");
  const auto length = read_number<std::uint64_t>(entry, kNameSize);
  if (length > rest.size())
    refuse_corrupt(file, "section " + std::string(name) + " of the database is longer than the file");
  const std::string_view content = rest.substr(0, length);
  if (checksum(content) != read_number<std::uint64_t>(entry, kNameSize + 8))
    refuse_corrupt(file, "section " + std::string(name) + " of the database was changed (its checksum does not hold)");
  return {name, content};
}

}  // namespace

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t crc = ~std::uint64_t{0};
  std::size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    crc ^= read_number<std::uint64_t>(bytes, at);
    std::uint64_t next = 0;
    for (std::size_t i = 0; i < 8; ++i) next ^= kCrcTables[7 - i][(crc >> (8 * i)) & 0xFF];
    crc = next;
  }
  for (; at < bytes.size(); ++at)
    crc = (crc >> 8) ^ kCrcTables[0][(crc ^ static_cast<unsigned char>(bytes[at])) & 0xFF];
  return ~crc;
}

std::string encode_container(const std::vector<Section>& sections) {
  std::size_t length = kPreambleSize + sections.size() * kEntrySize + kChecksumSize;
  for (const Section& section : sections) length += section.content.size();

  std::string bytes;
  bytes.reserve(length);
  bytes += kMagic;
  append(bytes, kContainerVersion);
  append(bytes, kOldestReader);
  append(bytes, std::uint64_t{length});
  append(bytes, std::uint64_t{sections.size()});
  append(bytes, checksum(bytes));
  for (const Section& section : sections) {
    assert(!section.name.empty() && section.name.size() <= kNameSize);
    assert(std::all_of(section.name.begin(), section.name.end(), is_printable));
    bytes += section.name;
    bytes.append(kNameSize - section.name.size(), '\0');
    append(bytes, std::uint64_t{section.content.size()});
    append(bytes, checksum(section.content));
  }
  append(bytes, checksum(std::string_view(bytes).substr(kPreambleSize)));
  for (const Section& section : sections) bytes += section.content;
  assert(bytes.size() == length);
  return bytes;
}

std::vector<SectionView> decode_container(std::string_view bytes, const std::string& file) {
  const Preamble preamble = decode_preamble(bytes, file);
  check(preamble, bytes.size(), file);
  const std::string_view table = bytes.substr(kPreambleSize, preamble.sections * kEntrySize);
  const std::size_t table_end = kPreambleSize + table.size();
  if (checksum(table) != read_number<std::uint64_t>(bytes, table_end))
    refuse_corrupt(file, "the section table of the database was changed (its checksum does not hold)");

  std::vector<SectionView> sections;
  sections.reserve(preamble.sections);
  std::string_view rest = bytes.substr(table_end + kChecksumSize);
  for (std::size_t at = 0; at < table.size(); at += kEntrySize) {
    sections.push_back(decode_entry(table.substr(at, kEntrySize), rest, file));
    rest.remove_prefix(sections.back().content.size());
  }
  if (!rest.empty()) refuse_corrupt(file, "bytes of the database belong to no section");
  return sections;
}

}  // namespace foresight
