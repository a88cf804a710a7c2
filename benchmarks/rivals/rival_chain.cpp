#include "benchmarks/rivals/rival_chain.h"

#include <chrono>
#include <utility>

namespace foresight {
namespace {

constexpr std::uint64_t kCheckSeed = 1;

class Stopwatch {
 public:
  // Milliseconds since the last lap.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double passed = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return passed;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::array<double, 16> row_major(const Pose& pose) {
  std::array<double, 16> matrix{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      matrix[static_cast<std::size_t>(4 * row + column)] = pose.rotation(row, column);
    }
    matrix[static_cast<std::size_t>(4 * row + 3)] = pose.translation[row];
  }
  matrix[15] = 1.0;
  return matrix;
}

// What a chain keeps between scans.
struct Trained {
  SensorModel sensor;
  std::vector<std::string> names;
  std::vector<OrientedPoints> check_points;
  BeginScan begin;
};

RecognitionResult recognize(const Trained& trained, const RangeImage& image, const PinholeCamera& camera) {
  RecognitionResult result;
  StageTimes& times = result.milliseconds;
  Stopwatch watch;
  const RivalScene scene = prepare_scene(image, camera, trained.sensor);
  times.extract = watch.lap();
  if (scene.points.size() > 0) {
    const RivalStages stages = trained.begin(scene);
    times.hypotheses = watch.lap();
    std::vector<PoseCandidate> candidates;
    for (int object = 0; object < static_cast<int>(trained.names.size()); ++object) {
      const std::vector<Pose> poses = stages.propose(object);
      times.hypotheses += watch.lap();
      for (const Pose& pose : poses) candidates.push_back({object, stages.refine(object, pose)});
      times.localize += watch.lap();
    }
    result.statistics.hypotheses = static_cast<long>(candidates.size());
    result.statistics.verifications = static_cast<long>(candidates.size());
    for (const ReportedPose& report : poses_to_report(scene, trained.sensor, trained.check_points, candidates)) {
      const PoseCandidate& candidate = candidates[static_cast<std::size_t>(report.candidate)];
      Detection detection;
      detection.object = trained.names[static_cast<std::size_t>(candidate.object)];
      detection.T_sensor_model = row_major(candidate.T_sensor_model);
      detection.score = report.share;
      detection.matched = report.share;
      detection.rank = static_cast<int>(result.detections.size()) + 1;
      result.detections.push_back(std::move(detection));
    }
    times.verify = watch.lap();
  }
  times.total = times.extract + times.hypotheses + times.localize + times.verify;
  return result;
}

}  // namespace

Contestant rival_chain(const std::string& name, const std::vector<CadModel>& models, const SensorModel& sensor,
                       BeginScan begin) {
  const auto trained = std::make_shared<Trained>();
  trained->sensor = sensor;
  trained->begin = std::move(begin);
  for (const CadModel& model : models) {
    trained->names.push_back(model.name);
    trained->check_points.push_back(sample_surface(model, kCheckSpacing, kCheckSeed));
  }
  return {name, [trained](const RangeImage& image, const PinholeCamera& camera) {
            return recognize(*trained, image, camera);
          }};
}

}  // namespace foresight
