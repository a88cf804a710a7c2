// Scans on disk: organized PCD, PLY with a grid, and 16-bit depth PNG beside a camera file.
// This library needs libpng, liblzf and nlohmann-json; only programs link it, never the runtime library.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/camera.h"
#include "common/range_image.h"

namespace foresight {

// A depth camera as BOP writes it: camera.json (fx, fy, cx, cy, depth_scale, optional width and height) or one entry of
// scene_camera.json (cam_K without skew, depth_scale; the entry's key is the image number in the scan's file name, the
// only entry otherwise). depth_mm = value * depth_scale.
struct DepthCamera {
  PinholeCamera camera;      // rows and columns 0 where the file does not state them
  double depth_scale = 1.0;  // Unit: mm per count. Limit: > 0.
};

struct ScanReadOptions {
  std::string camera_file;  // for PNG: camera JSON, see read_depth_camera; required there, an error elsewhere
  double unit_mm = 1.0;     // length of one unit of a PCD or PLY file. Unit: mm. Limit: > 0.
  std::optional<DepthCamera> camera = {};  // what camera_file says, where it has been read already
};

// A scan with the camera its file states; PCD and PLY state none (fit_camera finds it).
struct Scan {
  RangeImage image;
  std::optional<PinholeCamera> camera;
};

// Format by content, not by name. A cell whose point is not finite or not in front of the sensor (z <= 0) is invalid.
// Points are taken to be in the sensor frame: a PCD VIEWPOINT is not applied. A PNG's own grid counts. Throws
// InputError: missing, empty, truncated, foreign or unorganized file, a grid outside 32x32 to 4096x4096, no valid cell
// at all, or a unit that cannot be right (the nearest depth below 10 mm or above 100 m).
[[nodiscard]] Scan read_scan(const std::string& file, const ScanReadOptions& options = {});

[[nodiscard]] DepthCamera read_depth_camera(const std::string& file, const std::string& scan_file);

// All entries of a scene_camera.json by image number; each must be a camera.
[[nodiscard]] std::map<std::uint64_t, DepthCamera> read_scene_cameras(const std::string& file);

enum class PcdEncoding { ascii, binary, binary_compressed };
// Organized PCD 0.7, fields x y z (float), invalid cells NaN. Unit: mm. Written whole or not at all.
void write_pcd(const std::string& file, const RangeImage& image, PcdEncoding encoding = PcdEncoding::binary);

// 16-bit depth PNG, and the camera.json that belongs to it. 0 = invalid; depths beyond 65535 * depth_scale, or so small
// that they would become 0, are an InputError.
void write_depth_png(const std::string& file, const RangeImage& image, double depth_scale);
void write_camera_json(const std::string& file, const PinholeCamera& camera, double depth_scale);

// Label image, 8-bit when every label fits, else 16-bit grey. labels: rows*columns, each in 0..65535.
void write_label_png(const std::string& file, int rows, int columns, std::span<const int> labels);

// Pictures for eyes: 8-bit RGB, three bytes a pixel, row by row.
void write_rgb_png(const std::string& file, int rows, int columns, const std::vector<unsigned char>& rgb);

// 8- or 16-bit grey PNG as integers (label images, masks). Sets rows and columns.
[[nodiscard]] std::vector<int> read_grey_png(const std::string& file, int& rows, int& columns);

}  // namespace foresight
