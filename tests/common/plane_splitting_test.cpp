#include "common/plane_splitting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "common/plane_contacts.h"
#include "tests/images.h"

namespace foresight {
namespace {

using test::facing;
using test::render;

PinholeCamera small_camera() { return {48, 64, 770.0, 770.0, 31.5, 23.5}; }

const SegmentationOptions& quiet() {
  static const SegmentationOptions options = segmentation_options_for(SensorModel());
  return options;
}

// A plane with holes and single cells without data, on which patches of labels lie.
struct Case {
  RangeImage image;
  PlaneLabels found;

  explicit Case(std::uint64_t seed)
      : image(render({facing({0, 0, 900}, 400, 400)}, small_camera())), found(image.size()) {
    Random random(seed);
    for (int i = 0; i < 200; ++i)
      image[random.integer(0, image.size() - 1)].setConstant(std::numeric_limits<float>::quiet_NaN());
    for (int i = 0; i < 8; ++i) {
      const int height = random.integer(2, 20), width = random.integer(2, 40), label = random.integer(0, 3);
      const int row = random.integer(0, image.rows - height), column = random.integer(0, image.columns - width);
      for (int r = row; r < row + height; ++r) {
        for (int c = column; c < column + width; ++c)
          label_of(image.cell(r, c)) = image.valid(image.cell(r, c)) ? label : 0;
      }
    }
    found.sums.resize(3);
    found.planes.resize(3);
    for (int cell = 0; cell < image.size(); ++cell) {
      if (label_of(cell) != 0) found.sums[static_cast<std::size_t>(label_of(cell) - 1)].add(image[cell].cast<double>());
    }
  }
  int& label_of(int cell) { return found.labels[static_cast<std::size_t>(cell)]; }
};

// The piece around a cell by flooding it.
std::set<int> piece_around(int cell, const PoolVector<int>& labels, const CellConnectivity& connectivity) {
  std::set<int> piece = {cell};
  std::vector<int> open = {cell};
  while (!open.empty()) {
    const int at = open.back();
    open.pop_back();
    connectivity.for_each_neighbour(at, [&](int next) {
      if (labels[static_cast<std::size_t>(next)] == labels[static_cast<std::size_t>(cell)] && piece.insert(next).second)
        open.push_back(next);
    });
  }
  return piece;
}

TEST(SplitPlanes, makes_a_plane_of_each_large_piece_in_the_order_of_first_cells) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Case made(seed);
    const CellConnectivity connectivity(made.image, quiet());
    const PoolVector<int> before = made.found.labels;
    split_planes(made.image, connectivity, quiet(), made.found);
    PoolVector<int> expected(before.size(), 0);
    std::set<int> seen;
    int planes = 0;
    for (int cell = 0; cell < made.image.size(); ++cell) {
      if (before[static_cast<std::size_t>(cell)] == 0 || seen.count(cell) > 0) continue;
      const std::set<int> piece = piece_around(cell, before, connectivity);
      seen.insert(piece.begin(), piece.end());
      PointSums sums;
      for (const int each : piece) sums.add(made.image[each].cast<double>());
      if (static_cast<int>(piece.size()) < quiet().smallest_region || !is_steady(sums, sums.fit(), quiet())) continue;
      ++planes;
      for (const int each : piece) expected[static_cast<std::size_t>(each)] = planes;
      ASSERT_LE(planes, static_cast<int>(made.found.sums.size()));
      EXPECT_EQ(made.found.sums[static_cast<std::size_t>(planes - 1)].count(), static_cast<double>(piece.size()));
    }
    EXPECT_EQ(made.found.labels, expected) << seed;
    EXPECT_EQ(static_cast<int>(made.found.planes.size()), planes);
  }
}

TEST(ContactsOf, are_all_connected_cells_of_different_planes) {
  bool found_any = false;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Case made(seed);
    const CellConnectivity connectivity(made.image, quiet());
    std::vector<std::pair<int, int>> expected;
    for (int cell = 0; cell < made.image.size(); ++cell) {
      for (const int next : {connectivity.right(cell), connectivity.down(cell)}) {
        if (next < 0 || made.label_of(cell) == 0 || made.label_of(next) == 0) continue;
        if (made.label_of(cell) != made.label_of(next)) expected.emplace_back(cell, next);
      }
    }
    std::vector<std::pair<int, int>> contacts;
    for (const Contact& contact : contacts_of(connectivity, made.found.labels))
      contacts.emplace_back(contact.cell, contact.next);
    EXPECT_EQ(contacts, expected) << seed;
    found_any = found_any || !contacts.empty();
  }
  EXPECT_TRUE(found_any);
}

}  // namespace
}  // namespace foresight
