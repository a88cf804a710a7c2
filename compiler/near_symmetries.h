// Motions under which an object looks almost the same to its sensor: poses that a search takes for one another.
//
// A box that is nearly square looks almost the same a quarter turn on; a part whose only mark is a small chamfer looks
// almost the same the other way round. Whoever finds one such pose should look at the others, too.
#pragma once

#include <vector>

#include "common/compiled_model.h"
#include "common/sensor_model.h"
#include "compiler/cad_model.h"

namespace foresight {

struct NearSymmetryOptions {
  // Surface this near lies on the surface: what verification takes for one. Unit: mm. Limit: > 0.
  double distance = 4.0;
  double normal_cosine = 0.87;  // of the two normals there; 30 degrees, as in verification
  // Share of the surface that comes to lie on the surface. At 0.6 long plates lie crosswise on themselves, in dozens of
  // ways; at 0.7 the castle has no pose upside down (0.68). Limit: (0, 1].
  double least_overlap = 0.65;
  double separation = 10.0;  // motions that take no point of the object farther apart are one. Unit: mm. Limit: > 0.
  int most = kMostNearSymmetries;
};

// What the sensor and the object's size ask for: verification's 4 mm, or 3 standard deviations of the depth where that
// is more, but at most 5 % of the diameter; motions 10 % of the diameter apart (localization closes less by itself).
[[nodiscard]] NearSymmetryOptions near_symmetry_options(const SensorModel& sensor, double diameter);

// The motions with at least the least overlap of which none near them (a step of the distance, or the turn that comes
// to as much) has clearly more, most overlap first, one of those that differ by a symmetry of `group` alone (which
// begins with the identity); none of the group. overlap is the share of points spread over the surface that come to lie
// within the distance of the surface, with the normal that it has there.
//
// Found among the alignments of the large faces (compiler/face_alignments.h), of which the 64 best that are apart are
// followed to where they lie closest: of a surface of many small faces (a cylinder of hundreds of facets), whose turns
// are more than that, some are found.
[[nodiscard]] std::vector<Symmetry> find_near_symmetries(const CadModel& model, const std::vector<Pose>& group,
                                                         const NearSymmetryOptions& options);

// All symmetries of a compiled model: the exact ones without the identity (overlap 1), then the near ones.
[[nodiscard]] std::vector<Symmetry> list_symmetries(const CadModel& model, const SensorModel& sensor);

}  // namespace foresight
