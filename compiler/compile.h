// The compiler's order of stages: CAD -> views -> regions -> samples -> statistics, and the surface template and the
// symmetries beside them; then what the runtime learns of right and wrong poses, and a scan in which it recognizes the
// object.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/compiled_model.h"
#include "compiler/acceptance_training.h"
#include "compiler/cad_model.h"
#include "compiler/face_samples.h"
#include "compiler/surface_template.h"

namespace foresight {

struct CompileOptions {
  FaceSampleOptions samples;
  DensityOptions density;
  // Statistics are kept of so many faces, those found in most views. Recognition matches every region with every face and
  // every pair of regions with every pair of faces: of a curved surface cut into hundreds of facets that alone would fill
  // the memory. Limit: > 0.
  std::size_t most_faces = 100;
  AcceptanceTrainingOptions acceptance;
  SurfaceTemplateOptions surface;    // its distance is overridden by the sensor's working distance
};

// Statistics, template, symmetries, acceptance and golden scan of one model; nothing beyond its geometry where no face is
// found in any view. progress(done) counts views; may be called from any thread. finished(stage) is called after each
// stage, in the order they are listed here: "views", "statistics", "template", "symmetries", "acceptance", "golden scan".
[[nodiscard]] CompiledModel compile_model(const CadModel& cad, const SensorModel& sensor, const CompileOptions& options,
                                          const std::function<void(int)>& progress = {},
                                          const std::function<void(const char*)>& finished = {});

// An empty database for a sensor: provenance, extraction and density settings in place.
[[nodiscard]] CompiledDatabase new_database(const SensorModel& sensor, const CompileOptions& options);

// Joins databases compiled apart, models in the order given. Throws DatabaseError{incompatible} naming the file when
// sensors or settings differ, or when two models have one name.
struct NamedDatabase { std::string file; CompiledDatabase database; };
[[nodiscard]] CompiledDatabase link_databases(std::vector<NamedDatabase> parts);

}  // namespace foresight
