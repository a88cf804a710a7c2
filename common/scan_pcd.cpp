// Point Cloud Data files, the format of the Point Cloud Library: pointclouds.org/documentation, "The PCD file format".
#include <lzf.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/scan_file.h"
#include "common/scan_format.h"

namespace foresight {
namespace {

using scan_format::kMendDamaged;
using scan_format::quoted;

constexpr std::int64_t kLargestFieldCount = 1 << 16;
// LZF's longest copy makes 264 bytes out of 3.
constexpr std::uint64_t kLargestLzfRatio = 88;

struct Field {
  std::string_view name;
  char type = 'F';
  std::size_t size = 0;    // bytes of one value
  std::size_t count = 0;   // values in one point
  std::size_t offset = 0;  // bytes before it in one point
  std::size_t word = 0;    // words before it in one line of text
};

struct Header {
  std::vector<Field> fields;
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::size_t point_bytes = 0;
  std::size_t point_words = 0;
  PcdEncoding encoding = PcdEncoding::ascii;
  std::string_view data;

  [[nodiscard]] std::size_t points() const { return rows * columns; }
};

using Lines = std::map<std::string_view, std::vector<std::string_view>>;

[[noreturn]] void refuse(const std::string& file, const std::string& cause) {
  throw InputError(file, cause, kMendDamaged);
}

// Keyword and values of each line up to DATA; `rest` is what follows it.
Lines read_lines(const std::string& file, std::string_view& rest) {
  static constexpr std::array<std::string_view, 11> known = {
      "VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
  Lines lines;
  const std::size_t whole = rest.size();
  while (!rest.empty() && lines.count("DATA") == 0) {
    auto line = scan_format::words(scan_format::next_line(rest).substr(0, scan_format::kLongestHeader));
    if (whole - rest.size() > scan_format::kLongestHeader) break;
    if (line.empty() || line.front().starts_with('#')) continue;
    const std::string_view key = line.front() == "COLUMNS" ? "FIELDS" : line.front();
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      refuse(file, "its PCD header has an unknown line " + quoted(key));
    }
    line.erase(line.begin());
    if (!lines.emplace(key, std::move(line)).second)
      refuse(file, "its PCD header states " + std::string(key) + " twice");
  }
  if (lines.count("DATA") == 0) refuse(file, "its PCD header does not end with a DATA line");
  return lines;
}

const std::vector<std::string_view>& line_of(const std::string& file, const Lines& lines, std::string_view key) {
  const auto line = lines.find(key);
  if (line == lines.end()) refuse(file, "its PCD header has no line " + std::string(key));
  return line->second;
}

std::int64_t integer(const std::string& file, std::string_view key, std::string_view word) {
  std::int64_t value = 0;
  if (!scan_format::parse(word, value)) {
    refuse(file, "its PCD header says " + std::string(key) + " " + quoted(word) + ", which is no usable number");
  }
  return value;
}

std::int64_t integer_line(const std::string& file, const Lines& lines, std::string_view key) {
  const auto& values = line_of(file, lines, key);
  if (values.size() != 1) refuse(file, "its PCD header needs one number after " + std::string(key));
  return integer(file, key, values.front());
}

Field read_field(const std::string& file, std::string_view name, std::string_view size, std::string_view type,
                 std::string_view count) {
  const std::int64_t bytes = integer(file, "SIZE", size);
  const std::int64_t values = integer(file, "COUNT", count);
  if (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8) {
    refuse(file, "field " + quoted(name) + " has SIZE " + quoted(size) + ", not 1, 2, 4 or 8");
  }
  if (type != "F" && type != "I" && type != "U") {
    refuse(file, "field " + quoted(name) + " has TYPE " + quoted(type) + ", not I, U or F");
  }
  if (values < 1 || values > kLargestFieldCount) {
    refuse(file, "field " + quoted(name) + " has COUNT " + quoted(count) + ", not 1 to 65536");
  }
  return {name, type.front(), static_cast<std::size_t>(bytes), static_cast<std::size_t>(values), 0, 0};
}

void read_fields(const std::string& file, const Lines& lines, Header& header) {
  const auto& names = line_of(file, lines, "FIELDS");
  const auto& sizes = line_of(file, lines, "SIZE");
  const auto& types = line_of(file, lines, "TYPE");
  const auto counts = lines.find("COUNT");
  if (sizes.size() != names.size() || types.size() != names.size() ||
      (counts != lines.end() && counts->second.size() != names.size())) {
    refuse(file, "its PCD header has FIELDS, SIZE, TYPE and COUNT lines of different lengths");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    Field field = read_field(file, names[i], sizes[i], types[i], counts == lines.end() ? "1" : counts->second[i]);
    field.offset = header.point_bytes;
    field.word = header.point_words;
    header.point_bytes += field.size * field.count;
    header.point_words += field.count;
    header.fields.push_back(field);
  }
}

PcdEncoding read_encoding(const std::string& file, const Lines& lines) {
  const auto& words = line_of(file, lines, "DATA");
  if (words.size() == 1 && words.front() == "ascii") return PcdEncoding::ascii;
  if (words.size() == 1 && words.front() == "binary") return PcdEncoding::binary;
  if (words.size() == 1 && words.front() == "binary_compressed") return PcdEncoding::binary_compressed;
  refuse(file,
         "its DATA is " + quoted(words.empty() ? "" : words.front()) + ", not ascii, binary or binary_compressed");
}

Header read_header(const std::string& file, std::string_view bytes) {
  Header header;
  const Lines lines = read_lines(file, bytes);
  header.data = bytes;
  const auto& version = line_of(file, lines, "VERSION");
  if (version.size() != 1 || (version.front() != "0.7" && version.front() != ".7")) {
    throw InputError(file, "its PCD version is " + quoted(version.empty() ? "" : version.front()),
                     "write it as PCD version 0.7");
  }
  read_fields(file, lines, header);
  const std::int64_t columns = integer_line(file, lines, "WIDTH");
  const std::int64_t rows = integer_line(file, lines, "HEIGHT");
  scan_format::check_grid(file, columns, rows);
  if (lines.count("POINTS") != 0 && integer_line(file, lines, "POINTS") != columns * rows) {
    refuse(file, "its POINTS are not WIDTH times HEIGHT");
  }
  header.columns = static_cast<std::size_t>(columns);
  header.rows = static_cast<std::size_t>(rows);
  header.encoding = read_encoding(file, lines);
  return header;
}

std::array<Field, 3> coordinates(const std::string& file, const Header& header) {
  std::array<Field, 3> result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view name = std::string_view("xyz").substr(axis, 1);
    const auto named = [&](const Field& field) { return field.name == name; };
    const auto field = std::find_if(header.fields.begin(), header.fields.end(), named);
    if (field == header.fields.end()) {
      throw InputError(file, "it has no field " + std::string(name), "store x, y and z of every cell");
    }
    if (std::find_if(field + 1, header.fields.end(), named) != header.fields.end()) {
      refuse(file, "it has two fields " + std::string(name));
    }
    if (field->type != 'F' || field->size < 4 || field->count != 1) {
      throw InputError(file, "its field " + std::string(name) + " is no single float",
                       "store x, y and z as TYPE F, SIZE 4 or 8, COUNT 1");
    }
    result[axis] = *field;
  }
  return result;
}

RangeImage read_ascii(const std::string& file, const Header& header, double unit_mm) {
  // A word and its blank are two bytes at least: a lie about the size is found before the image is allocated.
  if (header.points() > (header.data.size() + 1) / (2 * header.point_words)) {
    refuse(file, "it is cut short, or its WIDTH and HEIGHT are wrong");
  }
  const std::array<Field, 3> xyz = coordinates(file, header);
  RangeImage image(static_cast<int>(header.rows), static_cast<int>(header.columns));
  std::string_view rest = header.data;
  std::size_t point = 0;
  while (!rest.empty()) {
    std::string_view line = scan_format::next_line(rest);
    std::array<double, 3> value{};
    std::size_t count = 0;
    for (auto word = scan_format::next_word(line); !word.empty(); word = scan_format::next_word(line), ++count) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (xyz[axis].word == count && !scan_format::parse_float(word, xyz[axis].size == 4, value[axis])) {
          refuse(file, "point " + std::to_string(point) + " has " + quoted(word) + " where a number is expected");
        }
      }
    }
    if (count == 0) continue;
    if (count != header.point_words) {
      refuse(file, "point " + std::to_string(point) + " has " + std::to_string(count) + " values instead of " +
                       std::to_string(header.point_words));
    }
    if (point == header.points()) refuse(file, "it holds more points than WIDTH times HEIGHT");
    image[static_cast<int>(point++)] =
        scan_format::cell_point(value[0] * unit_mm, value[1] * unit_mm, value[2] * unit_mm);
  }
  if (point != header.points()) refuse(file, "it is cut short after " + std::to_string(point) + " points");
  return image;
}

