#include "common/region_attributes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/region_boundary.h"

namespace foresight {
namespace {

// Two unit vectors that span the plane with the normal, right-handed: u x v = normal.
struct PlaneAxes {
  Eigen::Vector3d u, v;
};

PlaneAxes axes_of(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d helper = std::abs(normal.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d u = normal.cross(helper).normalized();
  return {u, normal.cross(u)};
}

// The rays of an image's cells: a camera's, by column and row.
struct CellRays {
  const PinholeCamera& camera;
  PoolVector<double> across, down;
  double longest = 1.0;  // of the rays, scaled so that z = 1

  explicit CellRays(const PinholeCamera& of) : camera(of) {
    for (int column = 0; column < of.columns; ++column) across.push_back(of.ray(0, column).x());
    for (int row = 0; row < of.rows; ++row) down.push_back(of.ray(row, 0).y());
    for (const double x : {across.front(), across.back()}) {
      for (const double y : {down.front(), down.back()}) longest = std::max(longest, Eigen::Vector3d(x, y, 1.0).norm());
    }
  }
};

// Andrew's monotone chain; counter-clockwise, no collinear points.
PoolVector<Eigen::Vector2d> convex_hull(PoolVector<Eigen::Vector2d> points) {
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  PoolVector<Eigen::Vector2d> hull;
  const auto turn = [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d a = hull[hull.size() - 1] - hull[hull.size() - 2];
    const Eigen::Vector2d b = p - hull[hull.size() - 1];
    return a.x() * b.y() - a.y() * b.x();
  };
  const auto add_chain = [&](auto first, auto last) {
    const std::size_t base = hull.size();
    for (auto it = first; it != last; ++it) {
      while (hull.size() >= base + 2 && turn(*it) <= 0.0) hull.pop_back();
      hull.push_back(*it);
    }
    hull.pop_back();
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

double diameter(const PoolVector<Eigen::Vector2d>& hull) {
  double largest = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    for (std::size_t j = i + 1; j < hull.size(); ++j) largest = std::max(largest, (hull[i] - hull[j]).squaredNorm());
  }
  return std::sqrt(largest);
}

// A region in the coordinates of its plane.
struct Patch {
  double area = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();       // first moments
  Eigen::Vector3d products = Eigen::Vector3d::Zero();  // second moments: of xx, xy, yy
  PoolVector<Eigen::Vector2d> outline;                 // points with the convex hull of all

  void add(const Eigen::Vector2d& p, double cell_area) {
    const Eigen::Vector2d weighted = cell_area * p;
    area += cell_area;
    sum += weighted;
    products += Eigen::Vector3d(weighted.x() * p.x(), weighted.y() * p.x(), weighted.y() * p.y());
  }
};

// Puts the cells of a region on its plane: each where its ray meets the plane, which is the data point without the
// noise along the ray.
class Projector {
 public:
  Projector(const Region& region, const RangeImage& image, const CellRays& rays, const PlaneAxes& axes)
      : region_(region), image_(image), rays_(rays), axes_(axes), origin_(region.offset * region.normal) {}

  Patch project() {
    Patch patch;
    const PoolVector<int>& cells = region_.cells;
    for (std::size_t first = 0, end = 0; first < cells.size(); first = end) {
      const int row = cells[first] / image_.columns;
      const int next_row = (row + 1) * image_.columns;
      while (end < cells.size() && cells[end] - cells[first] == static_cast<int>(end - first) && cells[end] < next_row)
        ++end;
      add_span(row, cells[first] - row * image_.columns, end - first, patch);
    }
    return patch;
  }

 private:
  // Rays that graze the plane (beyond 84 degrees: only scraps of a few cells have such planes) meet it nowhere
  // sensible.
  static constexpr double kSmallestCosine = 0.1;

  [[nodiscard]] double slope(double across, double down) const {
    return -region_.normal.dot(Eigen::Vector3d(across, down, 1.0));
  }
  // The area element of a plane over the grid.
  static double area(double depth, double at_slope, double fx, double fy) {
    return depth * depth / (at_slope * fx * fy);
  }

  // Cells one after the other in a row.
  void add_span(int row, int column, std::size_t count, Patch& patch) {
    const double* across = rays_.across.data() + column;
    const double down = rays_.down[static_cast<std::size_t>(row)];
    const double least_slope = kSmallestCosine * rays_.longest;
    // The slope goes up or down all the way.
    if (slope(across[0], down) < least_slope || slope(across[count - 1], down) < least_slope) {
      for (int i = 0; i < static_cast<int>(count); ++i) add_grazed(row, column + i, patch);
      return;
    }
    span_.resize(3 * count);
    place_span(across, down, count);
    const auto point = [&](std::size_t i) { return Eigen::Vector2d(span_[i], span_[count + i]); };
    for (std::size_t i = 0; i < count; ++i) patch.add(point(i), span_[2 * count + i]);
    // The rays lie in a plane and meet the region's in a line: the first and the last are all that the hull needs.
    patch.outline.push_back(point(0));
    if (count > 1) patch.outline.push_back(point(count - 1));
  }

  // Fills span_. A loop for vector instructions.
  void place_span(const double* across, double down, std::size_t count) {
    const Eigen::Vector3d n = region_.normal, u = axes_.u, v = axes_.v, origin = origin_;
    const double offset = region_.offset;
    const double fx = rays_.camera.fx, fy = rays_.camera.fy;
    double* along_u = span_.data();
    double* along_v = along_u + count;
    double* areas = along_v + count;
    for (std::size_t i = 0; i < count; ++i) {
      const double at_slope = -(n.x() * across[i] + n.y() * down + n.z());
      const double depth = -offset / at_slope;
      const double x = depth * across[i] - origin.x();
      const double y = depth * down - origin.y();
      const double z = depth - origin.z();
      along_u[i] = u.x() * x + u.y() * y + u.z() * z;
      along_v[i] = v.x() * x + v.y() * y + v.z() * z;
      areas[i] = area(depth, at_slope, fx, fy);
    }
  }

  // Where the ray does not meet the plane, the data point itself is put on it.
  void add_grazed(int row, int column, Patch& patch) const {
    const Eigen::Vector3d ray(rays_.across[static_cast<std::size_t>(column)], rays_.down[static_cast<std::size_t>(row)],
                              1.0);
    const double least_slope = kSmallestCosine * ray.norm();
    const double at_slope = slope(ray.x(), ray.y());
    Eigen::Vector3d point = image_[image_.cell(row, column)].cast<double>();
    if (at_slope >= least_slope) {
      point = (-region_.offset / at_slope) * ray;
    } else {
      point -= (region_.normal.dot(point) - region_.offset) * region_.normal;
    }
    point -= origin_;
    const Eigen::Vector2d p(axes_.u.dot(point), axes_.v.dot(point));
    patch.add(p, area(origin_.z() + point.z(), std::max(at_slope, least_slope), rays_.camera.fx, rays_.camera.fy));
    patch.outline.push_back(p);
  }

  const Region& region_;
  const RangeImage& image_;
  const CellRays& rays_;
  const PlaneAxes& axes_;
  Eigen::Vector3d origin_;
  PoolVector<double> span_;  // by cell: along u, along v, areas
};

DescribedRegion describe(Region region, const RangeImage& image, const CellRays& rays) {
  const PlaneAxes axes = axes_of(region.normal);
  Patch patch = Projector(region, image, rays, axes).project();
  const Eigen::Vector2d mean = patch.sum / patch.area;
  const Eigen::Vector3d second = patch.products / patch.area;
  Eigen::Matrix2d covariance;
  covariance << second.x(), second.y(), second.y(), second.z();
  covariance -= mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const PoolVector<Eigen::Vector2d> hull = convex_hull(std::move(patch.outline));
  const auto lift = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector3d(region.offset * region.normal + p.x() * axes.u + p.y() * axes.v);
  };

  DescribedRegion described;
  described.attributes = {patch.area, std::sqrt(std::max(0.0, solver.eigenvalues()[1])),
                          std::sqrt(std::max(0.0, solver.eigenvalues()[0])), diameter(hull)};
  described.centroid = lift(mean);
  described.major_axis = solver.eigenvectors()(0, 1) * axes.u + solver.eigenvectors()(1, 1) * axes.v;
  described.hull.reserve(hull.size());
  for (const Eigen::Vector2d& p : hull) described.hull.push_back(lift(p));
  described.region = std::move(region);
  return described;
}

}  // namespace

DescribedRegion describe(Region region, const RangeImage& image, const PinholeCamera& camera) {
  return describe(std::move(region), image, CellRays(camera));
}

PoolVector<DescribedRegion> extract_regions(const RangeImage& image, const PinholeCamera& camera,
                                            const SegmentationOptions& options, const Stop& stop) {
  PoolVector<Region> regions = segment(image, options, stop);
  const PoolVector<double> cut = cut_shares(regions, image, camera);
  const CellRays rays(camera);
  PoolVector<DescribedRegion> described;
  described.reserve(regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (stop && stop()) return {};
    described.push_back(describe(std::move(regions[r]), image, rays));
    described.back().cut_share = cut[r];
  }
  return described;
}

}  // namespace foresight
