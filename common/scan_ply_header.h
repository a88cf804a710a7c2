// The text before the data of a PLY file. Private to scan_ply.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace foresight::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Encoding { ascii, little, big };

struct Property {
  std::string_view name;
  Type type = Type::float32;
  std::optional<Type> length;  // of a list: the type of its length
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

// The names and the data are views of the file's bytes.
struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::optional<std::int64_t> columns;
  std::optional<std::int64_t> rows;
  std::string_view data;
};

// Throws InputError: anything that is no PLY header of version 1.0.
[[nodiscard]] Header read_header(const std::string& file, std::string_view bytes);

}  // namespace foresight::ply
