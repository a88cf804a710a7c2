// PCL's point pair features (Drost et al., "Model globally, match locally", CVPR 2010).
#include <pcl/console/print.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <pcl/features/impl/ppf.hpp>
#include <pcl/registration/impl/ppf_registration.hpp>

#include "benchmarks/rivals/make_rivals.h"
#include "benchmarks/rivals/pcl_clouds.h"
#include "benchmarks/rivals/pcl_refinement.h"
#include "benchmarks/rivals/rival_chain.h"

namespace foresight {
namespace {

struct PclPpfOptions {
  double spacing = 0.1;           // of model and scene points and the distance bins, of the diameter. Limit: > 0.
  int angle_bins = 30;            // at least this many in a full turn: 12 degrees, PCL's default. Limit: >= 4.
  double window = 0.8;            // radius of the windows of the scene, of the diameter. Limit: > 0.
  int references = 5;             // every so many points of a window are reference points. Limit: >= 1.
  double cluster_distance = 0.1;  // poses within this are one, of the diameter. Limit: > 0.
  double cluster_angle = 0.26;    // and this. Unit: rad. Limit: > 0.
  double refine_spacing = 6.0;    // of the model points that ICP gets. Unit: mm. Limit: > 0.
};

constexpr std::uint64_t kSeed = 1;
constexpr std::size_t kFewestPoints = 10;

// PCL makes floor(2 pi / step) bins and writes past their end where an angle just below pi falls into one more. Steps
// that divide the turn with a remainder do that often; there are some, rounded as they are, that never do.
float angle_step(int at_least) {
  const double largest = static_cast<double>(std::nextafter(static_cast<float>(M_PI), 0.0F)) + M_PI;
  for (int bins = at_least;; ++bins) {
    const auto exact = static_cast<float>(2.0 * M_PI / bins);
    for (const float step : {std::nextafter(exact, 0.0F), exact}) {
      const auto wide = static_cast<double>(step);
      if (std::floor(2.0 * M_PI / wide) == bins && std::floor(largest / wide) < bins) return step;
    }
  }
}

struct PpfObject {
  double diameter = 0.0;
  double spacing = 0.0;
  pcl::PointCloud<pcl::PointNormal>::Ptr model;
  pcl::PPFHashMapSearch::Ptr search;  // not changed by looking up
  OrientedPoints refine_points;
};

PpfObject train(const CadModel& cad, const PclPpfOptions& options) {
  PpfObject object;
  object.diameter = cad.diameter();
  object.spacing = options.spacing * object.diameter;
  object.model = to_pcl(sample_surface(cad, object.spacing, kSeed));
  object.refine_points = sample_surface(cad, options.refine_spacing, kSeed);
  pcl::PPFEstimation<pcl::PointNormal, pcl::PointNormal, pcl::PPFSignature> estimation;
  estimation.setInputCloud(object.model);
  estimation.setInputNormals(object.model);
  const auto features = std::make_shared<pcl::PointCloud<pcl::PPFSignature>>();
  estimation.compute(*features);
  object.search =
      std::make_shared<pcl::PPFHashMapSearch>(angle_step(options.angle_bins), static_cast<float>(object.spacing));
  object.search->setInputFeatureCloud(features);
  return object;
}

Pose vote(const PpfObject& object, const OrientedPoints& window, const PclPpfOptions& options) {
  pcl::PPFRegistration<pcl::PointNormal, pcl::PointNormal> registration;
  registration.setSceneReferencePointSamplingRate(static_cast<unsigned>(options.references));
  registration.setPositionClusteringThreshold(static_cast<float>(options.cluster_distance * object.diameter));
  registration.setRotationClusteringThreshold(static_cast<float>(options.cluster_angle));
  registration.setSearchMethod(object.search);
  registration.setInputSource(object.model);
  registration.setInputTarget(to_pcl(window));
  pcl::PointCloud<pcl::PointNormal> moved;
  registration.align(moved);
  return to_pose(registration.getFinalTransformation());
}

std::vector<Pose> propose(const PpfObject& object, const OrientedPoints& scene, const PclPpfOptions& options) {
  const OrientedPoints thinned = thin_out(scene, object.spacing);
  std::vector<Pose> poses;
  for (const auto& window : windows(thinned, options.window * object.diameter, kFewestPoints)) {
    poses.push_back(vote(object, thinned.at(window), options));
  }
  return poses;
}

}  // namespace

Contestant make_pcl_ppf(const std::vector<CadModel>& models, const SensorModel& sensor) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const PclPpfOptions options;
  const auto objects = std::make_shared<std::vector<PpfObject>>();
  for (const CadModel& model : models) objects->push_back(train(model, options));
  return rival_chain("pcl-ppf", models, sensor, [objects, options](const RivalScene& scene) {
    const auto refinement = std::make_shared<PclRefinement>(scene.points);
    const auto object_at = [objects](int i) -> const PpfObject& { return (*objects)[static_cast<std::size_t>(i)]; };
    return RivalStages{
        [=, &scene](int object) { return propose(object_at(object), scene.points, options); },
        [=](int object, const Pose& start) { return refinement->refine(object_at(object).refine_points, start); }};
  });
}

}  // namespace foresight
