// Between our points and PCL's clouds; private to the sources that include PCL.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <memory>

#include "benchmarks/rivals/oriented_points.h"

namespace foresight {

inline pcl::PointCloud<pcl::PointNormal>::Ptr to_pcl(const OrientedPoints& points) {
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  cloud->reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    pcl::PointNormal point;
    point.getVector3fMap() = points.points[i];
    // PCL takes the arc cosine of components, and a unit normal may round to a hair more than 1.
    point.getNormalVector3fMap() = points.normals[i].cwiseMax(-1.0F).cwiseMin(1.0F);
    cloud->push_back(point);
  }
  return cloud;
}

inline Eigen::Matrix4f to_matrix(const Pose& pose) {
  Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
  matrix.topLeftCorner<3, 3>() = pose.rotation.cast<float>();
  matrix.topRightCorner<3, 1>() = pose.translation.cast<float>();
  return matrix;
}

inline Pose to_pose(const Eigen::Matrix4f& matrix) {
  return {nearest_rotation(matrix.topLeftCorner<3, 3>().cast<double>()), matrix.topRightCorner<3, 1>().cast<double>()};
}

}  // namespace foresight
