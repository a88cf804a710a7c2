// The 3DTM surface template: sample points on the CAD surface and the 80 aspects (Section V.A).
#pragma once

#include "common/compiled_model.h"
#include "compiler/cad_model.h"

namespace foresight {

struct SurfaceTemplateOptions {
  double spacing = 5.0;              // no two points are nearer. The paper states none; 5 mm worked. Unit: mm. Limit: > 0.
  double neighbour_radius = 10.0;    // N_i: points of the template within this distance. Unit: mm. Limit: > spacing.
  double edge_tolerance = 0.1;       // a point this near to a face belongs to it too. Unit: mm. Limit: > 0.
  double visible_share = 0.5;        // a face is visible in an aspect when this share of its points is; see below. Limit: (0, 1].
  double distance = 900.0;           // of the eye from the model centre. Unit: mm.
};

// Points on an edge belong to all its faces. A face that is nowhere `spacing` away from points laid before it (a narrow
// facet, the second side of a thinner sheet) stays without points, and so in no aspect.
// A face is visible in an aspect when the share of its points that can be seen, averaged over the middle of the cell and of
// its four parts, reaches visible_share. The paper states no threshold: with a third, face parts hidden by the object itself cost the stapler
// 6 points of its matched fraction at true poses (80 clean scans).
[[nodiscard]] SurfaceTemplate build_surface_template(const CadModel& model, const SurfaceTemplateOptions& options);

}  // namespace foresight
