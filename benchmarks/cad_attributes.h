// What the attributes of a region would be if it were the CAD face itself, all of it: what systems without a sensor
// model constrain matches with (Section III, Fig. 2).
#pragma once

#include "common/region_attributes.h"
#include "common/relation_attributes.h"
#include "compiler/cad_model.h"

namespace foresight {

// Area, second moments and diameter as describe() defines them. REQUIRES: 0 <= face < model.faces.size().
[[nodiscard]] AttributeVector cad_attributes(const CadModel& model, int face);

// Angle and largest distance as relate() defines them. REQUIRES: as above for both.
[[nodiscard]] RelationVector cad_relations(const CadModel& model, int a, int b);

// Standard deviation of what an extractor measures of a wholly visible face: its border lies within a cell, one
// standard deviation being half a cell everywhere at once, so that an extent changes by a cell, the area by half a cell
// times the perimeter, and a second moment as that of a rectangle (side / sqrt(12)) does. cell:
// SensorModel::cell_size(). Unit: mm. Limit: > 0.
[[nodiscard]] AttributeVector cad_attribute_sigmas(const CadModel& model, int face, double cell);

// The same for two faces: the angle as the two fitted planes tilt by the depth noise (sigma / (smaller second moment x
// root of the number of cells) each), the distance by a cell.
[[nodiscard]] RelationVector cad_relation_sigmas(const CadModel& model, int a, int b, double cell, double depth_sigma);

}  // namespace foresight
