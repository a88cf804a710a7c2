#include "runtime/nearest_data_point.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace foresight {
namespace {

using Tree = flann::KDTreeSingleIndex<flann::L2_3D<float>>;

// Keeps the one nearest point and lives on the stack; FLANN's own result sets allocate for every query.
class Nearest final : public flann::ResultSet<float> {
 public:
  Nearest() = default;
  Nearest(float squared_distance, std::size_t index) : distance_(squared_distance), index_(index) {}
  [[nodiscard]] bool full() const override { return distance_ < std::numeric_limits<float>::max(); }
  void addPoint(float squared_distance, std::size_t index) override {
    if (!(squared_distance < distance_)) return;
    distance_ = squared_distance;
    index_ = index;
  }
  [[nodiscard]] float worstDist() const override { return distance_; }
  [[nodiscard]] std::size_t index() const { return index_; }
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

 private:
  float distance_ = std::numeric_limits<float>::max();
  std::size_t index_ = kNone;
};

}  // namespace

// The tree refers to `points` by address, so an Impl is never copied or moved.
struct NearestDataPoint::Impl {
  std::vector<Eigen::Vector3f> points;  // the valid cells, row by row
  std::vector<int> cells;               // the cell of each
  Tree tree;

  [[nodiscard]] Answer search(const Eigen::Vector3f& query, Nearest nearest) const {
    assert(query.allFinite());
    tree.findNeighbors(nearest, query.data(), flann::SearchParams());
    if (nearest.index() == Nearest::kNone) return {query, -1, std::sqrt(nearest.worstDist()), -1};
    const Eigen::Vector3f& point = points[nearest.index()];
    return {point, cells[nearest.index()], (query - point).norm(), static_cast<int>(nearest.index())};
  }
};

NearestDataPoint::NearestDataPoint(const RangeImage& image) : impl_(std::make_unique<Impl>()) {
  for (int cell = 0; cell < image.size(); ++cell) {
    if (!image.valid(cell)) continue;
    impl_->points.push_back(image[cell]);
    impl_->cells.push_back(cell);
  }
  assert(!impl_->points.empty());
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  impl_->tree.buildIndex(flann::Matrix<float>(impl_->points.front().data(), impl_->points.size(), 3));
}

NearestDataPoint::~NearestDataPoint() = default;
NearestDataPoint::NearestDataPoint(NearestDataPoint&&) noexcept = default;
NearestDataPoint& NearestDataPoint::operator=(NearestDataPoint&&) noexcept = default;

NearestDataPoint::Answer NearestDataPoint::find(const Eigen::Vector3f& query) const {
  return impl_->search(query, Nearest());
}

NearestDataPoint::Answer NearestDataPoint::find(const Eigen::Vector3f& query, int guess) const {
  const auto index = static_cast<std::size_t>(guess);
  return impl_->search(query, Nearest((query - impl_->points[index]).squaredNorm(), index));
}

NearestDataPoint::Answer NearestDataPoint::find_within(const Eigen::Vector3f& query, float reach, int guess) const {
  if (guess >= 0) {
    const auto index = static_cast<std::size_t>(guess);
    const float squared = (query - impl_->points[index]).squaredNorm();
    if (squared < reach * reach) return impl_->search(query, Nearest(squared, index));
  }
  return impl_->search(query, Nearest(reach * reach, Nearest::kNone));
}

}  // namespace foresight
