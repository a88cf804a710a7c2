#include "common/golden_scan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace foresight {
namespace {

constexpr double kFinestShare = 1.0 / 65536.0;      // of the farthest distance
constexpr double kNoiseShare = 0.25;                // of the noise
constexpr double kFarthest = 1e6;                   // as in runtime/database_check.cpp. Unit: mm.
constexpr std::int64_t kMostSteps = 1'000'000'000;  // of one depth
constexpr int kRunOrder = 5;                        // of the code: runs are some tens of cells long
constexpr int kHighestOrder = 15;

// Depths of a window in steps, row by row; 0 where there are no data.
struct Window {
  int columns = 0;
  std::vector<std::int32_t> steps;

  // What the cells before this one, in the order of coding, promise for it. last: of the last cell with data.
  [[nodiscard]] std::int64_t promised(std::size_t cell, std::int64_t last) const {
    const auto width = static_cast<std::size_t>(columns);
    const std::size_t column = cell % width;
    const auto at = [&](bool inside, std::size_t back) { return std::int64_t{inside ? steps[cell - back] : 0}; };
    const std::int64_t before = at(column >= 1, 1), second = at(column >= 2, 2);
    const std::int64_t above = at(cell >= width, width), above_before = at(cell >= width && column >= 1, width + 1);
    if (before > 0 && above > 0 && above_before > 0) return before + above - above_before;
    if (before > 0 && second > 0) return 2 * before - second;
    if (before > 0) return before;
    return above > 0 ? above : last;
  }
};

// Small numbers of either sign become small ones without.
std::uint64_t zigzag(std::int64_t number) {
  return (static_cast<std::uint64_t>(number) << 1) ^ static_cast<std::uint64_t>(number >> 63);
}

std::int64_t from_zigzag(std::uint64_t number) {
  return static_cast<std::int64_t>(number >> 1) ^ -static_cast<std::int64_t>(number & 1);
}

// Bits that a number takes in an exponential Golomb code: of number + 2^order, and before them a zero for each but the
// first and as many as the order.
int code_length(std::uint64_t number, int order) {
  return 2 * std::bit_width(number + (std::uint64_t{1} << order)) - 1 - order;
}

class BitWriter {
 public:
  explicit BitWriter(std::string& bytes) : bytes_(bytes) {}

  void put(std::uint64_t number, int order) {
    const std::uint64_t shown = number + (std::uint64_t{1} << order);
    for (int bit = code_length(number, order) - 1; bit >= 0; --bit) {
      if (used_ == 0) bytes_ += '\0';
      const bool is_set = bit < 64 && (shown >> bit & 1) != 0;
      if (is_set) bytes_.back() = static_cast<char>(bytes_.back() | 0x80 >> used_);
      used_ = (used_ + 1) % 8;
    }
  }

 private:
  std::string& bytes_;
  int used_ = 0;  // bits of the last byte; 0: all
};

class BitReader {
 public:
  explicit BitReader(std::string_view bytes) : bytes_(bytes) {}

  // None when the bytes end early, or the number is longer than any that is written.
  std::optional<std::uint64_t> take(int order) {
    const int zeros = std::countl_zero(next_bits());
    if (zeros > kMostZeros) return std::nullopt;
    at_ += static_cast<std::size_t>(zeros);
    const int length = zeros + 1 + order;
    const std::uint64_t shown = next_bits() >> (64 - length);
    at_ += static_cast<std::size_t>(length);
    if (at_ > 8 * bytes_.size()) return std::nullopt;
    return shown - (std::uint64_t{1} << order);
  }
  // Nothing is left but what fills the last byte, and that is zeros.
  [[nodiscard]] bool at_end() const { return (at_ + 7) / 8 == bytes_.size() && next_bits() == 0; }

 private:
  static constexpr int kMostZeros = 34;

