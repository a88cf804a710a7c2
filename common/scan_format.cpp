#include "common/scan_format.h"

#include <cmath>
#include <limits>

#include "common/errors.h"

namespace foresight::scan_format {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

}  // namespace

void check_grid(const std::string& file, std::int64_t columns, std::int64_t rows) {
  const std::string size = std::to_string(columns) + "x" + std::to_string(rows) + " cells";
  if (columns < 1 || rows < 1) throw InputError(file, "its grid has " + size, kMendDamaged);
  if (columns == 1 || rows == 1) {
    throw InputError(file, "it holds unorganized points (" + size + ")",
                     "store the scan as an organized grid, rows by columns, as the sensor delivers it");
  }
  if (columns < kSmallestImageSide || rows < kSmallestImageSide) {
    throw InputError(file, "its grid of " + size + " is too small", "give a scan of at least 32x32 cells");
  }
  if (columns > kLargestImageSide || rows > kLargestImageSide) {
    throw InputError(file, "its grid of " + size + " is too large", "crop or thin the scan to at most 4096x4096 cells");
  }
}

Eigen::Vector3f cell_point(double x, double y, double z) {
  // After rounding: what overflows a float is as useless as infinity.
  const Eigen::Vector3f point(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  if (point.allFinite() && point.z() > 0.0F) return point;
  return Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
}

std::string_view next_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view next_word(std::string_view& rest) {
  const std::size_t start = std::min(rest.find_first_not_of(kBlanks), rest.size());
  rest.remove_prefix(start);
  const std::string_view word = rest.substr(0, std::min(rest.find_first_of(kBlanks), rest.size()));
  rest.remove_prefix(word.size());
  return word;
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> result;
  for (auto word = next_word(line); !word.empty(); word = next_word(line)) result.push_back(word);
  return result;
}

std::string quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > 40 ? "...'" : "'");
}

bool parse_float(std::string_view word, bool single, double& number) {
  // Straight to float: through double it would be rounded twice.
  float nearest = 0.0F;
  if (single && parse(word, nearest)) {
    number = static_cast<double>(nearest);
    return true;
  }
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) number = std::numeric_limits<double>::quiet_NaN();
  return true;
}

}  // namespace foresight::scan_format
