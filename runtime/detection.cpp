#include "runtime/detection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "runtime/pose_covariance.h"

namespace foresight {
namespace {

// Scenes with more detections, or longer lists, allocate once; then they are spares as well.
constexpr std::size_t kUsualDetections = 32;
constexpr std::size_t kUsualRegions = 32;
constexpr std::size_t kUsualAlternatives = 16;

// w, x, y, z. Of the two that mean the same rotation, the one with w > 0, or whose first number other than 0 is.
std::array<double, 4> canonical_quaternion(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  std::array<double, 4> numbers = {q.w(), q.x(), q.y(), q.z()};
  const auto first = std::find_if(numbers.begin(), numbers.end(), [](double number) { return number != 0.0; });
  if (first != numbers.end() && *first < 0.0) {
    for (double& number : numbers) number = 0.0 - number;  // no -0.0
  }
  return numbers;
}

// All but rank, lists and covariance.
void fill_in(const CompiledModel& model, const RefinedPose& refined, Detection& detection) {
  const Pose& pose = refined.localization.T_sensor_model;
  detection.object = model.name;
  detection.T_sensor_model = row_major(pose);
  detection.matched = refined.verification.matched;
  detection.coherent = refined.verification.coherent;
  detection.occluding = refined.verification.occluding;
  detection.score = detection.matched;
  detection.quaternion = canonical_quaternion(pose.rotation);
  const BoundingBox box = bounding_box(model);
  detection.box_centre = box.centre;
  detection.box_size = box.size;
}

// As resize, but entries come from the spare ones and go there.
template <typename T>
void resize(std::vector<T>& list, std::size_t count, std::vector<T>& spare) {
  for (; list.size() > count; list.pop_back()) spare.push_back(std::move(list.back()));
  for (; list.size() < count && !spare.empty(); spare.pop_back()) list.push_back(std::move(spare.back()));
  list.resize(count);
}

}  // namespace

Pose pose_of(const std::array<double, 16>& T) {
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(T.data());
  return {matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
}

std::array<double, 16> row_major(const Pose& pose) {
  std::array<double, 16> T{};
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(T.data());
  matrix.topLeftCorner<3, 3>() = pose.rotation;
  matrix.topRightCorner<3, 1>() = pose.translation;
  matrix(3, 3) = 1.0;
  return T;
}

BoundingBox bounding_box(const CompiledModel& model) {
  Eigen::AlignedBox3d extent;
  for (const Eigen::Vector3f& vertex : model.vertices) extent.extend(vertex.cast<double>());
  BoundingBox box;
  if (extent.isEmpty()) return box;
  Eigen::Vector3d::Map(box.centre.data()) = extent.center();
  Eigen::Vector3d::Map(box.size.data()) = extent.sizes();
  return box;
}

Detection to_detection(const CompiledModel& model, const RefinedPose& refined) {
  Detection detection;
  fill_in(model, refined, detection);
  return detection;
}

std::array<double, 36> covariance_at(const CompiledModel& model, const Pose& T_sensor_model, const RangeImage& image,
                                     const PinholeCamera& camera, const SensorModel& sensor) {
  const PoseCovariance covariance = pose_covariance(model, T_sensor_model, image, camera, sensor);
  std::array<double, 36> rows{};
  std::copy(covariance.data(), covariance.data() + covariance.size(), rows.begin());  // symmetric
  return rows;
}

SpareDetections spare_detections(const Database& database) {
  std::size_t longest = 0;
  for (const CompiledModel& model : database.models()) longest = std::max(longest, model.name.size());
  SpareDetections spare;
  spare.detections.resize(kUsualDetections);
  for (Detection& detection : spare.detections) {
    detection.object.reserve(longest);
    detection.faces.reserve(kUsualRegions);
    detection.regions.reserve(kUsualRegions);
    detection.ambiguous_with.reserve(kUsualAlternatives);
  }
  spare.alternatives.resize(kUsualDetections);
  for (Alternative& alternative : spare.alternatives) alternative.object.reserve(longest);
  return spare;
}

void empty(RecognitionResult& result, SpareDetections& spare) {
  resize(result.detections, 0, spare.detections);
  result.complete = true;
  result.statistics = {};
  result.milliseconds = {};
}

void report(const Recognition& found, const Database& database, RecognitionResult& result, SpareDetections& spare) {
  const auto model_at = [&](int model) -> const CompiledModel& {
    return database.models()[static_cast<std::size_t>(model)];
  };
  result.complete = found.complete;
  result.statistics = found.statistics;
  result.milliseconds = found.milliseconds;
  resize(result.detections, found.objects.size(), spare.detections);
  for (std::size_t i = 0; i < found.objects.size(); ++i) {
    const FoundObject& object = found.objects[i];
    Detection& detection = result.detections[i];
    fill_in(model_at(object.model), object.pose, detection);
    detection.score = object.score;
    detection.rank = object.rank;
    detection.faces.assign(object.faces.begin(), object.faces.end());
    detection.regions.assign(object.regions.begin(), object.regions.end());
    resize(detection.ambiguous_with, object.alternatives.size(), spare.alternatives);
    for (std::size_t k = 0; k < object.alternatives.size(); ++k) {
      const FoundAlternative& other = object.alternatives[k];
      Alternative& alternative = detection.ambiguous_with[k];
      alternative.object = model_at(other.model).name;
      alternative.T_sensor_model = row_major(other.T_sensor_model);
      alternative.score = other.score;
    }
    detection.covariance = object.covariance;
  }
}

}  // namespace foresight
