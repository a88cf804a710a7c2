#include "common/region_boundary.h"

#include <numeric>

#include "common/cell_blocks.h"

namespace foresight {
namespace {

// Finds the boundaries of all regions on one way through the image, and what lies across them.
class BoundaryReader {
 public:
  BoundaryReader(const PoolVector<Region>& regions, const RangeImage& image, const PinholeCamera& camera,
                 const BoundaryOptions& options)
      : regions_(regions),
        image_(image),
        camera_(camera),
        options_(options),
        labels_(label_image(regions, image.size())),
        boundaries_(regions.size() + 1) {}

  [[nodiscard]] PoolVector<double> cut_shares() {
    PoolVector<int> above(static_cast<std::size_t>(image_.columns), -1);  // by column: the last cell of a region
    for (int row = 0; row < image_.rows; ++row) read_row(row, above);
    for (const int last : above) {
      if (last >= 0) look(last, -1, last + image_.columns < image_.size());
    }
    PoolVector<double> shares;
    for (std::size_t label = 1; label < boundaries_.size(); ++label) shares.push_back(boundaries_[label].cut_share());
    return shares;
  }

 private:
  struct Boundary {
    int steps = 0;  // from a cell of the region to one beside, above or below it that is not
    int cut = 0;

    [[nodiscard]] double cut_share() const { return steps > 0 ? static_cast<double>(cut) / steps : 0.0; }
  };

  [[nodiscard]] int label(int cell) const { return labels_[static_cast<std::size_t>(cell)]; }

  void read_row(int row, PoolVector<int>& above) {
    const int first = image_.cell(row, 0);
    const int end = first + image_.columns;
    int before = -1;
    const auto pass_block = [&](int block) {
      const int* own = labels_.data() + block;
      if (!all_are(*own, own)) return false;
      if (*own == 0) return true;
      if (row == 0 || before + 1 != block || own[-1] != *own || !all_are(*own, own - image_.columns)) return false;
      std::iota(&above[static_cast<std::size_t>(block - first)],
                &above[static_cast<std::size_t>(block - first)] + kBlock, block);
      before = block + kBlock - 1;
      return true;
    };
    visit_cells(first, end, pass_block, [&](int cell) {
      if (label(cell) == 0) return;
      int& over = above[static_cast<std::size_t>(cell - first)];
      meet(before, cell, before >= 0 ? before + 1 < cell : cell > first);
      meet(over, cell, over >= 0 ? over + image_.columns < cell : row > 0);
      before = over = cell;
    });
    if (before >= 0) look(before, -1, before + 1 < end);
  }

  // A cell and the one of a region before it on its row or column; -1: there is none. gap: cells of no region lie
  // between, or before the border of the image.
  void meet(int before, int cell, bool gap) {
    if (before >= 0 && !gap && label(before) == label(cell)) return;
    if (before >= 0) look(before, cell, gap);
    look(cell, before, gap);
  }

  // From a cell across the boundary of its region to the next cell of a region; -1: to the border of the image.
  void look(int cell, int beyond, bool gap) {
    Boundary& boundary = boundaries_[static_cast<std::size_t>(label(cell))];
    const bool cut = beyond < 0 ? !gap : goes_on_unseen(cell, beyond, gap);
    ++boundary.steps;
    boundary.cut += cut ? 1 : 0;
  }

  [[nodiscard]] bool goes_on_unseen(int cell, int beyond, bool gap) const {
    // The same region again: a hole in it. What hides a hole has no region, and hides little.
    if (label(beyond) == label(cell)) return false;
    const Region& region = regions_[static_cast<std::size_t>(label(cell) - 1)];
    const double facing = -region.normal.dot(camera_.ray(beyond / image_.columns, beyond % image_.columns));
    if (!(facing > 0.0)) return false;  // the region's plane is not in sight there
    const double plane_depth = -region.offset / facing;
    const double depth = image_[beyond].z();
    const double tolerance = options_.depth_step * depth / camera_.fx;
    if (depth < plane_depth - tolerance) return true;
    return gap && depth < plane_depth + tolerance;
  }

  const PoolVector<Region>& regions_;
  const RangeImage& image_;
  const PinholeCamera& camera_;
  const BoundaryOptions& options_;
  PoolVector<int> labels_;
  PoolVector<Boundary> boundaries_;  // by label
};

}  // namespace

PoolVector<double> cut_shares(const PoolVector<Region>& regions, const RangeImage& image, const PinholeCamera& camera,
                              const BoundaryOptions& options) {
  return BoundaryReader(regions, image, camera, options).cut_shares();
}

}  // namespace foresight
