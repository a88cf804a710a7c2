// PLY files with a grid: Greg Turk's Polygon File Format, with the range grids of the Stanford 3D Scanning Repository.
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/errors.h"
#include "common/scan_format.h"
#include "common/scan_ply_header.h"

namespace foresight {
namespace {

using ply::Element;
using ply::Encoding;
using ply::Header;
using ply::Property;
using ply::Type;
using scan_format::kMendDamaged;
using scan_format::quoted;

[[noreturn]] void refuse(const std::string& file, const std::string& cause) {
  throw InputError(file, cause, kMendDamaged);
}

std::size_t size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::int32:
    case Type::uint32:
    case Type::float32:
      return 4;
    case Type::float64:
      return 8;
  }
  return 8;
}

// The numbers after the header, one after the other, in any of the three encodings.
class Body {
 public:
  Body(const std::string& file, std::string_view bytes, Encoding encoding)
      : file_(file), rest_(bytes), encoding_(encoding) {}

  [[nodiscard]] double number(Type type) {
    if (encoding_ == Encoding::ascii) return word_number(type);
    const char* at = take(size_of(type));
    const std::endian order = encoding_ == Encoding::little ? std::endian::little : std::endian::big;
    switch (type) {
      case Type::int8:
        return scan_format::load<std::int8_t>(at, order);
      case Type::uint8:
        return scan_format::load<std::uint8_t>(at, order);
      case Type::int16:
        return scan_format::load<std::int16_t>(at, order);
      case Type::uint16:
        return scan_format::load<std::uint16_t>(at, order);
      case Type::int32:
        return scan_format::load<std::int32_t>(at, order);
      case Type::uint32:
        return scan_format::load<std::uint32_t>(at, order);
      case Type::float32:
        return static_cast<double>(scan_format::load<float>(at, order));
      case Type::float64:
        return scan_format::load<double>(at, order);
    }
    return 0.0;
  }

  // A list's length: no more items than there are bytes left.
  [[nodiscard]] std::size_t length(Type type) {
    const double value = number(type);
    if (!(value >= 0.0) || value != std::floor(value) || value > static_cast<double>(rest_.size())) {
      refuse(file_, "it holds a list of impossible length, or is cut short");
    }
    return static_cast<std::size_t>(value);
  }

  void skip(const Property& property) {
    const std::size_t count = property.length ? length(*property.length) : 1;
    if (encoding_ != Encoding::ascii) {
      take(count * size_of(property.type));
    } else {
      for (std::size_t i = 0; i < count; ++i) word();
    }
  }

  // Refuses an element that cannot fit into what is left, before anything is allocated for it.
  void check_fits(const Element& element) const {
    std::uint64_t smallest = 0;
    for (const Property& property : element.properties) {
      smallest += encoding_ == Encoding::ascii ? 2 : size_of(property.length.value_or(property.type));
    }
    if (smallest > 0 && element.count > (rest_.size() + 1) / smallest) {
      refuse(file_, "it is cut short: " + std::to_string(element.count) + " of " + quoted(element.name) +
                        " are announced and do not fit");
    }
  }

 private:
  const char* take(std::size_t size) {
    if (size > rest_.size()) refuse(file_, "it is cut short");
    const char* at = rest_.data();
    rest_.remove_prefix(size);
    return at;
  }
  std::string_view word() {
    const std::string_view result = scan_format::next_word(rest_);
    if (result.empty()) refuse(file_, "it is cut short");
    return result;
  }
  double word_number(Type type) {
    const std::string_view text = word();
    double value = 0.0;
    if (!scan_format::parse_float(text, type == Type::float32, value)) {
      refuse(file_, "it has " + quoted(text) + " where a number is expected");
    }
    return value;
  }

  const std::string& file_;
  std::string_view rest_;
  Encoding encoding_;
};

