#include "schema/container.h"

#include <gtest/gtest.h>

#include <optional>

#include "common/errors.h"

namespace foresight {
namespace {

const std::vector<Section> kSections = {
    {"header", std::string("a\0b", 3)}, {"model", "first"}, {"model", ""}, {"x", "seventeen bytes.."}};

// The fault of decoding, or none when the bytes were accepted.
std::optional<DatabaseFault> fault_of(std::string_view bytes) {
  try {
    (void)decode_container(bytes, "x.db");
    return std::nullopt;
  } catch (const DatabaseError& error) {
    EXPECT_EQ(error.exit_code(), kExitBadDatabase);
    EXPECT_EQ(error.file(), "x.db");
    EXPECT_FALSE(error.cause().empty());
    EXPECT_FALSE(error.mend().empty());
    return error.fault();
  }
}

std::string cause_of(std::string_view bytes) {
  try {
    (void)decode_container(bytes, "x.db");
    return "";
  } catch (const DatabaseError& error) {
    return error.cause();
  }
}

void write_number(std::string& bytes, std::size_t at, std::uint64_t number, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<char>((number >> (8 * i)) & 0xFF);
}

void mend_preamble(std::string& bytes) { write_number(bytes, 32, checksum(std::string_view(bytes).substr(0, 32)), 8); }

void mend_table(std::string& bytes, std::size_t sections) {
  const std::size_t size = 48 * sections;
  write_number(bytes, 40 + size, checksum(std::string_view(bytes).substr(40, size)), 8);
}

TEST(Container, returns_the_sections_it_was_given_in_order) {
  const std::string bytes = encode_container(kSections);
  const std::vector<SectionView> read = decode_container(bytes, "x.db");
  ASSERT_EQ(read.size(), kSections.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].name, kSections[i].name);
    EXPECT_EQ(read[i].content, kSections[i].content);
  }
}

TEST(Container, holds_no_section_and_names_of_32_bytes) {
  EXPECT_TRUE(decode_container(encode_container({}), "x.db").empty());
  const std::string longest(32, 'n');
  EXPECT_EQ(decode_container(encode_container({{longest, "c"}}), "x.db").at(0).name, longest);
}

TEST(Container, writes_the_same_bytes_for_the_same_sections) {
  EXPECT_EQ(encode_container(kSections), encode_container(kSections));
}

// The layout that schema/README.md promises.
TEST(Container, has_the_documented_layout) {
  const std::string bytes = encode_container({{"header", "abc"}});
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x89"
                                            "FSD\r\n\x1a\n"));
  EXPECT_EQ(bytes.substr(8, 8), std::string("\1\0\0\0\1\0\0\0", 8));
  EXPECT_EQ(bytes.substr(16, 16), std::string("\x63\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0", 16));
  EXPECT_EQ(bytes.substr(40, 32), "header" + std::string(26, '\0'));
  EXPECT_EQ(bytes.substr(72, 8), std::string("\3\0\0\0\0\0\0\0", 8));
  EXPECT_EQ(bytes.size(), 99U);
  EXPECT_EQ(bytes.substr(96), "abc");
}

TEST(Container, checksum_has_the_published_check_value) {
  EXPECT_EQ(checksum("123456789"), 0x995DC9BBDF1939FAU);
  EXPECT_EQ(checksum(""), 0U);
}

TEST(Container, detects_every_flipped_bit) {
  std::string bytes = encode_container(kSections);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const char mask = static_cast<char>(1 << (bit % 8));
    bytes[bit / 8] ^= mask;
    const DatabaseFault expected = bit < 64 ? DatabaseFault::wrong_kind : DatabaseFault::corrupt;
    EXPECT_EQ(fault_of(bytes), expected) << "bit " << bit;
    bytes[bit / 8] ^= mask;
  }
  EXPECT_EQ(fault_of(bytes), std::nullopt);
}

TEST(Container, detects_every_truncation) {
  const std::string bytes = encode_container(kSections);
  EXPECT_EQ(fault_of(""), DatabaseFault::wrong_kind);
  for (std::size_t size = 1; size < bytes.size(); ++size)
    EXPECT_EQ(fault_of(bytes.substr(0, size)), DatabaseFault::truncated) << size << " bytes";
}

