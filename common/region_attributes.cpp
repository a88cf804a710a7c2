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
  std::vector<double> across, down;
  double longest = 1.0;  // of the rays, scaled so that z = 1

  explicit CellRays(const PinholeCamera& of) : camera(of) {
    for (int column = 0; column < of.columns; ++column) across.push_back(of.ray(0, column).x());
    for (int row = 0; row < of.rows; ++row) down.push_back(of.ray(row, 0).y());
    for (const double x : {across.front(), across.back()}) {
      for (const double y : {down.front(), down.back()}) longest = std::max(longest, Eigen::Vector3d(x, y, 1.0).norm());
    }
  }
};

// A cell's patch of the region's plane.
struct Footprint {
  Eigen::Vector3d point;
  double area;            // Unit: mm^2.
  bool is_on_ray = true;  // whether the point lies where the cell's ray meets the plane
};

// Where the ray of a cell meets the plane: the data point without the noise along its ray. Rays that graze the plane
// (beyond 84 degrees: only scraps of a few cells have such planes) meet it nowhere sensible; there the data point
// itself is taken.
Footprint footprint(const Region& region, const RangeImage& image, const CellRays& rays, int row, int column) {
  constexpr double kSmallestCosine = 0.1;
  const Eigen::Vector3d ray(rays.across[static_cast<std::size_t>(column)], rays.down[static_cast<std::size_t>(row)],
                            1.0);
  const double slope = -region.normal.dot(ray);
  // The area element of a plane over the grid is depth^2 / (slope fx fy).
  const auto area = [&](double depth, double at_slope) {
    return depth * depth / (at_slope * rays.camera.fx * rays.camera.fy);
  };
  if (slope >= kSmallestCosine * rays.longest || slope >= kSmallestCosine * ray.norm()) {
    const Eigen::Vector3d point = (-region.offset / slope) * ray;
    return {point, area(point.z(), slope)};
  }
  Eigen::Vector3d point = image[image.cell(row, column)].cast<double>();
  point -= (region.normal.dot(point) - region.offset) * region.normal;
  return {point, area(point.z(), kSmallestCosine * ray.norm()), false};
}

// Andrew's monotone chain; counter-clockwise, no collinear points.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull;
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

double diameter(const std::vector<Eigen::Vector2d>& hull) {
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
  std::vector<Eigen::Vector2d> outline;                // points with the convex hull of all
};

// The rays of a row of cells lie in a plane and meet the region's in a line, so the first and the last are all that the
// hull needs of them.
Patch project(const Region& region, const RangeImage& image, const CellRays& rays, const PlaneAxes& axes) {
  const Eigen::Vector3d origin = region.offset * region.normal;
  Patch patch;
  std::vector<Eigen::Vector2d> on_row;
  const std::vector<int>& cells = region.cells;
  for (std::size_t i = 0; i < cells.size();) {
    const int row = cells[i] / image.columns;
    const int first = row * image.columns;
    bool on_line = true;
    on_row.clear();
    for (; i < cells.size() && cells[i] - first < image.columns; ++i) {
      const Footprint foot = footprint(region, image, rays, row, cells[i] - first);
      const Eigen::Vector3d from_origin = foot.point - origin;
      const Eigen::Vector2d p(axes.u.dot(from_origin), axes.v.dot(from_origin));
      const Eigen::Vector2d weighted = foot.area * p;
      patch.area += foot.area;
      patch.sum += weighted;
      patch.products += Eigen::Vector3d(weighted.x() * p.x(), weighted.y() * p.x(), weighted.y() * p.y());
      on_line = on_line && foot.is_on_ray;
      on_row.push_back(p);
    }
    if (on_line) on_row = {on_row.front(), on_row.back()};
    patch.outline.insert(patch.outline.end(), on_row.begin(), on_row.end());
  }
  return patch;
}

DescribedRegion describe(Region region, const RangeImage& image, const CellRays& rays) {
  const PlaneAxes axes = axes_of(region.normal);
  Patch patch = project(region, image, rays, axes);
  const Eigen::Vector2d mean = patch.sum / patch.area;
  const Eigen::Vector3d second = patch.products / patch.area;
  Eigen::Matrix2d covariance;
  covariance << second.x(), second.y(), second.y(), second.z();
  covariance -= mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(patch.outline));
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

std::vector<DescribedRegion> extract_regions(const RangeImage& image, const PinholeCamera& camera,
                                             const SegmentationOptions& options) {
  std::vector<Region> regions = segment(image, options);
  const std::vector<double> cut = cut_shares(regions, image, camera);
  const CellRays rays(camera);
  std::vector<DescribedRegion> described;
  described.reserve(regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    described.push_back(describe(std::move(regions[r]), image, rays));
    described.back().cut_share = cut[r];
  }
  return described;
}

}  // namespace foresight
