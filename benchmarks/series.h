// A series of synthetic scenes, recognized and scored.
#pragma once

#include "benchmarks/experiment.h"
#include "compiler/scene_generator.h"

namespace foresight {

// Scene i shows model i mod (number of models) alone: every model in n / models random views, as in Section VI.C.1.
[[nodiscard]] Scene single_object_scene(const std::vector<CadModel>& models, const SensorModel& sensor, bool background,
                                        std::uint64_t seed, int index);

// The truth of a scene for scoring. Its objects index the models the scene was drawn from.
[[nodiscard]] std::vector<TrueObject> truth_of(const Scene& scene);

// n scenes of single objects: recognized, scored, summed up by object and over all, written as NAME.
void run_single_object_series(const ExperimentOptions& options, const std::string& name, const SensorModel& scan_sensor,
                              const SensorModel& compile_sensor);

}  // namespace foresight
