#include "common/bop_scene.h"

#include <algorithm>
#include <filesystem>

#include "common/errors.h"
#include "common/scan_format.h"

namespace foresight {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMend = "give a scan file, or a BOP scene folder: scene_camera.json and depth/*.png";

// Without slashes at its end; by its real name where it is called by dots.
std::string named(const std::string& folder) {
  fs::path path(folder);
  while (path.has_relative_path() && !path.has_filename()) path = path.parent_path();
  if (path.filename() != "." && path.filename() != "..") return path.string();
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  return error ? path.string() : real.string();
}

std::vector<std::string> depth_images(const std::string& folder) {
  const std::string depth = folder + "/depth";
  std::error_code error;
  if (!fs::is_directory(depth, error)) throw InputError(folder, "is a folder without a folder depth", kMend);
  std::vector<std::string> files;
  fs::directory_iterator entry(depth, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() == ".png") files.push_back(depth + "/" + entry->path().filename().string());
  }
  if (error) throw InputError(depth, "cannot be read: " + error.message(), "check who may read the folder");
  if (files.empty())
    throw InputError(depth, "holds no PNG", "put the scene's depth images there, 000000.png and so on");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<SceneImage> read_bop_scene(const std::string& folder) {
  const std::string scene = named(folder);
  const std::string camera_file = scene + "/scene_camera.json";
  std::error_code error;
  if (!fs::exists(camera_file, error)) throw InputError(folder, "is a folder without scene_camera.json", kMend);
  const auto cameras = read_scene_cameras(camera_file);
  std::map<std::uint64_t, SceneImage> images;
  for (const std::string& file : depth_images(scene)) {
    const auto number = scan_format::image_number(file);
    if (!number)
      throw InputError(file, "its name holds no image number", "name it as BOP does, for instance 000012.png");
    const auto camera = cameras.find(*number);
    if (camera == cameras.end()) {
      throw InputError(camera_file, "has no entry for " + file, "add the camera of image " + std::to_string(*number));
    }
    const auto [at, added] = images.try_emplace(*number, SceneImage{file, camera_file, camera->second});
    if (!added) {
      throw InputError(file, "has the number of " + at->second.file, "keep one image of each number in the folder");
    }
  }
  std::vector<SceneImage> in_order;
  for (auto& [number, image] : images) in_order.push_back(std::move(image));
  return in_order;
}

}  // namespace foresight
