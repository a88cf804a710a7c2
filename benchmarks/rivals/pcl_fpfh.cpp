// PCL's fast point feature histograms (Rusu et al., ICRA 2009) and RANSAC with early rejection (Buch et al., ICRA
// 2013).
#include <pcl/console/print.h>
#include <pcl/features/fpfh.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include <cstdlib>
#include <mutex>

#include "benchmarks/rivals/make_rivals.h"
#include "benchmarks/rivals/pcl_clouds.h"
#include "benchmarks/rivals/pcl_refinement.h"
#include "benchmarks/rivals/rival_chain.h"

namespace foresight {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;

struct PclFpfhOptions {
  double spacing = 6.0;          // of model and scene points. Unit: mm. Limit: > 0.
  double feature_radius = 25.0;  // neighbours in a histogram. Unit: mm. Limit: > spacing.
  double window = 0.8;           // radius of the windows of the scene, of the diameter. Limit: > 0.
  int iterations = 10000;        // of RANSAC, a window. Limit: >= 1.
  int samples = 3;               // correspondences a pose. Limit: >= 3.
  int neighbours = 3;            // features that a correspondence is drawn from. Limit: >= 1.
  double similarity = 0.85;      // of the edge lengths of the polygons. Limit: [0, 1).
  double inlier_distance = 5.0;  // Unit: mm. Limit: > 0.
  double inlier_share = 0.15;    // of the model's points, most of which no scan shows. Limit: [0, 1].
};

constexpr std::uint64_t kSeed = 1;
constexpr unsigned kRansacSeed = 1;
constexpr std::size_t kFewestPoints = 20;

struct FpfhObject {
  double diameter = 0.0;
  OrientedPoints points;
  Cloud::Ptr model;
  Features::Ptr features;
};

Features::Ptr features_of(const Cloud::Ptr& cloud, double radius) {
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation;
  estimation.setRadiusSearch(radius);
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  auto features = std::make_shared<Features>();
  estimation.compute(*features);
  return features;
}

FpfhObject train(const CadModel& cad, const PclFpfhOptions& options) {
  FpfhObject object;
  object.diameter = cad.diameter();
  object.points = sample_surface(cad, options.spacing, kSeed);
  object.model = to_pcl(object.points);
  object.features = features_of(object.model, options.feature_radius);
  return object;
}

// Points of the scene with their features: all of them, or a window.
struct FpfhScene {
  OrientedPoints points;
  Features::Ptr features;
};

FpfhScene part_of(const FpfhScene& scene, const std::vector<std::size_t>& window) {
  FpfhScene part{scene.points.at(window), std::make_shared<Features>()};
  for (const std::size_t i : window) part.features->push_back((*scene.features)[i]);
  return part;
}

std::vector<Pose> ransac(const FpfhObject& object, const FpfhScene& window, const PclFpfhOptions& options) {
  pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> registration;
  registration.setInputSource(object.model);
  registration.setSourceFeatures(object.features);
  registration.setInputTarget(to_pcl(window.points));
  registration.setTargetFeatures(window.features);
  registration.setMaximumIterations(options.iterations);
  registration.setNumberOfSamples(options.samples);
  registration.setCorrespondenceRandomness(options.neighbours);
  registration.setSimilarityThreshold(static_cast<float>(options.similarity));
  registration.setMaxCorrespondenceDistance(options.inlier_distance);
  registration.setInlierFraction(static_cast<float>(options.inlier_share));
  Cloud moved;
  // It draws with rand(), which all threads share: only one at a time draws the same numbers every time.
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  std::srand(kRansacSeed);
  registration.align(moved);
  if (!registration.hasConverged()) return {};
  return {to_pose(registration.getFinalTransformation())};
}

FpfhScene scene_features(const OrientedPoints& points, const PclFpfhOptions& options) {
  FpfhScene scene{thin_out(points, options.spacing), nullptr};
  scene.features = features_of(to_pcl(scene.points), options.feature_radius);
  return scene;
}

std::vector<Pose> propose(const FpfhObject& object, const FpfhScene& scene, const PclFpfhOptions& options) {
  std::vector<Pose> poses;
  for (const auto& window : windows(scene.points, options.window * object.diameter, kFewestPoints)) {
    for (const Pose& pose : ransac(object, part_of(scene, window), options)) poses.push_back(pose);
  }
  return poses;
}

}  // namespace

Contestant make_pcl_fpfh(const std::vector<CadModel>& models, const SensorModel& sensor) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const PclFpfhOptions options;
  const auto objects = std::make_shared<std::vector<FpfhObject>>();
  for (const CadModel& model : models) objects->push_back(train(model, options));
  return rival_chain("pcl-fpfh", models, sensor, [objects, options](const RivalScene& scene) {
    const auto refinement = std::make_shared<PclRefinement>(scene.points);
    const auto features = std::make_shared<FpfhScene>(scene_features(scene.points, options));
    const auto object_at = [objects](int i) -> const FpfhObject& { return (*objects)[static_cast<std::size_t>(i)]; };
    return RivalStages{
        [=](int object) { return propose(object_at(object), *features, options); },
        [=](int object, const Pose& start) { return refinement->refine(object_at(object).points, start); }};
  });
}

}  // namespace foresight