std::vector<Eigen::Vector3f> read_vertices(const std::string& file, const Element& element, Body& body,
                                           double unit_mm) {
  std::vector<int> axes;  // of each property: 0 to 2, or -1
  for (const Property& property : element.properties) {
    const bool coordinate = property.name == "x" || property.name == "y" || property.name == "z";
    axes.push_back(coordinate && !property.length ? property.name.front() - 'x' : -1);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (std::count(axes.begin(), axes.end(), axis) != 1) {
      throw InputError(file, "its vertices do not have one x, one y and one z", "store x, y and z of every vertex");
    }
  }
  std::vector<Eigen::Vector3f> vertices(element.count);
  for (Eigen::Vector3f& vertex : vertices) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (axes[i] < 0) {
        body.skip(element.properties[i]);
      } else {
        point[axes[i]] = body.number(element.properties[i].type) * unit_mm;
      }
    }
    vertex = scan_format::cell_point(point.x(), point.y(), point.z());
  }
  return vertices;
}

// Of each cell its vertex, or -1.
std::vector<std::int64_t> read_range_grid(const std::string& file, const Element& element, Body& body) {
  if (element.properties.size() != 1 || !element.properties.front().length) {
    refuse(file, "its range_grid is not one list of vertices a cell");
  }
  const Property& property = element.properties.front();
  std::vector<std::int64_t> grid(element.count, -1);
  for (std::int64_t& vertex : grid) {
    const std::size_t count = body.length(*property.length);
    if (count > 1) refuse(file, "a cell of its range_grid names more than one vertex");
    if (count == 0) continue;
    const double index = body.number(property.type);
    if (!(index >= 0.0) || index != std::floor(index) || index > 4294967295.0) {
      refuse(file, "its range_grid names a vertex that does not exist");
    }
    vertex = static_cast<std::int64_t>(index);
  }
  return grid;
}

const Element* find(const Header& header, std::string_view name) {
  for (const Element& element : header.elements) {
    if (element.name == name) return &element;
  }
  return nullptr;
}

// The grid's size, after all counts agree with it.
RangeImage empty_image(const std::string& file, const Header& header) {
  const Element* vertices = find(header, "vertex");
  const Element* grid = find(header, "range_grid");
  if (vertices == nullptr) throw InputError(file, "it has no vertices", "store the scan's points as PLY vertices");
  if (!header.columns || !header.rows) {
    throw InputError(file, "it holds unorganized points: the PLY header states no grid",
                     "store the scan's grid, 'obj_info num_cols N' and 'obj_info num_rows N' in the header");
  }
  scan_format::check_grid(file, *header.columns, *header.rows);
  const auto cells = static_cast<std::uint64_t>(*header.columns * *header.rows);
  const bool fits = grid == nullptr ? vertices->count == cells : grid->count == cells && vertices->count <= cells;
  if (!fits) {
    throw InputError(file,
                     "its " + std::to_string((grid == nullptr ? vertices : grid)->count) +
                         " points do not fill the grid of " + std::to_string(*header.columns) + "x" +
                         std::to_string(*header.rows) + " cells",
                     "store one vertex a cell, invalid ones as NaN, or a range_grid");
  }
  return {static_cast<int>(*header.rows), static_cast<int>(*header.columns)};
}

}  // namespace

bool scan_format::is_ply(std::string_view bytes) { return next_line(bytes) == "ply"; }

RangeImage scan_format::read_ply(const std::string& file, std::string_view bytes, double unit_mm) {
  const Header header = ply::read_header(file, bytes);
  Body body(file, header.data, header.encoding);
  const bool with_grid = find(header, "range_grid") != nullptr;
  std::optional<std::vector<Eigen::Vector3f>> vertices;
  std::optional<std::vector<std::int64_t>> grid;
  RangeImage image = empty_image(file, header);
  for (const Element& element : header.elements) {
    if (vertices && (grid || !with_grid)) break;  // what follows, faces for instance, is of no interest
    body.check_fits(element);
    if (element.name == "vertex") {
      vertices = read_vertices(file, element, body, unit_mm);
    } else if (element.name == "range_grid") {
      grid = read_range_grid(file, element, body);
    } else if (!element.properties.empty()) {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) body.skip(property);
      }
    }
  }
  if (!with_grid) {
    image.points.assign(vertices->begin(), vertices->end());
    return image;
  }
  for (std::size_t cell = 0; cell < grid->size(); ++cell) {
    const std::int64_t vertex = (*grid)[cell];
    if (vertex < 0) continue;
    if (static_cast<std::size_t>(vertex) >= vertices->size()) {
      refuse(file, "its range_grid names a vertex that does not exist");
    }
    image.points[cell] = (*vertices)[static_cast<std::size_t>(vertex)];
  }
  return image;
}

}  // namespace foresight