  // 56 or more, the first one highest; zeros beyond the end.
  [[nodiscard]] std::uint64_t next_bits() const {
    std::uint64_t bits = 0;
    for (std::size_t i = at_ / 8; i < at_ / 8 + 8; ++i)
      bits = bits << 8 | (i < bytes_.size() ? static_cast<unsigned char>(bytes_[i]) : 0U);
    return bits << at_ % 8;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;  // bit
};

// The decoded window, or what is wrong.
struct Decoded {
  Window window;
  const char* fault = nullptr;
};

// Of the differences.
struct DepthCode {
  int order = 0;
  std::int64_t most_steps = kMostSteps;
};

// Sets the cells of one run with data. What is wrong, or nullptr.
const char* take_run(BitReader& bits, std::size_t begin, std::size_t end, const DepthCode& code, std::int64_t& last,
                     Window& window) {
  for (std::size_t cell = begin; cell < end; ++cell) {
    const std::optional<std::uint64_t> difference = bits.take(code.order);
    if (!difference) return "its depths end early";
    last = window.promised(cell, last) + from_zigzag(*difference);
    if (last < 1 || last > code.most_steps) return "it has a depth that is not between 0 and a kilometre";
    window.steps[cell] = static_cast<std::int32_t>(last);
  }
  return nullptr;
}

// REQUIRES: window and depth step within their limits.
Decoded decode_depths(const GoldenScan& scan) {
  const auto cells = static_cast<std::size_t>(scan.rows) * static_cast<std::size_t>(scan.columns);
  if (scan.depths.empty()) return {{}, "its depths end early"};
  const DepthCode code{
      static_cast<unsigned char>(scan.depths.front()),
      static_cast<std::int64_t>(std::min(static_cast<double>(kMostSteps), kFarthest / scan.depth_step))};
  if (code.order > kHighestOrder) return {{}, "its depths are in an unknown code"};
  Decoded decoded{{scan.columns, std::vector<std::int32_t>(cells, 0)}};
  BitReader bits(std::string_view(scan.depths).substr(1));
  std::int64_t last = 0;
  for (std::size_t cell = 0; cell < cells;) {
    const std::optional<std::uint64_t> without = bits.take(kRunOrder);
    const std::optional<std::uint64_t> with = without ? bits.take(kRunOrder) : std::nullopt;
    if (!with) return {{}, "its depths end early"};
    // An empty run would be another way to write the same.
    if (*without > cells - cell || *with > cells - cell - *without || *without + *with == 0)
      return {{}, "its runs do not fill its window"};
    const std::size_t begin = cell + *without;
    cell = begin + *with;
    if (const char* fault = take_run(bits, begin, cell, code, last, decoded.window)) return {{}, fault};
  }
  if (!bits.at_end()) return {{}, "bytes follow after its depths"};
  if (last == 0) return {{}, "it has no data"};
  return decoded;
}

bool is_side(int first, int count, int all) { return first >= 0 && count >= 1 && first < all && count <= all - first; }

// The cells with data, tight.
void set_window(const RangeImage& image, GoldenScan& scan) {
  int lowest_row = image.rows, highest_row = -1, lowest_column = image.columns, highest_column = -1;
  for (int cell = 0; cell < image.size(); ++cell) {
    if (!image.valid(cell)) continue;
    lowest_row = std::min(lowest_row, cell / image.columns);
    highest_row = cell / image.columns;
    lowest_column = std::min(lowest_column, cell % image.columns);
    highest_column = std::max(highest_column, cell % image.columns);
  }
  assert(highest_row >= 0);
  scan.first_row = lowest_row;
  scan.first_column = lowest_column;
  scan.rows = highest_row - lowest_row + 1;
  scan.columns = highest_column - lowest_column + 1;
}

Window window_of(const RangeImage& image, const GoldenScan& scan) {
  Window window{scan.columns, {}};
  for (int row = 0; row < scan.rows; ++row) {
    for (int column = 0; column < scan.columns; ++column) {
      const int cell = image.cell(row + scan.first_row, column + scan.first_column);
      const auto depth = static_cast<double>(image[cell].z());
      window.steps.push_back(
          image.valid(cell) ? std::max(1, static_cast<std::int32_t>(std::lround(depth / scan.depth_step))) : 0);
    }
  }
  return window;
}

// A run of cells without data and one of cells with them.
struct Run {
  std::size_t without = 0;
  std::vector<std::uint64_t> differences;  // one for each cell with data
};

std::vector<Run> runs_of(const Window& window) {
  std::vector<Run> runs;
  std::int64_t last = 0;
  const std::vector<std::int32_t>& steps = window.steps;
  for (std::size_t cell = 0; cell < steps.size();) {
    Run& run = runs.emplace_back();
    for (; cell < steps.size() && steps[cell] == 0; ++cell) ++run.without;
    for (; cell < steps.size() && steps[cell] > 0; ++cell) {
      run.differences.push_back(zigzag(steps[cell] - window.promised(cell, last)));
      last = steps[cell];
    }
  }
  return runs;
}

// The one with the shortest code.
int best_order(const std::vector<Run>& runs) {
  std::array<std::size_t, kHighestOrder + 1> bits{};
  for (const Run& run : runs) {
    for (const std::uint64_t difference : run.differences) {
      for (int order = 0; order <= kHighestOrder; ++order)
        bits[static_cast<std::size_t>(order)] += static_cast<std::size_t>(code_length(difference, order));
    }
  }
  return static_cast<int>(std::min_element(bits.begin(), bits.end()) - bits.begin());
}

std::string encode_depths(const Window& window) {
  const std::vector<Run> runs = runs_of(window);
  const int order = best_order(runs);
  std::string bytes(1, static_cast<char>(order));
  BitWriter bits(bytes);
  for (const Run& run : runs) {
    bits.put(run.without, kRunOrder);
    bits.put(run.differences.size(), kRunOrder);
    for (const std::uint64_t difference : run.differences) bits.put(difference, order);
  }
  return bytes;
}

}  // namespace

double golden_depth_step(const SensorModel& sensor) {
  return std::max(
      {sensor.depth_quantization, kNoiseShare * sensor.depth_noise, kFinestShare * sensor.farthest_distance});
}

GoldenScan encode_golden_scan(const RangeImage& image, double depth_step, const Pose& T_sensor_model) {
  assert(depth_step > 0.0);
  GoldenScan scan;
  scan.depth_step = depth_step;
  scan.T_sensor_model = T_sensor_model;
  set_window(image, scan);
  scan.depths = encode_depths(window_of(image, scan));
  return scan;
}

const char* fault_of(const GoldenScan& scan, const PinholeCamera& camera) {
  if (!is_side(scan.first_row, scan.rows, camera.rows) || !is_side(scan.first_column, scan.columns, camera.columns))
    return "its window does not lie inside the image";
  if (!(scan.depth_step > 0.0 && scan.depth_step <= kFarthest))
    return "its depth step is not between 0 and a kilometre";
  return decode_depths(scan).fault;
}

RangeImage decode_golden_scan(const GoldenScan& scan, const PinholeCamera& camera) {
  const Decoded decoded = decode_depths(scan);
  assert(decoded.fault == nullptr);
  RangeImage image(camera.rows, camera.columns);
  std::size_t at = 0;
  for (int row = scan.first_row; row < scan.first_row + scan.rows; ++row) {
    for (int column = scan.first_column; column < scan.first_column + scan.columns; ++column) {
      const std::int32_t steps = decoded.window.steps[at++];
      if (steps == 0) continue;
      // As the simulator puts a depth on its ray: where the step is the sensor's own, the same bits come out.
      const double depth = steps * scan.depth_step;
      image[image.cell(row, column)] = (depth * camera.ray(row, column)).cast<float>();
    }
  }
  return image;
}

}  // namespace foresight
