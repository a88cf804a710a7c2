#include "common/scan_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/scan_format.h"

namespace foresight {
namespace {

// No range finder of the kind measures nearer or farther; a scan beyond was read in the wrong unit.
constexpr float kNearestDepth = 10.0F;      // mm
constexpr float kFarthestDepth = 100.0e3F;  // mm

Scan read_depth_scan(const std::string& file, std::string_view bytes, const ScanReadOptions& options) {
  if (options.camera_file.empty()) {
    throw InputError(file, "a depth PNG does not say how its camera projects",
                     "give the camera file with --camera (BOP camera.json or scene_camera.json)");
  }
  const scan_format::GreyImage depth = scan_format::decode_grey_png(file, bytes);
  if (depth.bits != 16) throw InputError(file, "an 8-bit PNG is no depth image", "give a 16-bit grey PNG of depths");
  scan_format::check_grid(file, depth.columns, depth.rows);
  DepthCamera stated = options.camera ? *options.camera : read_depth_camera(options.camera_file, file);
  PinholeCamera& camera = stated.camera;
  // The grid is a fact; a camera for another grid has other intrinsics too.
  if ((camera.columns != 0 && camera.columns != depth.columns) || (camera.rows != 0 && camera.rows != depth.rows)) {
    throw InputError(options.camera_file,
                     "it is for " + std::to_string(camera.columns) + "x" + std::to_string(camera.rows) +
                         " cells, but the scan has " + std::to_string(depth.columns) + "x" + std::to_string(depth.rows),
                     "give the camera that took " + file);
  }
  camera.rows = depth.rows;
  camera.columns = depth.columns;
  RangeImage image(depth.rows, depth.columns);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const int cell = image.cell(row, column);
      const double z = depth.values[static_cast<std::size_t>(cell)] * stated.depth_scale;
      const Eigen::Vector3d point = camera.ray(row, column) * z;
      image[cell] = scan_format::cell_point(point.x(), point.y(), point.z());
    }
  }
  return {std::move(image), camera};
}

RangeImage read_points(const std::string& file, std::string_view bytes, const ScanReadOptions& options) {
  const bool pcd = scan_format::is_pcd(bytes);
  if (!pcd && !scan_format::is_ply(bytes)) {
    throw InputError(file, "is neither a PCD, a PLY nor a PNG file", "convert the scan to one of these");
  }
  if (!options.camera_file.empty()) {
    throw InputError(file, "a camera file was given for a scan that holds its own points",
                     "leave out --camera; it belongs to depth PNGs only");
  }
  return pcd ? scan_format::read_pcd(file, bytes, options.unit_mm)
             : scan_format::read_ply(file, bytes, options.unit_mm);
}

void check_depths(const std::string& file, const RangeImage& image, const ScanReadOptions& options) {
  float nearest = std::numeric_limits<float>::infinity();
  for (const Eigen::Vector3f& point : image.points) {
    if (point.z() < nearest) nearest = point.z();  // false for NaN
  }
  if (!std::isfinite(nearest)) {
    throw InputError(file, "no cell holds a valid point",
                     "check the sensor's output; depths must be positive along z, away from the sensor");
  }
  if (nearest >= kNearestDepth && nearest <= kFarthestDepth) return;
  const bool small = nearest < kNearestDepth;
  const std::string mend =
      !options.camera_file.empty() ? "correct depth_scale (mm per count) in " + options.camera_file
      : small ? "name the file's unit with --scan-unit, for instance m; drop stray points at the sensor"
              : "name the file's unit with --scan-unit, for instance mm";
  throw InputError(file,
                   "its nearest point is " + std::to_string(nearest) + " mm away, " +
                       (small ? "nearer than 10 mm" : "farther than 100 m"),
                   mend);
}

}  // namespace

Scan read_scan(const std::string& file, const ScanReadOptions& options) {
  if (!std::isfinite(options.unit_mm) || !(options.unit_mm > 0.0)) {
    throw UsageError("--scan-unit", "a unit of " + std::to_string(options.unit_mm) + " mm", "give a unit above 0 mm");
  }
  const std::string bytes = read_whole_file(file);
  if (bytes.empty()) throw InputError(file, "is empty", "record or copy the scan again");
  Scan scan;
  if (scan_format::is_png(bytes)) {
    scan = read_depth_scan(file, bytes, options);
  } else {
    scan.image = read_points(file, bytes, options);
  }
  check_depths(file, scan.image, options);
  return scan;
}

}  // namespace foresight
