#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <vector>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/scan_file.h"
#include "common/scan_format.h"

namespace foresight {
namespace {

void append_literals(std::string& packed, std::string_view bytes) {
  for (; !bytes.empty(); bytes.remove_prefix(std::min<std::size_t>(bytes.size(), 32))) {
    const std::string_view run = bytes.substr(0, 32);
    packed += static_cast<char>(run.size() - 1);
    packed += run;
  }
}

// length: 3 to 264 bytes. back: 1 to 8192 bytes before here.
void append_copy(std::string& packed, std::size_t length, std::size_t back) {
  const std::size_t code = length - 2;
  const std::size_t offset = back - 1;
  packed += static_cast<char>((std::min<std::size_t>(code, 7) << 5) | (offset >> 8));
  if (code >= 7) packed += static_cast<char>(code - 7);
  packed += static_cast<char>(offset & 0xFFU);
}

// LZF, greedy: the last place with the same three bytes, if it is near enough. Own code, because liblzf's compressor
// starts from an uninitialised table: its bytes differ from run to run. Any LZF decompressor reads either.
std::string compress(std::string_view bytes) {
  constexpr std::size_t kFarthest = 8192;
  constexpr std::size_t kLongest = 264;
  constexpr unsigned kTableBits = 14;
  std::vector<std::size_t> last(std::size_t{1} << kTableBits, std::string_view::npos);
  std::string packed;
  packed.reserve(bytes.size() / 2);
  std::size_t copied = 0;  // everything before is in `packed`
  std::size_t at = 0;
  while (at + 3 <= bytes.size()) {
    const auto byte = [&](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(bytes[at + i])}; };
    const std::uint32_t hash = ((byte(0) << 16 | byte(1) << 8 | byte(2)) * 2654435761U) >> (32 - kTableBits);
    const std::size_t before = last[hash];
    last[hash] = at;
    if (before == std::string_view::npos || at - before > kFarthest || bytes.substr(before, 3) != bytes.substr(at, 3)) {
      ++at;
      continue;
    }
    std::size_t length = 3;
    while (length < kLongest && at + length < bytes.size() && bytes[before + length] == bytes[at + length]) ++length;
    append_literals(packed, bytes.substr(copied, at - copied));
    append_copy(packed, length, at - before);
    at += length;
    copied = at;
  }
  append_literals(packed, bytes.substr(copied));
  return packed;
}

std::string header(const RangeImage& image, std::string_view data) {
  std::string text =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  text += "WIDTH " + std::to_string(image.columns) + "\nHEIGHT " + std::to_string(image.rows) + "\n";
  text += "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(image.size()) + "\nDATA ";
  return text.append(data) + "\n";
}

void append_ascii(std::string& text, const RangeImage& image) {
  std::array<char, 32> word{};
  for (const Eigen::Vector3f& point : image.points) {
    for (int axis = 0; axis < 3; ++axis) {
      // The shortest text that reads back to the same float.
      const auto end = std::to_chars(word.data(), word.data() + word.size(), point[axis]).ptr;
      text.append(std::isnan(point[axis]) ? std::string_view("nan") : std::string_view(word.data(), end));
      text += axis < 2 ? ' ' : '\n';
    }
  }
}

void append_compressed(std::string& text, const RangeImage& image) {
  std::string planes;
  planes.reserve(image.points.size() * 12);
  for (int axis = 0; axis < 3; ++axis) {
    for (const Eigen::Vector3f& point : image.points) scan_format::store_little(planes, point[axis]);
  }
  const std::string packed = compress(planes);
  scan_format::store_little(text, static_cast<std::uint32_t>(packed.size()));
  scan_format::store_little(text, static_cast<std::uint32_t>(planes.size()));
  text += packed;
}

}  // namespace

void write_pcd(const std::string& file, const RangeImage& image, PcdEncoding encoding) {
  assert(image.points.size() == static_cast<std::size_t>(image.size()));
  std::string content;
  switch (encoding) {
    case PcdEncoding::ascii:
      content = header(image, "ascii");
      append_ascii(content, image);
      break;
    case PcdEncoding::binary:
      content = header(image, "binary");
      for (const Eigen::Vector3f& point : image.points) {
        for (int axis = 0; axis < 3; ++axis) scan_format::store_little(content, point[axis]);
      }
      break;
    case PcdEncoding::binary_compressed:
      content = header(image, "binary_compressed");
      append_compressed(content, image);
      break;
  }
  write_file_atomically(file, content);
}

}  // namespace foresight
