#include "common/scan_ply_header.h"

#include "common/errors.h"
#include "common/scan_format.h"

namespace foresight::ply {
namespace {

using scan_format::kMendDamaged;
using scan_format::quoted;

[[noreturn]] void refuse(const std::string& file, const std::string& cause) {
  throw InputError(file, cause, kMendDamaged);
}

Type read_type(const std::string& file, std::string_view word) {
  struct Name {
    std::string_view name;
    Type type;
  };
  static constexpr Name names[] = {
      {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
      {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
      {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
      {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64}};
  for (const Name& name : names) {
    if (name.name == word) return name.type;
  }
  refuse(file, "its PLY header has the unknown type " + quoted(word));
}

void read_format(const std::string& file, const std::vector<std::string_view>& words, Header& header) {
  if (words.size() != 3 || words[2] != "1.0") refuse(file, "its PLY format line is not one of version 1.0");
  if (words[1] == "ascii") {
    header.encoding = Encoding::ascii;
  } else if (words[1] == "binary_little_endian") {
    header.encoding = Encoding::little;
  } else if (words[1] == "binary_big_endian") {
    header.encoding = Encoding::big;
  } else {
    refuse(file, "its PLY format " + quoted(words[1]) + " is unknown");
  }
}

// "obj_info num_cols 512", "comment width 512" and the like; other remarks say nothing.
void read_remark(const std::string& file, const std::vector<std::string_view>& words, Header& header) {
  if (words.size() != 3) return;
  const bool columns = words[1] == "num_cols" || words[1] == "width";
  if (!columns && words[1] != "num_rows" && words[1] != "height") return;
  std::optional<std::int64_t>& side = columns ? header.columns : header.rows;
  std::int64_t value = 0;
  if (!scan_format::parse(words[2], value)) {
    refuse(file,
           "its PLY header says " + std::string(words[1]) + " " + quoted(words[2]) + ", which is no usable number");
  }
  if (side && *side != value) refuse(file, "its PLY header states two different grids");
  side = value;
}

void read_element(const std::string& file, const std::vector<std::string_view>& words, Header& header) {
  Element element;
  if (words.size() != 3 || !scan_format::parse(words[2], element.count)) {
    refuse(file, "its PLY header has an element without a usable count");
  }
  element.name = words[1];
  for (const Element& other : header.elements) {
    if (other.name == element.name) refuse(file, "its PLY header has the element " + quoted(element.name) + " twice");
  }
  header.elements.push_back(element);
}

void read_property(const std::string& file, const std::vector<std::string_view>& words, Header& header) {
  if (header.elements.empty()) refuse(file, "its PLY header has a property before the first element");
  Property property;
  if (words.size() == 3) {
    property = {words[2], read_type(file, words[1]), std::nullopt};
  } else if (words.size() == 5 && words[1] == "list") {
    property = {words[4], read_type(file, words[3]), read_type(file, words[2])};
  } else {
    refuse(file, "its PLY header has a property that is neither a number nor a list");
  }
  header.elements.back().properties.push_back(property);
}

}  // namespace

Header read_header(const std::string& file, std::string_view bytes) {
  Header header;
  std::string_view rest = bytes;
  bool format = false;
  while (!rest.empty() && bytes.size() - rest.size() <= scan_format::kLongestHeader) {
    const auto words = scan_format::words(scan_format::next_line(rest).substr(0, scan_format::kLongestHeader));
    if (words.empty() || words.front() == "ply") continue;
    if (words.front() == "format") {
      read_format(file, words, header);
      format = true;
    } else if (words.front() == "comment" || words.front() == "obj_info") {
      read_remark(file, words, header);
    } else if (words.front() == "element") {
      read_element(file, words, header);
    } else if (words.front() == "property") {
      read_property(file, words, header);
    } else if (words.front() == "end_header") {
      if (!format) refuse(file, "its PLY header has no format line");
      header.data = rest;
      return header;
    } else {
      refuse(file, "its PLY header has an unknown line " + quoted(words.front()));
    }
  }
  refuse(file, "its PLY header does not end");
}

}  // namespace foresight::ply
