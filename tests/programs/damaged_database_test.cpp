// Damage of every kind to a database, drawn at random: found out, or without effect. Silence is impossible, because
// checksums cover every byte; and where somebody computes them anew, the content is still checked.
#include <gtest/gtest.h>

#include "common/errors.h"
#include "common/random.h"
#include "compiler/database_writer.h"
#include "runtime/database.h"
#include "schema/container.h"
#include "tests/runtime/synthetic_database.h"

namespace foresight {
namespace {

constexpr int kMutations = 200;

std::size_t place(Random& random, std::size_t size) { return static_cast<std::size_t>(random.next() % size); }

// One random change: bits, bytes, runs of them; lost, doubled, moved or overwritten. REQUIRES: bytes not empty.
std::string mutated(std::string bytes, Random& random) {
  const std::size_t at = place(random, bytes.size());
  const std::size_t length = 1 + place(random, std::min<std::size_t>(64, bytes.size() - at));
  const std::string part = bytes.substr(at, length);
  switch (random.next() % 8) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random.next() % 8)));
      break;
    case 1:
      bytes[at] = static_cast<char>(random.next() & 0xFF);
      break;
    case 2:
      bytes.resize(at);
      break;
    case 3:
      bytes.erase(at, length);
      break;
    case 4:
      bytes.insert(at, part);
      break;
    case 5:
      bytes.replace(at, length, std::string(length, '\0'));
      break;
    case 6:
      bytes.replace(at, length, std::string(length, '\xFF'));
      break;
    default:
      bytes.erase(at, length).insert(place(random, bytes.size() + 1), part);
      break;
  }
  return bytes;
}

TEST(DamagedDatabase, is_refused_or_equal) {
  const std::string original = encode_database(test::synthetic_database());
  Random random(2024);
  int refused = 0;
  for (int i = 0; i < kMutations; ++i) {
    const std::string damaged = mutated(original, random);
    try {
      EXPECT_EQ(encode_database(decode_database(damaged, "x.db")), original) << "mutation " << i;
    } catch (const DatabaseError& error) {
      EXPECT_EQ(error.file(), "x.db");
      EXPECT_FALSE(error.cause().empty());
      ++refused;
    }
  }
  EXPECT_GT(refused, kMutations / 2);
}

// Damage under checksums that hold: what is let through is a database like any other.
TEST(DamagedDatabase, with_right_checksums_is_refused_or_usable) {
  const std::string original = encode_database(test::synthetic_database());
  Random random(2025);
  int refused = 0;
  for (int i = 0; i < 5 * kMutations; ++i) {
    std::vector<Section> sections;
    for (const SectionView& section : decode_container(original, "x.db")) {
      sections.push_back({std::string(section.name), std::string(section.content)});
    }
    std::string& content = sections[place(random, sections.size())].content;
    content = mutated(content, random);
    try {
      const CompiledDatabase decoded = decode_database(encode_container(sections), "x.db");
      const std::string again = encode_database(decoded);
      EXPECT_EQ(encode_database(decode_database(again, "x.db")), again) << "mutation " << i;
      const Database database(decoded);
      double sum = 0.0;
      for (int face = 0; face < static_cast<int>(database.faces().size()); ++face) sum += database.prior(face, 0.1);
      EXPECT_NEAR(sum, database.faces().empty() ? 0.0 : 0.9, 1e-9) << "mutation " << i;
    } catch (const DatabaseError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, kMutations);
}

}  // namespace
}  // namespace foresight