TEST(Container, detects_bytes_after_the_end) {
  const std::string bytes = encode_container(kSections);
  EXPECT_EQ(fault_of(bytes + '\0'), DatabaseFault::corrupt);
  EXPECT_EQ(fault_of(bytes + bytes), DatabaseFault::corrupt);
}

TEST(Container, detects_exchanged_sections_and_exchanged_files) {
  std::string bytes = encode_container({{"model", "abc"}, {"model", "xyz"}});
  std::string exchanged = bytes;
  exchanged.replace(exchanged.size() - 6, 6, "xyzabc");
  EXPECT_EQ(fault_of(exchanged), DatabaseFault::corrupt);
  const std::string other = encode_container({{"model", "abd"}, {"model", "xyz"}});
  EXPECT_EQ(fault_of(bytes.substr(0, bytes.size() - 6) + other.substr(other.size() - 6)), DatabaseFault::corrupt);
}

TEST(Container, names_the_kind_of_a_foreign_file) {
  const auto expect_kind = [](std::string_view bytes, const std::string& word) {
    EXPECT_EQ(fault_of(bytes), DatabaseFault::wrong_kind) << word;
    EXPECT_NE(cause_of(bytes).find(word), std::string::npos) << cause_of(bytes);
  };
  expect_kind("", "empty");
  expect_kind("\x89PNG\r\n\x1a\n....", "PNG");
  expect_kind("ply\nformat ascii 1.0\n", "PLY");
  expect_kind("# .PCD v.7 - Point Cloud Data file format\n", "PCD");
  expect_kind("# Blender OBJ\nv 0 0 0\n", "text");
  expect_kind(
      "\x89"
      "FSD\n\x1a\n...",
      "text mode");
  expect_kind(std::string_view("\x7f"
                               "ELF\2\1\1\0",
                               8),
              "not a Foresight database");
  expect_kind(std::string(4096, '\0'), "not a Foresight database");
}

TEST(Container, refuses_only_files_that_ask_for_a_newer_reader) {
  std::string bytes = encode_container(kSections);
  write_number(bytes, 8, kContainerVersion + 1, 4);
  mend_preamble(bytes);
  EXPECT_EQ(fault_of(bytes), std::nullopt);
  write_number(bytes, 12, kContainerVersion + 1, 4);
  mend_preamble(bytes);
  EXPECT_EQ(fault_of(bytes), DatabaseFault::newer_version);
  bytes.resize(50);  // a newer container may be laid out otherwise: its version is told before anything else
  EXPECT_EQ(fault_of(bytes), DatabaseFault::newer_version);
}

// Checksums hold, but the numbers are made to mislead a reader.
TEST(Container, survives_crafted_lengths_and_counts) {
  for (const std::uint64_t count : {5ULL, 1ULL << 32, ~0ULL, ~0ULL / 48 + 1}) {
    std::string bytes = encode_container(kSections);
    write_number(bytes, 24, count, 8);
    mend_preamble(bytes);
    EXPECT_EQ(fault_of(bytes), DatabaseFault::corrupt) << count;
  }
  for (const std::uint64_t length : {0ULL, 4ULL, 1ULL << 40, ~0ULL}) {
    std::string bytes = encode_container(kSections);
    write_number(bytes, 40 + 32, length, 8);
    mend_table(bytes, kSections.size());
    EXPECT_EQ(fault_of(bytes), DatabaseFault::corrupt) << length;
  }
  std::string unowned = encode_container({{"x", ""}}) + "abc";
  write_number(unowned, 16, unowned.size(), 8);
  mend_preamble(unowned);
  EXPECT_EQ(fault_of(unowned), DatabaseFault::corrupt);
}

TEST(Container, refuses_unprintable_section_names) {
  for (const std::string& name :
       {std::string("\0x", 2), std::string("a\nb"), std::string("a\0b", 3), std::string("\xff")}) {
    std::string bytes = encode_container({{"xxx", "content"}});
    bytes.replace(40, 3, name + std::string(3 - name.size(), '\0'));
    mend_table(bytes, 1);
    EXPECT_EQ(fault_of(bytes), DatabaseFault::corrupt);
  }
}

}  // namespace
}  // namespace foresight
