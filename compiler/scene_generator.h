// Random scenes of known objects with their truth: what `foresightc simulate` and the experiments draw from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/sensor_model.h"
#include "compiler/cad_model.h"
#include "compiler/sensor_simulator.h"

namespace foresight {

struct SceneOptions {
  int fewest_objects = 1;   // Limit: >= 1.
  int most_objects = 1;     // Limit: >= fewest_objects, <= number of models (each at most once a scene).
  bool background = false;  // objects rest on a table seen at an angle, instead of floating before nothing
  // Index of the one model whose visibility is measured; the others' stays 0. Each takes a scan of its own. None: all.
  std::optional<int> only_measured = std::nullopt;
};

// Throws UsageError when the options ask for what `models` models cannot give.
void check(const SceneOptions& options, std::size_t models);

// One object of a scene, with how much of it the scan shows.
struct SceneObject {
  int model = 0;  // index into the models given
  Pose T_sensor_model;
  double visible_fraction = 0.0;  // data cells on the object / cells it would have alone in an image that holds all of it
  int visible_faces = 0;          // faces with at least 12 cells
};

struct Scene {
  std::vector<SceneObject> objects;
  std::vector<BackgroundPlane> background;
  SimulatedScan scan;  // labels[..].object indexes `objects`
};

// Scene `index` of the series `seed`; scenes do not depend on one another. Objects never interpenetrate; they may hide
// one another. They lie inside the image where they fit; where many do not, some may lie farther away or reach over its
// border. REQUIRES: check() passes for options and models.
[[nodiscard]] Scene generate_scene(const std::vector<CadModel>& models, const SensorModel& sensor,
                                   const SceneOptions& options, std::uint64_t seed, std::uint64_t index);

// The truth file that goes with the scans: scan name, objects, T_sensor_model, visible fraction, visible faces; one
// JSON document.
[[nodiscard]] std::string truth_json(const std::vector<Scene>& scenes, const std::vector<CadModel>& models,
                                     const std::vector<std::string>& scan_names, const SensorModel& sensor,
                                     std::uint64_t seed);

}  // namespace foresight
