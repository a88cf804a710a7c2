// The stages that every rival goes through, with what is its own left open.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "benchmarks/experiment.h"
#include "benchmarks/rivals/rival_scene.h"
#include "benchmarks/rivals/rival_verification.h"

namespace foresight {

// Poses T_sensor_model of one object, best first; and one of them refined. Each belongs to one scan.
struct RivalStages {
  std::function<std::vector<Pose>(int object)> propose;
  std::function<Pose(int object, const Pose& start)> refine;
};

// What a rival does with a scan before it looks for any object. May be called from several threads.
using BeginScan = std::function<RivalStages(const RivalScene&)>;

// Distance of the points that poses are checked with. Unit: mm.
inline constexpr double kCheckSpacing = 3.0;

// prepare_scene, then propose and refine for each object, then poses_to_report.
[[nodiscard]] Contestant rival_chain(const std::string& name, const std::vector<CadModel>& models,
                                     const SensorModel& sensor, BeginScan begin);

}  // namespace foresight
