// Scene folders of the BOP benchmark (github.com/thodan/bop_toolkit, docs/bop_datasets_format.md): depth/NNNNNN.png,
// and scene_camera.json with the camera of each.
#pragma once

#include <string>
#include <vector>

#include "common/scan_file.h"

namespace foresight {

struct SceneImage {
  std::string file;         // the folder as given, with depth/NNNNNN.png
  std::string camera_file;  // its scene_camera.json
  DepthCamera camera;
};

// The images of a scene by their numbers. Cameras without an image are passed over. A folder that names itself by dots
// (".", "..") gets its real name, which holds the scene's number. Throws InputError: no scene_camera.json or one that
// cannot be used, no folder depth or no PNG in it, an image without number or camera, two with one number.
[[nodiscard]] std::vector<SceneImage> read_bop_scene(const std::string& folder);

}  // namespace foresight
