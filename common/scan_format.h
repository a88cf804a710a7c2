// What the readers of the scan formats share. Private to scan_file and its formats.
#pragma once

#include <Eigen/Core>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/range_image.h"

namespace foresight::scan_format {

inline constexpr const char* kMendDamaged = "write or copy the file again";
inline constexpr std::size_t kLongestHeader = 1 << 16;  // text before the data of a PCD or PLY file. Unit: bytes.

[[nodiscard]] bool is_pcd(std::string_view bytes);
[[nodiscard]] bool is_ply(std::string_view bytes);
[[nodiscard]] bool is_png(std::string_view bytes);
// file: for messages. unit_mm: see ScanReadOptions.
[[nodiscard]] RangeImage read_pcd(const std::string& file, std::string_view bytes, double unit_mm);
[[nodiscard]] RangeImage read_ply(const std::string& file, std::string_view bytes, double unit_mm);

struct GreyImage {
  int rows = 0;
  int columns = 0;
  int bits = 0;             // 8 or 16
  std::vector<int> values;  // row by row
};
// Any size from 1x1 to 4096x4096.
[[nodiscard]] GreyImage decode_grey_png(const std::string& file, std::string_view bytes);

// Throws InputError unless the grid has 32x32 to 4096x4096 cells; one row or column only is named unorganized.
void check_grid(const std::string& file, std::int64_t columns, std::int64_t rows);

// The last whole number in a file's name without its extension.
[[nodiscard]] std::optional<std::uint64_t> image_number(const std::string& scan_file);

// The point as a cell: NaN in all three when one is not finite or z is not in front of the sensor.
[[nodiscard]] Eigen::Vector3f cell_point(double x, double y, double z);

// The next line, without its end; shortens `rest`.
[[nodiscard]] std::string_view next_line(std::string_view& rest);
// The next word between blanks or line ends, empty at the end of the text; shortens `rest`.
[[nodiscard]] std::string_view next_word(std::string_view& rest);
[[nodiscard]] std::vector<std::string_view> words(std::string_view line);
// For messages: in quotes, printable, at most 40 characters.
[[nodiscard]] std::string quoted(std::string_view text);

// A whole word as a number; false when it is anything else or does not fit.
template <typename Number>
[[nodiscard]] bool parse(std::string_view word, Number& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size();
}

// A whole word as the nearest number of the type, NaN and infinity included; a word too large or small for a double
// becomes NaN, which marks an invalid cell. False when it is no number.
[[nodiscard]] bool parse_float(std::string_view word, bool single, double& number);

// A number out of a binary file. REQUIRES: sizeof(Number) readable bytes.
template <typename Number>
[[nodiscard]] Number load(const char* bytes, std::endian order) {
  char copy[sizeof(Number)];
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    copy[i] = bytes[order == std::endian::native ? i : sizeof(Number) - 1 - i];
  }
  Number number;
  std::memcpy(&number, copy, sizeof(Number));
  return number;
}

// Appends a number, little-endian.
template <typename Number>
void store_little(std::string& bytes, Number number) {
  char copy[sizeof(Number)];
  std::memcpy(copy, &number, sizeof(Number));
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    bytes += copy[std::endian::native == std::endian::little ? i : sizeof(Number) - 1 - i];
  }
}

}  // namespace foresight::scan_format
