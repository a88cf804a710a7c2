// OpenCV's point pair features and ICP (opencv_contrib, surface_matching).
#include <algorithm>
#include <mutex>
#include <opencv2/core.hpp>
#include <opencv2/surface_matching.hpp>
#include <opencv2/surface_matching/ppf_helpers.hpp>

#include "benchmarks/rivals/make_rivals.h"
#include "benchmarks/rivals/rival_chain.h"

namespace foresight {
namespace {

namespace ppf = cv::ppf_match_3d;

struct OpencvPpfOptions {
  double spacing = 0.1;           // of model and scene points, of the diameter. Limit: > 0.
  double distance_step = 0.1;     // of the distance bins, of the diameter. Limit: > 0.
  double angle_bins = 30;         // in a full turn. Limit: >= 4.
  double references = 0.2;        // share of the scene's points that are reference points. Limit: (0, 1].
  double cluster_distance = 0.1;  // poses within this are one, of the diameter. Limit: > 0.
  double cluster_angle = 0.2;     // and whose angles of rotation are within this. Unit: rad. Limit: > 0.
  std::size_t most_poses = 8;     // that go to ICP, an object. Limit: >= 1.
  double refine_spacing = 6.0;    // of the points that ICP gets. Unit: mm. Limit: > 0.
  int iterations = 30;            // of ICP. Limit: >= 1.
  double tolerance = 0.005;       // of ICP. Limit: > 0.
  double rejection = 2.5;         // of ICP, in robust standard deviations. Limit: > 0.
  int levels = 3;                 // of ICP. Limit: >= 1.
};

constexpr std::uint64_t kSeed = 1;
constexpr std::size_t kFewestPoints = 10;
constexpr double kSmallestSide = 0.01;  // of the bounding box of a scene. Unit: mm.

struct OpencvObject {
  double diameter = 0.0;
  ppf::PPF3DDetector detector;
  std::mutex one_at_a_time;  // match() notes its arguments in the detector
  OrientedPoints refine_points;

  explicit OpencvObject(const OpencvPpfOptions& options)
      : detector(options.spacing, options.distance_step, options.angle_bins) {}
};

// N x 6.
cv::Mat to_opencv(const OrientedPoints& points) {
  cv::Mat matrix(static_cast<int>(points.size()), 6, CV_32F);
  for (std::size_t i = 0; i < points.size(); ++i) {
    float* row = matrix.ptr<float>(static_cast<int>(i));
    for (int k = 0; k < 3; ++k) {
      row[k] = points.points[i][k];
      row[3 + k] = points.normals[i][k];
    }
  }
  return matrix;
}

Pose to_pose(const cv::Matx44d& matrix) {
  Pose pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose.rotation(row, column) = matrix(row, column);
    pose.translation[row] = matrix(row, 3);
  }
  pose.rotation = nearest_rotation(pose.rotation);
  return pose;
}

std::unique_ptr<OpencvObject> train(const CadModel& cad, const OpencvPpfOptions& options) {
  auto object = std::make_unique<OpencvObject>(options);
  object->diameter = cad.diameter();
  object->refine_points = sample_surface(cad, options.refine_spacing, kSeed);
  object->detector.setSearchParams(options.cluster_distance * object->diameter, options.cluster_angle, true);
  object->detector.trainModel(to_opencv(sample_surface(cad, options.spacing * object->diameter, kSeed)));
  return object;
}

// OpenCV thins the scene by a share of its bounding box. It is thinned already, to the model's spacing; the share asked
// for is that spacing again.
std::vector<Pose> propose(OpencvObject& object, const OrientedPoints& scene, const OpencvPpfOptions& options) {
  const double spacing = options.spacing * object.diameter;
  const OrientedPoints thinned = thin_out(scene, spacing);
  if (thinned.size() < kFewestPoints) return {};
  Eigen::Vector3f low = thinned.points.front();
  Eigen::Vector3f high = low;
  for (const Eigen::Vector3f& point : thinned.points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  // OpenCV divides by each side of the box, and runs out of bounds when one is 0.
  if (static_cast<double>((high - low).minCoeff()) < kSmallestSide) return {};
  const double share = std::min(0.2, 0.5 * spacing / static_cast<double>((high - low).maxCoeff()));
  std::vector<ppf::Pose3DPtr> found;
  {
    const std::lock_guard<std::mutex> lock(object.one_at_a_time);
    object.detector.match(to_opencv(thinned), found, options.references, share);
  }
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < std::min(found.size(), options.most_poses); ++i) poses.push_back(to_pose(found[i]->pose));
  return poses;
}

Pose refine(const OpencvObject& object, const cv::Mat& scene, const Pose& start, const OpencvPpfOptions& options) {
  OrientedPoints facing = facing_points(object.refine_points, start);
  if (facing.size() < kFewestPoints || scene.rows < static_cast<int>(kFewestPoints)) return start;
  const Eigen::Matrix3f rotation = start.rotation.cast<float>();
  for (std::size_t i = 0; i < facing.size(); ++i) {
    facing.points[i] = (start * facing.points[i].cast<double>()).cast<float>();
    facing.normals[i] = rotation * facing.normals[i];
  }
  ppf::ICP icp(options.iterations, static_cast<float>(options.tolerance), static_cast<float>(options.rejection),
               options.levels);
  cv::Matx44d moved = cv::Matx44d::eye();
  double residual = 0.0;
  icp.registerModelToScene(to_opencv(facing), scene, residual, moved);
  const Pose pose = to_pose(moved) * start;
  return pose.rotation.allFinite() && pose.translation.allFinite() ? pose : start;
}

}  // namespace

Contestant make_opencv_ppf(const std::vector<CadModel>& models, const SensorModel& sensor) {
  const OpencvPpfOptions options;
  const auto objects = std::make_shared<std::vector<std::unique_ptr<OpencvObject>>>();
  for (const CadModel& model : models) objects->push_back(train(model, options));
  return rival_chain("opencv-ppf", models, sensor, [objects, options](const RivalScene& scene) {
    const auto points = std::make_shared<cv::Mat>(to_opencv(thin_out(scene.points, options.refine_spacing)));
    const auto object_at = [objects](int i) -> OpencvObject& { return *(*objects)[static_cast<std::size_t>(i)]; };
    return RivalStages{
        [=, &scene](int object) { return propose(object_at(object), scene.points, options); },
        [=](int object, const Pose& start) { return refine(object_at(object), *points, start, options); }};
  });
}

}  // namespace foresight
