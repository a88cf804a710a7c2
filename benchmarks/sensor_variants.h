// A sensor with less and less of what the paper's simulator leaves out, and databases whose priors come from it.
#pragma once

#include <string>
#include <vector>

#include "common/compiled_model.h"
#include "common/sensor_model.h"
#include "compiler/cad_model.h"
#include "compiler/face_samples.h"

namespace foresight {

struct SensorVariant {
  std::string name;
  SensorModel sensor;
};

// "nothing": the sensor as the paper would have simulated it (Section III), without noise, without shadows, at one
// distance (the working distance), up to any incidence. Then "noise", "shadow", "distance" and "incidence": nothing but
// that one; and "all": the sensor itself. Camera and quantization are the sensor's in all: the paper simulated those of
// its own. Where the sensor lacks one of them, its variant is left out: it would be "nothing" again.
[[nodiscard]] std::vector<SensorVariant> sensor_variants(const SensorModel& sensor);

// The database with its priors (P(M), P(f|M) and P(f|M,M')) from views by another sensor. Extraction settings, the
// sensor the runtime knows, surface templates and acceptance models stay as they are. REQUIRES: `models` are the
// database's, in its order.
[[nodiscard]] CompiledDatabase with_priors_of(const SensorModel& sensor, CompiledDatabase database,
                                              const std::vector<CadModel>& models,
                                              const FaceSampleOptions& samples = {});

}  // namespace foresight