// The uncompressed bytes of binary_compressed: all of the first field, then all of the second, and so on.
std::string decompress(const std::string& file, const Header& header) {
  if (header.data.size() < 8) refuse(file, "it is cut short");
  const std::uint64_t packed = scan_format::load<std::uint32_t>(header.data.data(), std::endian::little);
  const std::uint64_t whole = scan_format::load<std::uint32_t>(header.data.data() + 4, std::endian::little);
  if (packed > header.data.size() - 8) refuse(file, "it is cut short");
  if (whole != header.points() * header.point_bytes || whole > packed * kLargestLzfRatio) {
    refuse(file, "the sizes of its compressed data contradict its header");
  }
  std::string bytes(whole, '\0');
  const unsigned size =
      lzf_decompress(header.data.data() + 8, static_cast<unsigned>(packed), bytes.data(), static_cast<unsigned>(whole));
  if (size != whole) refuse(file, "its compressed data is damaged");
  return bytes;
}

RangeImage read_binary(const std::string& file, const Header& header, double unit_mm) {
  const std::array<Field, 3> xyz = coordinates(file, header);
  const bool packed = header.encoding == PcdEncoding::binary_compressed;
  if (!packed && header.points() > header.data.size() / header.point_bytes) {
    refuse(file, "it is cut short, or its WIDTH and HEIGHT are wrong");
  }
  const std::string unpacked = packed ? decompress(file, header) : std::string();
  const std::string_view bytes = packed ? std::string_view(unpacked) : header.data;
  RangeImage image(static_cast<int>(header.rows), static_cast<int>(header.columns));
  const auto value = [&](std::size_t axis, std::size_t point) {
    const Field& field = xyz[axis];
    const char* at = bytes.data() + (packed ? field.offset * header.points() + point * field.size
                                            : field.offset + point * header.point_bytes);
    return unit_mm * (field.size == 4 ? static_cast<double>(scan_format::load<float>(at, std::endian::little))
                                      : scan_format::load<double>(at, std::endian::little));
  };
  for (std::size_t point = 0; point < header.points(); ++point) {
    image[static_cast<int>(point)] = scan_format::cell_point(value(0, point), value(1, point), value(2, point));
  }
  return image;
}

}  // namespace

bool scan_format::is_pcd(std::string_view bytes) {
  bytes = bytes.substr(0, kLongestHeader);
  while (!bytes.empty()) {
    std::string_view line = next_line(bytes);
    const std::string_view word = next_word(line);
    if (word.empty()) continue;
    if (word == "#" && next_word(line) == ".PCD") return true;
    if (!word.starts_with('#')) return word == "VERSION" || word == "FIELDS" || word == "COLUMNS";
  }
  return false;
}

RangeImage scan_format::read_pcd(const std::string& file, std::string_view bytes, double unit_mm) {
  const Header header = read_header(file, bytes);
  return header.encoding == PcdEncoding::ascii ? read_ascii(file, header, unit_mm) : read_binary(file, header, unit_mm);
}

}  // namespace foresight
