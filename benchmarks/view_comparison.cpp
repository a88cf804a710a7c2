#include "benchmarks/view_comparison.h"

#include "compiler/sensor_simulator.h"

namespace foresight {
namespace {

RangeImage render_alone(const CadModel& model, const SensorModel& sensor, const Pose& T_sensor_model) {
  const std::vector<PlacedObject> placed = {{&model, T_sensor_model}};
  return SimulatedScene(placed).scan(sensor, Random(0)).image;
}

}  // namespace

double view_agreement(const CadModel& model, const SensorModel& sensor, const Pose& a, const Pose& b, double distance) {
  SensorModel exact = sensor;
  exact.depth_noise = 0.0;
  exact.depth_quantization = 0.0;
  const RangeImage at_a = render_alone(model, exact, a);
  const RangeImage at_b = render_alone(model, exact, b);
  int either = 0;
  int agreeing = 0;
  for (int cell = 0; cell < at_a.size(); ++cell) {
    if (!at_a.valid(cell) && !at_b.valid(cell)) continue;
    ++either;
    if (at_a.valid(cell) && at_b.valid(cell) && (at_a[cell] - at_b[cell]).norm() <= distance) ++agreeing;
  }
  return either == 0 ? 0.0 : static_cast<double>(agreeing) / either;
}

bool indistinguishable(const CadModel& model, const SensorModel& sensor, const Pose& reported, const Pose& truth,
                       const ViewComparisonOptions& options) {
  return view_agreement(model, sensor, reported, truth, options.distance) >= options.smallest_share;
}

}  // namespace foresight
