#include "runtime/recognize.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/errors.h"
#include "runtime/highest_confidence_first.h"
#include "runtime/hypothesis_cliques.h"
#include "runtime/nearest_data_cell.h"
#include "runtime/nearest_data_point.h"
#include "runtime/pose_covariance.h"
#include "runtime/pose_evidence.h"
#include "runtime/scan_context.h"
#include "runtime/two_way_search.h"
#include "runtime/verify_in_order.h"

namespace foresight {
namespace {

std::vector<Label> prune(const HypothesisField& field, Pruning pruning) {
  if (pruning == Pruning::none) return std::vector<Label>(field.matches.size(), kOn);
  return highest_confidence_first(field);
}

}  // namespace

Pose pose_of(const std::array<double, 16>& T) {
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(T.data());
  return {matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
}

LocalizationOptions localization_options(const RecognizeOptions& options) {
  LocalizationOptions localization;
  localization.loss = options.loss;
  return localization;
}

VerificationOptions verification_options(const RecognizeOptions& options) {
  VerificationOptions verification;
  verification.smallest_matched = options.smallest_matched;
  verification.smallest_coherent = options.smallest_coherent;
  verification.largest_occluding = options.largest_occluding;
  return verification;
}

void check(const RecognizeOptions& options) {
  const auto fraction = [](double value, const char* name) {
    if (!(value >= 0.0 && value <= 1.0)) throw UsageError(name, "outside its limits", "give a fraction from 0 to 1");
  };
  fraction(options.smallest_matched, "smallest_matched");
  fraction(options.smallest_coherent, "smallest_coherent");
  fraction(options.largest_occluding, "largest_occluding");
  const auto potential = [](double value, const char* name) {
    if (!(value >= -1e4 && value <= 1e4))
      throw UsageError(name, "outside its limits", "give a potential from -10000 to 10000");
  };
  potential(options.potentials.support_on_on, "support_on_on");
  potential(options.potentials.support_off_off, "support_off_off");
  potential(options.potentials.contradiction_on_on, "contradiction_on_on");
  potential(options.potentials.contradiction_on_off, "contradiction_on_off");
  if (options.most_detections < 0) throw UsageError("most_detections", "negative", "give 0 for no limit, or a count");
  if (options.most_verifications < 0)
    throw UsageError("most_verifications", "negative", "give 0 for no limit, or a count");
}

void check_method(const RecognizeOptions& options, const Database& database, const std::string& file) {
  if (options.method == Method::paper) return;
  for (const CompiledModel& model : database.models()) {
    if (model.acceptance.samples > 0 && !model.triangle_faces.empty()) continue;
    throw DatabaseError(DatabaseFault::incompatible, file,
                        "object " + model.name + " lacks what the two-way method needs",
                        "compile it again with this version of foresightc, or use --method paper");
  }
}

namespace {

// The paper searches as far as there are data, the two-way method within a short reach.
std::unique_ptr<const NearestData> nearest_data(const RangeImage& image, const PinholeCamera& camera,
                                                const SensorModel& sensor, Method method) {
  if (method == Method::paper) return std::make_unique<NearestDataPoint>(image);
  return std::make_unique<NearestDataCell>(image, camera, judging_options(sensor).stride);
}

// Sections III to V.
void recognize_as_published(const ScanContext& scan, const RecognizeOptions& options, const Deadline& deadline,
                            RecognitionResult& result) {
  Stopwatch watch;
  const Database& database = scan.database;
  const BackgroundOptions background = background_for(database.content().density);
  const auto matches = match_likelihoods(scan.regions, database, background);  // eqs. (4), (5)
  const auto field =
      build_hypothesis_field(scan.regions, matches, database, background, options.potentials);  // eqs. (1)-(3)
  const auto labels = prune(field, options.pruning);
  watch.lap(result.milliseconds.field);
  const auto hypotheses = hypothesis_cliques(field, database, labels);  // least energy first
  watch.lap(result.milliseconds.hypotheses);
  result.statistics.threshold_matches = static_cast<long>(matches.size());
  result.statistics.active_matches = static_cast<long>(std::count(labels.begin(), labels.end(), kOn));
  result.statistics.hypotheses = static_cast<long>(hypotheses.size());
  verify_in_order(scan, field, hypotheses, options, deadline, result);  // Section V
}

// Names of models are unique in a database.
const CompiledModel& model_of(const Detection& detection, const Database& database) {
  const auto& models = database.models();
  return *std::find_if(models.begin(), models.end(),
                       [&](const CompiledModel& model) { return model.name == detection.object; });
}

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

}  // namespace

RecognitionResult recognize(const RangeImage& image, const PinholeCamera& camera, const Database& database,
                            const RecognizeOptions& options, const Deadline& deadline) {
  RecognitionResult result;
  Stopwatch total;
  Stopwatch watch;
  double ignored = 0.0;  // the searches time their own stages
  const auto late = [&deadline] { return deadline && std::chrono::steady_clock::now() >= *deadline; };
  const auto regions = extract_regions(image, camera, database.content().segmentation, late);
  if (regions.empty() && late()) result.complete = false;
  watch.lap(result.milliseconds.extract);
  result.statistics.regions = static_cast<int>(regions.size());
  result.statistics.possible_matches = static_cast<long>(regions.size()) * static_cast<long>(database.faces().size());
  if (!regions.empty()) {
    const ScanContext scan{image, camera, database, regions,
                           nearest_data(image, camera, database.content().sensor, options.method)};
    watch.lap(result.milliseconds.localize);  // which the k-d tree serves
    if (options.method == Method::paper) {
      recognize_as_published(scan, options, deadline, result);
    } else {
      search_two_way(scan, options, deadline, result);
    }
    watch.lap(ignored);
    for (Detection& detection : result.detections) {
      add_covariance(image, camera, database.content().sensor, model_of(detection, database), detection);
    }
    watch.lap(result.milliseconds.verify);
  }
  total.lap(result.milliseconds.total);
  return result;
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
  detection.object = model.name;
  const Pose& pose = refined.localization.T_sensor_model;
  const auto entry = [&](int row, int column) -> double& {
    return detection.T_sensor_model[static_cast<std::size_t>(4 * row + column)];
  };
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) entry(row, column) = pose.rotation(row, column);
    entry(row, 3) = pose.translation[row];
  }
  entry(3, 3) = 1.0;
  detection.matched = refined.verification.matched;
  detection.coherent = refined.verification.coherent;
  detection.occluding = refined.verification.occluding;
  detection.score = detection.matched;
  detection.quaternion = canonical_quaternion(pose.rotation);
  const BoundingBox box = bounding_box(model);
  detection.box_centre = box.centre;
  detection.box_size = box.size;
  return detection;
}

void add_covariance(const RangeImage& image, const PinholeCamera& camera, const SensorModel& sensor,
                    const CompiledModel& model, Detection& detection) {
  const PoseCovariance covariance = pose_covariance(model, pose_of(detection.T_sensor_model), image, camera, sensor);
  std::copy(covariance.data(), covariance.data() + covariance.size(), detection.covariance.begin());  // symmetric
}

RefinedPose refine_and_verify(const RangeImage& image, const PinholeCamera& camera, const CompiledModel& model,
                              const Pose& T_sensor_model, const RecognizeOptions& options) {
  const NearestDataPoint data(image);
  const ViewingSphere sphere(kAspectCells);
  RefinedPose refined;
  refined.localization = localize(model, sphere, T_sensor_model, data, localization_options(options));
  refined.verification =
      verify(model, sphere, refined.localization.T_sensor_model, image, camera, data, verification_options(options));
  return refined;
}

}  // namespace foresight
