// Where a region ends and why: at an edge of its own face, or where something else hides the rest of it.
//
// Beyond the paper, which takes every region for a whole face as training saw it: in clutter that throws out the true
// face of each partly hidden region, because its area has no probability.
#pragma once

#include "common/camera.h"
#include "common/memory_pool.h"
#include "common/range_image.h"
#include "common/segmentation.h"

namespace foresight {

struct BoundaryOptions {
  double depth_step = 4.0;  // data nearer than a region's plane by more than this hide it. Unit: cell spacings.
};

// For each region the share of its boundary at which its face may go on unseen, 0 to 1. Looking from a boundary cell
// across the boundary, over cells without data or of no region, to the first cell of a region: that one lies before the
// region's plane (something hides it, or throws a shadow on it), on it (one face in two parts), or there is none
// because the image ends there. Elsewhere the face ends: what lies beyond is farther away, or another surface that
// meets it.
[[nodiscard]] PoolVector<double> cut_shares(const PoolVector<Region>& regions, const RangeImage& image,
                                            const PinholeCamera& camera, const BoundaryOptions& options = {});

}  // namespace foresight
