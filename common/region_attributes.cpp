#include "common/region_attributes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

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

// A cell's patch of the region's plane.
struct Footprint {
  Eigen::Vector3d point;
  double area;  // Unit: mm^2.
};

// Where the ray of a cell meets the plane: the data point without the noise along its ray. Rays that graze the plane (beyond
// 84 degrees: only scraps of a few cells have such planes) meet it nowhere sensible; there the data point itself is taken.
Footprint footprint(const Region& region, const RangeImage& image, const PinholeCamera& camera, int cell) {
  constexpr double kSmallestCosine = 0.1;
  const Eigen::Vector3d ray = camera.ray(cell / camera.columns, cell % camera.columns);
  const double slope = -region.normal.dot(ray);
  const double least_slope = kSmallestCosine * ray.norm();
  Eigen::Vector3d point = image[cell].cast<double>();
  if (slope >= least_slope) {
    point = (-region.offset / slope) * ray;
  } else {
    point -= (region.normal.dot(point) - region.offset) * region.normal;
  }
  // The area element of a plane over the grid is depth^2 / (slope fx fy).
  return {point, point.z() * point.z() / (std::max(slope, least_slope) * camera.fx * camera.fy)};
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

// First and second moments of the patch in its plane.
struct PatchMoments {
  double area = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d outer = Eigen::Matrix2d::Zero();
};

}  // namespace

DescribedRegion describe(Region region, const RangeImage& image, const PinholeCamera& camera) {
  const PlaneAxes axes = axes_of(region.normal);
  const Eigen::Vector3d origin = region.offset * region.normal;
  PatchMoments moments;
  std::vector<Eigen::Vector2d> points;
  points.reserve(region.cells.size());
  for (const int cell : region.cells) {
    const Footprint foot = footprint(region, image, camera, cell);
    const Eigen::Vector2d p(axes.u.dot(foot.point - origin), axes.v.dot(foot.point - origin));
    moments.area += foot.area;
    moments.sum += foot.area * p;
    moments.outer += foot.area * p * p.transpose();
    points.push_back(p);
  }
  const Eigen::Vector2d mean = moments.sum / moments.area;
  const Eigen::Matrix2d covariance = moments.outer / moments.area - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(points));
  const auto lift = [&](const Eigen::Vector2d& p) { return Eigen::Vector3d(origin + p.x() * axes.u + p.y() * axes.v); };

  DescribedRegion described;
  described.attributes = {moments.area, std::sqrt(std::max(0.0, solver.eigenvalues()[1])),
                          std::sqrt(std::max(0.0, solver.eigenvalues()[0])), diameter(hull)};
  described.centroid = lift(mean);
  described.major_axis = solver.eigenvectors()(0, 1) * axes.u + solver.eigenvectors()(1, 1) * axes.v;
  for (const Eigen::Vector2d& p : hull) described.hull.push_back(lift(p));
  described.region = std::move(region);
  return described;
}

std::vector<DescribedRegion> extract_regions(const RangeImage& image, const PinholeCamera& camera,
                                             const SegmentationOptions& options) {
  std::vector<Region> regions = segment(image, options);
  const std::vector<double> cut = cut_shares(regions, image, camera);
  std::vector<DescribedRegion> described;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    described.push_back(describe(std::move(regions[r]), image, camera));
    described.back().cut_share = cut[r];
  }
  return described;
}

}  // namespace foresight
