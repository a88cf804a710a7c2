// Whether the reported covariance of a pose is that of its errors: the normalised squared error e^T C^-1 e of right
// poses has a mean of 6 where it is, more where the covariance promises too much.
#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/mean_interval.h"
#include "benchmarks/series.h"
#include "common/errors.h"
#include "runtime/pose_covariance.h"
#include "runtime/recognize.h"

namespace foresight {
namespace {

constexpr double kWellDetermined = 0.5;  // largest standard deviation of the place, for one kind of row. Unit: mm.

// One right pose.
struct PoseError {
  double squared = 0.0;    // normalised
  double distance = 0.0;   // of the model's centre. Unit: mm.
  double deviation = 0.0;  // the square root of that distance's expected square. Unit: mm.
};

// Of the poses at which the object looks the same as at the true one, the nearest.
Pose nearest_truth(const ScoredObject& object, const Pose& truth, const Pose& reported) {
  const auto farthest_vertex = [&](const Pose& pose) {
    double farthest = 0.0;
    for (const Eigen::Vector3d& vertex : object.vertices)
      farthest = std::max(farthest, (pose * vertex - reported * vertex).norm());
    return farthest;
  };
  Pose nearest = truth;
  double least = std::numeric_limits<double>::infinity();
  for (const Pose& symmetry : object.symmetries) {
    const Pose pose = truth * symmetry;
    const double distance = farthest_vertex(pose);
    if (distance < least) {
      least = distance;
      nearest = pose;
    }
  }
  return nearest;
}

PoseError error_of(const Detection& detection, const Pose& truth, const Eigen::Vector3d& centre) {
  const Pose reported = pose_of(detection.T_sensor_model);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(truth.rotation * reported.rotation.transpose()));
  Eigen::Matrix<double, 6, 1> error;
  error << truth.translation - reported.translation, turn.angle() * turn.axis();
  const PoseCovariance covariance = Eigen::Map<const PoseCovariance>(detection.covariance.data());
  const Eigen::Vector3d lever = reported.rotation * centre;
  Eigen::Matrix<double, 3, 6> of_centre;  // d + w x lever
  of_centre << Eigen::Matrix3d::Identity(),
      (Eigen::Matrix3d() << 0, lever.z(), -lever.y(), -lever.z(), 0, lever.x(), lever.y(), -lever.x(), 0).finished();
  return {error.dot(covariance.ldlt().solve(error)), (of_centre * error).norm(),
          std::sqrt((of_centre * covariance * of_centre.transpose()).trace())};
}

// Right poses of scan `index`, which shows one object.
std::vector<PoseError> errors_of_scan(const SeriesSetup& setup, const Contestant& contestant, std::uint64_t seed,
                                      int index) {
  const Scene scene = single_object_scene(setup.models, setup.sensor, setup.sensor.background, seed, index);
  const auto model = static_cast<std::size_t>(scene.objects.front().model);
  const ScoredObject& object = setup.objects[model];
  const Pose& truth = scene.objects.front().T_sensor_model;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : object.vertices) box.extend(vertex);
  std::vector<PoseError> errors;
  for (const Detection& detection : contestant.recognize(scene.scan.image, setup.sensor.camera).detections) {
    const Pose reported = pose_of(detection.T_sensor_model);
    if (detection.object != setup.models[model].name || mssd(object, reported, truth) > object.tolerance()) continue;
    errors.push_back(error_of(detection, nearest_truth(object, truth, reported), box.center()));
  }
  return errors;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

std::vector<std::string> row_of(const std::string& method, const std::string& kind,
                                const std::vector<PoseError>& errors, std::uint64_t seed) {
  std::vector<double> squared;
  std::vector<double> distances;
  std::vector<double> deviations;
  for (const PoseError& error : errors) {
    squared.push_back(error.squared);
    distances.push_back(error.distance);
    deviations.push_back(error.deviation);
  }
  const Mean mean = mean_of(squared, seed);
  return {method,
          kind,
          std::to_string(errors.size()),
          decimal(mean.value, 2),
          decimal(mean.interval.low, 2),
          decimal(mean.interval.high, 2),
          decimal(quantile(squared, 0.5), 2),
          decimal(quantile(squared, 0.95), 2),
          decimal(quantile(distances, 0.5), 3),
          decimal(quantile(deviations, 0.5), 3)};
}

void run_covariance(const ExperimentOptions& options) {
  const SeriesSetup setup = set_up_series(options, project_path("models/sensors/scanner.textproto"));
  Table table{{"method", "poses", "n", "mean_squared", "low", "high", "median_squared", "95_percent_below",
               "median_error_mm", "median_deviation_mm"},
              {}};
  for (const Contestant& contestant : setup.contestants) {
    std::vector<std::vector<PoseError>> of_scans(static_cast<std::size_t>(options.n));
    run_in_parallel(options, "covariance", options.n, [&](int i) {
      of_scans[static_cast<std::size_t>(i)] = errors_of_scan(setup, contestant, options.seed, i);
    });
    std::vector<PoseError> all;
    std::vector<PoseError> well;
    std::vector<PoseError> others;
    for (const auto& errors : of_scans) {
      for (const PoseError& error : errors) {
        all.push_back(error);
        (error.deviation <= kWellDetermined ? well : others).push_back(error);
      }
    }
    table.rows.push_back(row_of(contestant.name, "all right", all, options.seed));
    table.rows.push_back(row_of(contestant.name, "known to 0.5 mm", well, options.seed));
    table.rows.push_back(row_of(contestant.name, "known less well", others, options.seed));
  }
  write_csv(options, "covariance", table);
  std::cout << to_text(table);
}

}  // namespace

Experiment add_covariance(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand("covariance", "Whether reported covariances are those of the poses' errors");
  add_common_options(*command, *options, 200);
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options] {
            run_covariance(*options);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
