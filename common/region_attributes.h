// First-order attributes of a region, over the 3D surface patch it covers (Section III).
#pragma once

#include <Eigen/Core>
#include <array>

#include "common/camera.h"
#include "common/memory_pool.h"
#include "common/range_image.h"
#include "common/segmentation.h"

namespace foresight {

enum Attribute : int { kArea = 0, kMaxSecondMoment = 1, kMinSecondMoment = 2, kMaxDiameter = 3 };
inline constexpr int kAttributeCount = 4;
inline constexpr std::array<const char*, kAttributeCount> kAttributeNames = {"area", "max_second_moment",
                                                                             "min_second_moment", "max_diameter"};
using AttributeVector = std::array<double, kAttributeCount>;  // mm^2, mm, mm, mm

// A region with what matching and pose estimation need to know about it.
struct DescribedRegion {
  Region region;
  AttributeVector attributes{};
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();    // area-weighted, on the plane. Unit: mm.
  Eigen::Vector3d major_axis = Eigen::Vector3d::Zero();  // unit, direction of the larger second moment
  double cut_share = 0.0;  // of its boundary at which its face may go on unseen (region_boundary.h)
  PoolVector<Eigen::Vector3d>
      hull;  // convex hull of the patch on its plane, counter-clockwise seen along -normal. Unit: mm.
};

// Area: sum of the cells' footprints on the fitted plane. Second moments: square roots of the eigenvalues of the
// patch's covariance in its plane. Max diameter: of the convex hull. Camera: of the image (gives each cell its
// footprint).
[[nodiscard]] DescribedRegion describe(Region region, const RangeImage& image, const PinholeCamera& camera);

// segment() and describe() together: what both programs call. Stopped: no regions.
[[nodiscard]] PoolVector<DescribedRegion> extract_regions(const RangeImage& image, const PinholeCamera& camera,
                                                          const SegmentationOptions& options, const Stop& stop = {});

}  // namespace foresight
