// Views that show one face only, which the paper's features cannot handle (Section VI.C.1).
#include <Eigen/Geometry>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>

#include "benchmarks/commands.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {
namespace {

constexpr int kViewsTried = 100;                                  // of one object
constexpr double kLargestTilt = 12.0 * std::numbers::pi / 180.0;  // of the face from the line of sight
constexpr int kFewestCells = 12;                                  // of a visible face

int visible_faces(const SimulatedScan& scan, std::size_t faces) {
  std::vector<int> cells(faces, 0);
  for (const CellLabel& label : scan.labels) {
    if (label.object == 0) ++cells[static_cast<std::size_t>(label.face)];
  }
  return static_cast<int>(std::count_if(cells.begin(), cells.end(), [](int n) { return n >= kFewestCells; }));
}

// A face at random turned towards the sensor, nearly straight, with the face's middle near the optical axis.
Pose facing_pose(const CadModel& model, const SensorModel& sensor, Random& random) {
  const CadFace& face =
      model.faces[static_cast<std::size_t>(random.integer(0, static_cast<int>(model.faces.size()) - 1))];
  const Eigen::Quaterniond straight = Eigen::Quaterniond::FromTwoVectors(face.normal, -Eigen::Vector3d::UnitZ());
  const double roll = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double tilt_axis = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double tilt = random.uniform(0.0, kLargestTilt);
  Pose pose;
  pose.rotation = (Eigen::AngleAxisd(tilt, Eigen::Vector3d(std::cos(tilt_axis), std::sin(tilt_axis), 0.0)) *
                   Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) * straight)
                      .toRotationMatrix();
  const double distance = random.uniform(sensor.nearest_distance, sensor.farthest_distance);
  pose.translation = Eigen::Vector3d(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0), distance) -
                     pose.rotation * face.centroid;
  return pose;
}

// None for an object that hardly ever shows a single face.
std::optional<TrueScan> draw_single_face(const SeriesSetup& setup, int object, Random& random) {
  const CadModel& model = setup.models[static_cast<std::size_t>(object)];
  for (int i = 0; i < kViewsTried; ++i) {
    const PlacedObject placed{&model, facing_pose(model, setup.sensor, random)};
    SimulatedScan scan = SimulatedScene({&placed, 1}).scan(setup.sensor, Random(random.next()));
    if (visible_faces(scan, model.faces.size()) != 1) continue;
    return TrueScan{"", std::move(scan.image), setup.sensor.camera, {{object, {placed.T_sensor_model}, 1.0}}};
  }
  return std::nullopt;
}

// The objects in turn; one that shows no single face is passed over.
TrueScan draw_view(const SeriesSetup& setup, std::uint64_t seed, int i) {
  Random random(seed, static_cast<std::uint64_t>(i));
  const int objects = static_cast<int>(setup.models.size());
  for (int k = 0; k < objects; ++k) {
    std::optional<TrueScan> scan = draw_single_face(setup, (i + k) % objects, random);
    if (!scan) continue;
    scan->name = std::to_string(i);
    return *std::move(scan);
  }
  throw UsageError("--cad", "none of the objects shows a single face", "give objects that have such views");
}

void run_single_surface(const ExperimentOptions& options) {
  const SeriesSetup setup = set_up_series(options);
  const auto records = recognize_series(options, "single-surface", setup, options.n,
                                        [&](int i) { return draw_view(setup, options.seed, i); });
  const auto by_object = [&](const auto& of_method) { return rows_by_object(setup.models, of_method); };
  write_results(options, "single-surface", rows_of_all(records, by_object), joined(records), setup.models);

  // One face mostly fits several poses: an answer that names them all is the right one.
  const auto all = [](const auto& of_method) { return std::vector{summarize("all", of_method)}; };
  const Table declared = declared_table(rows_of_all(records, all), options.seed);
  write_csv(options, "single-surface_declared", declared);
  std::cout << to_text(declared);
}

}  // namespace

Experiment add_single_surface(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command =
      app.add_subcommand("single-surface", "Views with one visible face, at which the paper's method fails");
  add_common_options(*command, *options, 160);
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options] {
            run_single_surface(*options);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
