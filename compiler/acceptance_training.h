// Teaches two-way verification what right and wrong poses of an object look like, on simulated scans.
#pragma once

#include <cstdint>

#include "common/compiled_model.h"
#include "common/sensor_model.h"
#include "compiler/cad_model.h"

namespace foresight {

struct AcceptanceTrainingOptions {
  int scenes = 36;  // simulated. Limit: >= 4, one of each kind.
  // Of the starts in a scene, best looking first, so many are looked at for right ones, so many for wrong ones; of these
  // so many are refined near the true pose and so many elsewhere. Limit: >= 1, most_far >= 2.
  int most_right_starts = 60;
  int most_wrong_starts = 300;
  int most_near = 3;
  int most_far = 8;
  std::uint64_t seed = 1;
};

// Scans, by the sensor's own model, of the object alone, among impostors and boxes, and of those without it. The
// impostors are made of the object itself: mirrored, and stretched along each axis by a fifth. They are what an unknown
// object that resembles it most would be; random boxes are the flat faces of any size that lie about. Right poses are
// those at which the sensor would see the same as at the true one (90 % of the cells within 5 mm), wrong ones those
// with less than 80 %: what the runtime's best looking starts come to, and displaced true poses. compiled: the model
// without its acceptance. The runtime's own code gathers the evidence. Deterministic.
[[nodiscard]] AcceptanceModel train_acceptance(const CadModel& cad, const CompiledModel& compiled,
                                               const CompiledDatabase& settings,
                                               const AcceptanceTrainingOptions& options);

}  // namespace foresight
