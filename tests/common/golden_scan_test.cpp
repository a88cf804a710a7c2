#include "common/golden_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "common/random.h"

namespace foresight {
namespace {

constexpr double kStep = 0.1;

PinholeCamera small_camera() { return {48, 64, 100.0, 110.0, 31.5, 23.5}; }

Pose some_pose() { return {rotation_from_vector({0.3, -0.2, 1.5}), {1.0, -2.0, 300.0}}; }

// Two slanted planes with holes, of which no cell of the outermost rows and columns is valid. noise: standard
// deviation.
RangeImage two_planes(double noise, double quantum = 0.0) {
  const PinholeCamera camera = small_camera();
  RangeImage image(camera.rows, camera.columns);
  Random random(3);
  for (int row = 5; row < 40; ++row) {
    for (int column = 7; column < 50; ++column) {
      const bool hole = (row * 7 + column * 3) % 31 == 0;
      const double plane = column < 30 ? 300.0 + 0.4 * row - 0.7 * column : 450.0 - 1.3 * row + 0.2 * column;
      double depth = plane + noise * random.gaussian();
      if (quantum > 0.0) depth = std::round(depth / quantum) * quantum;
      if (!hole) image[image.cell(row, column)] = (depth * camera.ray(row, column)).cast<float>();
    }
  }
  return image;
}

GoldenScan encoded(const RangeImage& image, double step = kStep) {
  return encode_golden_scan(image, step, some_pose());
}

const char* fault_here(const GoldenScan& scan) { return fault_of(scan, small_camera()); }

TEST(GoldenScan, returns_depths_within_half_a_step) {
  for (const double noise : {0.0, 0.05, 3.0, 60.0}) {
    const RangeImage image = two_planes(noise);
    const GoldenScan scan = encoded(image);
    ASSERT_EQ(fault_here(scan), nullptr);
    const RangeImage decoded = decode_golden_scan(scan, small_camera());
    ASSERT_EQ(decoded.rows, image.rows);
    ASSERT_EQ(decoded.columns, image.columns);
    for (int cell = 0; cell < image.size(); ++cell) {
      ASSERT_EQ(decoded.valid(cell), image.valid(cell)) << cell;
      if (!image.valid(cell)) continue;
      EXPECT_NEAR(decoded[cell].z(), image[cell].z(), 0.5 * kStep + 1e-4) << cell;
    }
  }
}

TEST(GoldenScan, returns_depths_on_its_steps_bit_for_bit) {
  const RangeImage image = two_planes(0.3, kStep);
  const RangeImage decoded = decode_golden_scan(encoded(image), small_camera());
  for (int cell = 0; cell < image.size(); ++cell) {
    if (!image.valid(cell)) continue;
    EXPECT_EQ(decoded[cell], image[cell]) << cell;
  }
}

TEST(GoldenScan, of_a_decoded_one_is_the_same) {
  const GoldenScan scan = encoded(two_planes(1.0));
  const GoldenScan again = encoded(decode_golden_scan(scan, small_camera()));
  EXPECT_EQ(again.depths, scan.depths);
  EXPECT_EQ(again.first_row, scan.first_row);
  EXPECT_EQ(again.columns, scan.columns);
}

TEST(GoldenScan, holds_no_more_than_the_window_with_data) {
  const GoldenScan scan = encoded(two_planes(0.0));
  EXPECT_EQ(scan.first_row, 5);
  EXPECT_EQ(scan.first_column, 7);
  EXPECT_EQ(scan.rows, 35);
  EXPECT_EQ(scan.columns, 43);
  RangeImage one(small_camera().rows, small_camera().columns);
  one[one.cell(47, 63)] = {1.0F, 1.0F, 100.0F};
  EXPECT_EQ(encoded(one).rows * encoded(one).columns, 1);
  EXPECT_EQ(fault_here(encoded(one)), nullptr);
}

TEST(GoldenScan, takes_few_bits_for_a_cell_of_a_plane) {
  for (const auto& [noise, bits] : {std::pair(0.0, 3.0), std::pair(0.4, 7.0)}) {  // four steps
    const RangeImage image = two_planes(noise);
    EXPECT_LT(8.0 * static_cast<double>(encoded(image).depths.size()), bits * count_valid(image)) << noise;
  }
}

TEST(GoldenScan, of_every_part_of_the_bytes_is_refused) {
  GoldenScan scan = encoded(two_planes(0.3));
  const std::string whole = scan.depths;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    scan.depths = whole.substr(0, size);
    EXPECT_STREQ(fault_here(scan), "its depths end early") << size;
  }
  scan.depths = whole + '\0';
  EXPECT_STREQ(fault_here(scan), "bytes follow after its depths");
}

TEST(GoldenScan, with_random_damage_is_refused_or_usable) {
  const GoldenScan good = encoded(two_planes(0.3));
  Random random(17);
  int refused = 0;
  for (int i = 0; i < 500; ++i) {
    GoldenScan scan = good;
    for (int k = 0; k < 4; ++k) {
      const std::size_t at = static_cast<std::size_t>(random.next() % scan.depths.size());
      scan.depths[at] = static_cast<char>(random.next() & 0xFF);
    }
    if (fault_here(scan) != nullptr) {
      ++refused;
      continue;
    }
    const RangeImage image = decode_golden_scan(scan, small_camera());
    for (int cell = 0; cell < image.size(); ++cell) {
      if (!image.valid(cell)) continue;
      EXPECT_TRUE(image[cell].allFinite() && image[cell].z() > 0.0F && image[cell].z() <= 1e6F);
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(GoldenScan, refuses_bytes_that_are_no_scan) {
  const auto fault_of_bytes = [](const std::string& bytes) {
    GoldenScan scan;
    scan.rows = 2;
    scan.columns = 2;
    scan.depth_step = 1.0;
    scan.depths = bytes;
    const char* fault = fault_of(scan, small_camera());
    return std::string(fault == nullptr ? "" : fault);
  };
  // Bits to bytes; of order 5 for counts, 100000 is 0 and 100100 is 4. The first byte: the order of differences.
  const auto coded = [](const std::string& bits, int order = 0) {
    std::string bytes(1, static_cast<char>(order));
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (i % 8 == 0) bytes += '\0';
      if (bits[i] == '1') bytes.back() = static_cast<char>(bytes.back() | 0x80 >> i % 8);
    }
    return bytes;
  };
  const std::string none = "100000", four = "100100", five = "100101";
  const std::string ten = "000010101", same = "1", lower = "010";  // 20, 0 and 1 in zigzag
  EXPECT_EQ(fault_of_bytes(coded(none + four + ten + lower + same + same)), "");
  EXPECT_EQ(fault_of_bytes(coded(four + none)), "it has no data");
  EXPECT_EQ(fault_of_bytes(coded(five + none)), "its runs do not fill its window");
  EXPECT_EQ(fault_of_bytes(coded(none + five)), "its runs do not fill its window");
  EXPECT_EQ(fault_of_bytes(coded(none + none)), "its runs do not fill its window");
  const std::string huge = std::string(33, '0') + std::string(40, '1');
  EXPECT_EQ(fault_of_bytes(coded(huge + none)), "its runs do not fill its window");
  EXPECT_EQ(fault_of_bytes(coded(none + huge)), "its runs do not fill its window");
  EXPECT_EQ(fault_of_bytes(coded(none + four + ten + std::string(90, '0'))), "its depths end early");
  EXPECT_EQ(fault_of_bytes(coded(none + four + ten + same)), "its depths end early");
  EXPECT_EQ(fault_of_bytes(coded(none + four + ten + lower + same + same) + '\0'), "bytes follow after its depths");
  EXPECT_EQ(fault_of_bytes(coded(none + four + ten + lower + same + same + "1")), "bytes follow after its depths");
  EXPECT_EQ(fault_of_bytes(coded(four, 16)), "its depths are in an unknown code");
  for (const std::string& depth : {same, lower, huge})  // 0, -1, and far beyond
    EXPECT_EQ(fault_of_bytes(coded(none + four + depth)), "it has a depth that is not between 0 and a kilometre");
}

TEST(GoldenScan, refuses_windows_and_steps_outside_their_limits) {
  const auto expect_fault = [](const std::string& words, const auto& change) {
    GoldenScan scan = encoded(two_planes(0.0));
    change(scan);
    const char* fault = fault_here(scan);
    ASSERT_NE(fault, nullptr) << words;
    EXPECT_EQ(std::string(fault), words);
  };
  const std::string window = "its window does not lie inside the image";
  for (const int wrong : {-1, 48, 100000, -2147483647}) {
    expect_fault(window, [&](GoldenScan& scan) { scan.first_row = wrong; });
    expect_fault(window, [&](GoldenScan& scan) { scan.rows = wrong; });
  }
  for (const int wrong : {-1, 64, 2147483647}) {
    expect_fault(window, [&](GoldenScan& scan) { scan.first_column = wrong; });
    expect_fault(window, [&](GoldenScan& scan) { scan.columns = wrong; });
  }
  expect_fault(window, [](GoldenScan& scan) { scan.rows = 0; });
  expect_fault(window, [](GoldenScan& scan) { scan.columns = 0; });
  for (const double wrong : {0.0, -0.1, 1e7, std::nan(""), static_cast<double>(INFINITY)})
    expect_fault("its depth step is not between 0 and a kilometre", [&](GoldenScan& scan) { scan.depth_step = wrong; });
  expect_fault("it has a depth that is not between 0 and a kilometre", [](GoldenScan& scan) { scan.depth_step = 5e5; });
}

TEST(GoldenDepthStep, is_the_sensors_own_unless_that_is_needlessly_fine) {
  SensorModel sensor;
  sensor.nearest_distance = sensor.farthest_distance = 1024.0;
  sensor.depth_quantization = 0.1;
  EXPECT_EQ(golden_depth_step(sensor), 0.1);
  sensor.depth_noise = 2.0;
  EXPECT_EQ(golden_depth_step(sensor), 0.5);
  sensor.depth_noise = sensor.depth_quantization = 0.0;
  EXPECT_EQ(golden_depth_step(sensor), 1.0 / 64.0);
}

}  // namespace
}  // namespace foresight
