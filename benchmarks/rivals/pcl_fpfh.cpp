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
  double spacing = 4.0;          // of model and scene points. Unit: mm. Limit: > 0.
  double feature_radius = 20.0;  // neighbours in a histogram. Unit: mm. Limit: > spacing.
  double window = 0.8;           // radius of the windows of the scene, of the diameter. Limit: > 0.
  int iterations = 4000;         // of RANSAC, a window. Limit: >= 1.
  int samples = 3;               // correspondences a pose. Limit: >= 3.
  int neighbours = 5;            // features that a correspondence is drawn from. Limit: >= 1.
  double similarity = 0.9;       // of the edge lengths of the polygons. Limit: [0, 1).
  double inlier_distance = 5.0;  // Unit: mm. Limit: > 0.
  double inlier_share = 0.2;     // of the model's points, most of which no scan shows. Limit: [0, 1].
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

// A window of the scene with the features that its points have in the whole scene.
struct FpfhWindow {
  Cloud::Ptr cloud;
  Features::Ptr features;
};

std::vector<Pose> ransac(const FpfhObject& object, const FpfhWindow& window, const PclFpfhOptions& options) {
  pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> registration;
  registration.setInputSource(object.model);
  registration.setSourceFeatures(object.features);
  registration.setInputTarget(window.cloud);
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

std::vector<FpfhWindow> feature_windows(const OrientedPoints& scene, double radius, const PclFpfhOptions& options) {
  std::vector<FpfhWindow> found;
  for (const OrientedPoints& window : windows(scene, radius, kFewestPoints)) {
    const Cloud::Ptr cloud = to_pcl(window);
    found.push_back({cloud, features_of(cloud, options.feature_radius)});
  }
  return found;
}

}  // namespace

Contestant make_pcl_fpfh(const std::vector<CadModel>& models, const SensorModel& sensor) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const PclFpfhOptions options;
  const auto objects = std::make_shared<std::vector<FpfhObject>>();
  for (const CadModel& model : models) objects->push_back(train(model, options));
  return rival_chain("pcl-fpfh", models, sensor, [objects, options](const RivalScene& scene) {
    const auto refinement = std::make_shared<PclRefinement>(scene.points);
    const auto thinned = std::make_shared<OrientedPoints>(thin_out(scene.points, options.spacing));
    const auto object_at = [objects](int i) -> const FpfhObject& { return (*objects)[static_cast<std::size_t>(i)]; };
    return RivalStages{
        [=](int object) {
          std::vector<Pose> poses;
          const double radius = options.window * object_at(object).diameter;
          for (const FpfhWindow& window : feature_windows(*thinned, radius, options)) {
            for (const Pose& pose : ransac(object_at(object), window, options)) poses.push_back(pose);
          }
          return poses;
        },
        [=](int object, const Pose& start) { return refinement->refine(object_at(object).points, start); }};
  });
}

}  // namespace foresight
