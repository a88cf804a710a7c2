// Regions that are several faces in one plane, as of boxes that stand flush, are parted into faces.
//
// Beyond the paper, in which a region shows one face: where boxes touch and their tops are level to within the noise,
// no data tell one from the next. What tells is the outline of all together, and the sizes of the faces that the
// database knows: a region that no face is large enough for is laid out with rectangular faces, edge to edge.
#pragma once

#include <vector>

#include "common/camera.h"
#include "common/range_image.h"
#include "common/region_attributes.h"
#include "runtime/database.h"

namespace foresight {

struct FlushFaceOptions {
  int most_faces = 12;        // of one region. Limit: >= 2.
  double least_fill = 0.62;   // of a face's area that the region covers: the sensor rounds edges off. Limit: 0 to 1.
  double least_sides = 0.65;  // of a face's outline with data of the region just inside it. Limit: 0 to 1.
  // What faces leave over of a region and where they reach beyond it, as a share of it, for a region laid out whole.
  double largest_misfit = 0.17;
  // Of a face's outline that the region ends at, for faces in a region that is not laid out whole. Limit: 0 to 1.
  double least_outline = 0.55;
  // Of outlines beyond which something farther is seen: where the face may go on unseen, nothing tells its size.
  double least_seen_end = 0.25;
};

// Of all regions; those that are laid out are replaced by their parts, each with its own plane, and the rest. Regions
// keep their order (largest first). Deterministic.
[[nodiscard]] std::vector<DescribedRegion> part_flush_faces(std::vector<DescribedRegion> regions,
                                                            const RangeImage& image, const PinholeCamera& camera,
                                                            const Database& database,
                                                            const FlushFaceOptions& options = {});

}  // namespace foresight
