// Range images built in code: rectangles in space seen through a pinhole camera.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "common/camera.h"
#include "common/pose.h"
#include "common/random.h"
#include "common/range_image.h"

namespace foresight::test {

// corner + s * a + t * b for s, t in [0, 1]. REQUIRES: a perpendicular to b. Unit: mm.
struct Rectangle {
  Eigen::Vector3d corner, a, b;
};

inline Rectangle moved(const Rectangle& r, const Pose& pose) {
  return {pose * r.corner, pose.rotation * r.a, pose.rotation * r.b};
}

// Rectangle of a size facing the camera, its centre at a position.
inline Rectangle facing(const Eigen::Vector3d& centre, double width, double height) {
  return {centre - Eigen::Vector3d(width / 2, height / 2, 0), {width, 0, 0}, {0, height, 0}};
}

// The six sides of a box centred at the origin.
inline std::vector<Rectangle> box_sides(const Eigen::Vector3d& size) {
  std::vector<Rectangle> sides;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-0.5, 0.5}) {
      Eigen::Vector3d corner = -0.5 * size;
      corner[axis] = sign * size[axis];
      Eigen::Vector3d a = Eigen::Vector3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      a[(axis + 1) % 3] = size[(axis + 1) % 3];
      b[(axis + 2) % 3] = size[(axis + 2) % 3];
      sides.push_back({corner, a, b});
    }
  }
  return sides;
}

// Nearest rectangle in each cell, with Gaussian noise of the depth.
inline RangeImage render(const std::vector<Rectangle>& rectangles, const PinholeCamera& camera, double noise = 0.0, Random random = Random(1)) {
  RangeImage image(camera.rows, camera.columns);
  for (int cell = 0; cell < image.size(); ++cell) {
    const Eigen::Vector3d ray = camera.ray(cell / camera.columns, cell % camera.columns);
    double nearest = 1e300;
    for (const Rectangle& r : rectangles) {
      const Eigen::Vector3d normal = r.a.cross(r.b);
      const double z = normal.dot(r.corner) / normal.dot(ray);
      const Eigen::Vector3d inside = z * ray - r.corner;
      const double s = inside.dot(r.a) / r.a.squaredNorm();
      const double t = inside.dot(r.b) / r.b.squaredNorm();
      if (z > 0 && s >= 0 && s <= 1 && t >= 0 && t <= 1) nearest = std::min(nearest, z);
    }
    const double error = noise * random.gaussian();
    if (nearest < 1e300) image[cell] = ((nearest + error) * ray).cast<float>();
  }
  return image;
}

}  // namespace foresight::test
