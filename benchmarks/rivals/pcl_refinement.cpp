#include "benchmarks/rivals/pcl_refinement.h"

#include <pcl/registration/icp.h>

#include "benchmarks/rivals/pcl_clouds.h"

namespace foresight {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Tree = pcl::search::KdTree<pcl::PointNormal>;

constexpr std::size_t kFewestPoints = 6;  // unknowns of a pose

}  // namespace

struct PclRefinement::Impl {
  PclRefinementOptions options;
  Cloud::Ptr scene;
  Tree::Ptr tree;
};

PclRefinement::PclRefinement(const OrientedPoints& scene, const PclRefinementOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->scene = to_pcl(thin_out(scene, options.spacing));
  impl_->tree = std::make_shared<Tree>();
  impl_->tree->setInputCloud(impl_->scene);
}
PclRefinement::~PclRefinement() = default;
PclRefinement::PclRefinement(PclRefinement&&) noexcept = default;

Pose PclRefinement::refine(const OrientedPoints& model, const Pose& start) const {
  Pose pose = start;
  for (const double distance : {impl_->options.far_distance, impl_->options.near_distance}) {
    const Cloud::Ptr facing = to_pcl(facing_points(model, pose));
    if (facing->size() < kFewestPoints || impl_->scene->size() < kFewestPoints) return pose;
    pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
    icp.setSearchMethodTarget(impl_->tree, true);
    icp.setInputSource(facing);
    icp.setInputTarget(impl_->scene);
    icp.setMaxCorrespondenceDistance(distance);
    icp.setMaximumIterations(impl_->options.iterations);
    icp.setTransformationEpsilon(1e-8);
    Cloud moved;
    icp.align(moved, to_matrix(pose));
    const Eigen::Matrix4f found = icp.getFinalTransformation();
    if (!found.allFinite()) return pose;
    pose = to_pose(found);
  }
  return pose;
}

}  // namespace foresight
