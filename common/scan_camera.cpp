// The camera files of the BOP benchmark: github.com/thodan/bop_toolkit, docs/bop_datasets_format.md.
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/scan_file.h"
#include "common/scan_format.h"

namespace foresight {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMend = "write it as BOP's camera.json: fx, fy, cx, cy (cells) and depth_scale (mm per count)";

double number(const std::string& file, const Json& camera, const char* key) {
  const auto value = camera.find(key);
  if (value == camera.end()) throw InputError(file, std::string("the camera has no ") + key, kMend);
  if (!value->is_number() || !std::isfinite(value->get<double>())) {
    throw InputError(file, std::string("the camera's ") + key + " is no number", kMend);
  }
  return value->get<double>();
}

double positive(const std::string& file, const Json& camera, const char* key) {
  const double value = number(file, camera, key);
  if (!(value > 0.0)) throw InputError(file, std::string("the camera's ") + key + " is not above 0", kMend);
  return value;
}

// 0 when not stated.
int side(const std::string& file, const Json& camera, const char* key) {
  const auto value = camera.find(key);
  if (value == camera.end()) return 0;
  const bool fits = value->is_number_integer() && *value >= 1 && *value <= kLargestImageSide;
  if (!fits) throw InputError(file, std::string("the camera's ") + key + " is no whole number from 1 to 4096", kMend);
  return value->get<int>();
}

// cam_K, row by row: fx 0 cx 0 fy cy 0 0 1.
void read_matrix(const std::string& file, const Json& matrix, PinholeCamera& camera) {
  bool usable = matrix.is_array() && matrix.size() == 9;
  for (std::size_t i = 0; usable && i < 9; ++i)
    usable = matrix[i].is_number() && std::isfinite(matrix[i].get<double>());
  if (!usable) throw InputError(file, "the camera's cam_K is not nine numbers", kMend);
  const auto k = [&](std::size_t i) { return matrix[i].get<double>(); };
  if (k(1) != 0.0 || k(3) != 0.0 || k(6) != 0.0 || k(7) != 0.0 || k(8) != 1.0) {
    throw InputError(file, "the camera's cam_K is not fx 0 cx 0 fy cy 0 0 1; skew is not known here",
                     "rectify the scan to a camera without skew");
  }
  if (!(k(0) > 0.0) || !(k(4) > 0.0)) throw InputError(file, "the camera's fx or fy is not above 0", kMend);
  camera.fx = k(0);
  camera.fy = k(4);
  camera.cx = k(2);
  camera.cy = k(5);
}

bool is_camera(const Json& json) {
  return json.contains("cam_K") || json.contains("fx") || json.contains("depth_scale");
}

// The camera itself, or the scan's entry of a scene_camera.json.
const Json& find_camera(const std::string& file, const Json& json, const std::string& scan_file) {
  if (!json.is_object() || json.empty()) throw InputError(file, "it holds no camera", kMend);
  if (is_camera(json)) return json;
  const auto wanted = scan_format::image_number(scan_file);
  for (const auto& [key, entry] : json.items()) {
    std::uint64_t value = 0;
    if (wanted && scan_format::parse(key, value) && value == *wanted && entry.is_object()) return entry;
  }
  if (json.size() == 1 && json.front().is_object()) return json.front();
  throw InputError(file, "it holds no camera for " + scan_file,
                   "name the scan after its entry, for instance 000012.png, or give a camera.json with fx, fy, cx, cy");
}

Json parse_file(const std::string& file) {
  Json json = Json::parse(read_whole_file(file), nullptr, false);
  if (json.is_discarded()) throw InputError(file, "is not JSON", kMend);
  return json;
}

// file: for messages; with the entry where there are several.
DepthCamera to_camera(const std::string& file, const Json& stated) {
  DepthCamera result;
  PinholeCamera& camera = result.camera;
  if (stated.contains("cam_K")) {
    read_matrix(file, stated["cam_K"], camera);
  } else {
    camera.fx = positive(file, stated, "fx");
    camera.fy = positive(file, stated, "fy");
    camera.cx = number(file, stated, "cx");
    camera.cy = number(file, stated, "cy");
  }
  result.depth_scale = positive(file, stated, "depth_scale");
  camera.columns = side(file, stated, "width");
  camera.rows = side(file, stated, "height");
  return result;
}

}  // namespace

std::optional<std::uint64_t> scan_format::image_number(const std::string& scan_file) {
  std::string name = scan_file.substr(scan_file.rfind('/') + 1);
  name = name.substr(0, name.rfind('.'));
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t end = name.size();
  while (end > 0 && !digit(name[end - 1])) --end;
  std::size_t start = end;
  while (start > 0 && digit(name[start - 1])) --start;
  std::uint64_t value = 0;
  if (!scan_format::parse(std::string_view(name).substr(start, end - start), value)) return std::nullopt;
  return value;
}

DepthCamera read_depth_camera(const std::string& file, const std::string& scan_file) {
  const Json json = parse_file(file);
  return to_camera(file, find_camera(file, json, scan_file));
}

std::map<std::uint64_t, DepthCamera> read_scene_cameras(const std::string& file) {
  constexpr const char* kMendEntries =
      "write it as BOP's scene_camera.json: image numbers, each with cam_K and depth_scale";
  const Json json = parse_file(file);
  if (!json.is_object() || json.empty()) throw InputError(file, "it holds no cameras", kMendEntries);
  std::map<std::uint64_t, DepthCamera> cameras;
  for (const auto& [key, entry] : json.items()) {
    std::uint64_t number = 0;
    if (!scan_format::parse(key, number) || !entry.is_object()) {
      throw InputError(file, "its entry " + scan_format::quoted(key) + " is no image number with a camera",
                       kMendEntries);
    }
    if (!cameras.try_emplace(number, to_camera(file + ", entry " + key, entry)).second) {
      throw InputError(file, "two entries are for image " + std::to_string(number), kMendEntries);
    }
  }
  return cameras;
}

void write_camera_json(const std::string& file, const PinholeCamera& camera, double depth_scale) {
  const bool usable = std::isfinite(camera.fx) && camera.fx > 0.0 && std::isfinite(camera.fy) && camera.fy > 0.0 &&
                      std::isfinite(camera.cx) && std::isfinite(camera.cy) && std::isfinite(depth_scale) &&
                      depth_scale > 0.0;
  if (!usable) throw InputError(file, "a camera with fx, fy or depth_scale not above 0", "give a usable camera");
  Json json = {
      {"cx", camera.cx}, {"cy", camera.cy}, {"depth_scale", depth_scale}, {"fx", camera.fx}, {"fy", camera.fy}};
  if (camera.rows > 0) json["height"] = camera.rows;
  if (camera.columns > 0) json["width"] = camera.columns;
  write_file_atomically(file, json.dump(1) + "\n");
}

}  // namespace foresight
