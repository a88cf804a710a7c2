#include "benchmarks/rivals/pcl_planes.h"

#include <pcl/console/print.h>
#include <pcl/features/integral_image_normal.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/organized_multi_plane_segmentation.h>

#include <memory>

namespace foresight {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Labels = pcl::PointCloud<pcl::Label>;

// PCL lets its tolerances grow with the square of the depth, or with 1 + depth, and means metres.
constexpr float kMetresPerMillimetre = 0.001F;

Cloud::Ptr to_cloud(const RangeImage& image) {
  auto cloud =
      std::make_shared<Cloud>(static_cast<std::uint32_t>(image.columns), static_cast<std::uint32_t>(image.rows));
  cloud->is_dense = false;
  for (int cell = 0; cell < image.size(); ++cell) {
    (*cloud)[static_cast<std::size_t>(cell)].getVector3fMap() = kMetresPerMillimetre * image[cell];
  }
  return cloud;
}

Normals::Ptr normals_of(const Cloud::Ptr& cloud, const PclPlanesOptions& options) {
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.COVARIANCE_MATRIX);
  estimation.setMaxDepthChangeFactor(static_cast<float>(options.depth_change));
  estimation.setNormalSmoothingSize(static_cast<float>(options.normal_smoothing));
  estimation.setInputCloud(cloud);
  auto normals = std::make_shared<Normals>();
  estimation.compute(*normals);
  return normals;
}

}  // namespace

std::vector<int> pcl_planes(const RangeImage& image, const PclPlanesOptions& options) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const Cloud::Ptr cloud = to_cloud(image);
  pcl::OrganizedMultiPlaneSegmentation<pcl::PointXYZ, pcl::Normal, pcl::Label> segmentation;
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(normals_of(cloud, options));
  segmentation.setMinInliers(static_cast<unsigned>(options.smallest_region));
  segmentation.setAngularThreshold(options.angle);
  segmentation.setDistanceThreshold(options.distance * static_cast<double>(kMetresPerMillimetre));
  segmentation.setMaximumCurvature(options.largest_curvature);

  std::vector<pcl::ModelCoefficients> planes;
  std::vector<pcl::PointIndices> members;
  std::vector<Eigen::Vector4f, Eigen::aligned_allocator<Eigen::Vector4f>> centroids;
  std::vector<Eigen::Matrix3f, Eigen::aligned_allocator<Eigen::Matrix3f>> covariances;
  const auto cloud_labels = std::make_shared<Labels>();
  std::vector<pcl::PointIndices> components;
  segmentation.segment(planes, members, centroids, covariances, *cloud_labels, components);
  Labels::Ptr labels = cloud_labels;
  if (options.refine && !planes.empty()) segmentation.refine(planes, members, labels, components);

  std::vector<int> regions(static_cast<std::size_t>(image.size()), 0);
  for (std::size_t region = 0; region < members.size(); ++region) {
    for (const int cell : members[region].indices) {
      regions[static_cast<std::size_t>(cell)] = static_cast<int>(region) + 1;
    }
  }
  return regions;
}

}  // namespace foresight
