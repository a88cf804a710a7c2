#include "common/bop_scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/errors.h"
#include "tests/support.h"

namespace foresight {
namespace {

namespace fs = std::filesystem;

std::string entry(double fx, double depth_scale) {
  return R"({"cam_K":[)" + std::to_string(fx) + R"(,0,127.5,0,700,119.5,0,0,1],"depth_scale":)" +
         std::to_string(depth_scale) + "}";
}

// A scene 000048 with two images of a plane, of different cameras, and a camera without an image.
struct Folder {
  test::TemporaryFolder folder;
  std::string scene = folder.file("000048");

  Folder() {
    fs::create_directories(scene + "/depth");
    write_cameras("{\"3\":" + entry(700.0, 0.1) + ",\"12\":" + entry(900.0, 0.5) + ",\"77\":" + entry(1.0, 1.0) + "}");
    RangeImage image(40, 50);
    for (int cell = 0; cell < image.size(); ++cell) image[cell] = {0.0F, 0.0F, 1000.0F};
    write_depth_png(scene + "/depth/000012.png", image, 0.5);
    write_depth_png(scene + "/depth/000003.png", image, 0.1);
  }
  void write_cameras(const std::string& text) const { std::ofstream(scene + "/scene_camera.json") << text; }
  void expect_refused(const std::string& file, const std::string& words) const {
    try {
      (void)read_bop_scene(scene);
      ADD_FAILURE() << "took what it should refuse: " << words;
    } catch (const InputError& error) {
      EXPECT_EQ(error.file(), file);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
};

TEST(BopScene, lists_its_images_by_number_each_with_its_own_camera) {
  const Folder made;
  const std::vector<SceneImage> images = read_bop_scene(made.scene);
  ASSERT_EQ(images.size(), 2U);  // the camera without an image is passed over
  EXPECT_EQ(images[0].file, made.scene + "/depth/000003.png");
  EXPECT_EQ(images[1].file, made.scene + "/depth/000012.png");
  EXPECT_EQ(images[0].camera.camera.fx, 700.0);
  EXPECT_EQ(images[1].camera.camera.fx, 900.0);
  for (const SceneImage& image : images) {
    const Scan scan = read_scan(image.file, {image.camera_file, 1.0, image.camera});
    EXPECT_EQ(scan.camera->fx, image.camera.camera.fx);
    EXPECT_EQ(scan.image[0].z(), 1000.0F);  // each with its depth_scale
    const Scan alone = read_scan(image.file, {image.camera_file});
    EXPECT_EQ(alone.camera, scan.camera);
  }
}

TEST(BopScene, keeps_its_number_however_it_is_called) {
  const Folder made;
  EXPECT_EQ(read_bop_scene(made.scene + "//")[0].file, made.scene + "/depth/000003.png");
  const fs::path real = fs::canonical(made.scene);
  EXPECT_EQ(read_bop_scene(made.scene + "/depth/..")[0].file, (real / "depth/000003.png").string());
  const fs::path before = fs::current_path();
  fs::current_path(made.scene);
  EXPECT_EQ(read_bop_scene(".")[0].file, (real / "depth/000003.png").string());
  fs::current_path(before);
}

TEST(BopScene, passes_over_other_files) {
  const Folder made;
  std::ofstream(made.scene + "/depth/notes.txt") << "1";
  std::ofstream(made.scene + "/scene_gt.json") << "{}";
  EXPECT_EQ(read_bop_scene(made.scene).size(), 2U);
}

TEST(BopScene, refuses_folders_that_are_none) {
  const Folder made;
  fs::remove(made.scene + "/scene_camera.json");
  made.expect_refused(made.scene, "a folder without scene_camera.json; give a scan file, or a BOP scene folder");
  const Folder without_depth;
  fs::remove_all(without_depth.scene + "/depth");
  without_depth.expect_refused(without_depth.scene, "without a folder depth");
  fs::create_directory(without_depth.scene + "/depth");
  without_depth.expect_refused(without_depth.scene + "/depth", "holds no PNG");
}

TEST(BopScene, refuses_images_without_a_number_or_a_camera) {
  const Folder made;
  const std::string cameras = made.scene + "/scene_camera.json";
  fs::rename(made.scene + "/depth/000012.png", made.scene + "/depth/000013.png");
  made.expect_refused(cameras, "has no entry for " + made.scene + "/depth/000013.png; add the camera of image 13");
  fs::rename(made.scene + "/depth/000013.png", made.scene + "/depth/last.png");
  made.expect_refused(made.scene + "/depth/last.png", "no image number");
  fs::rename(made.scene + "/depth/last.png", made.scene + "/depth/3.png");
  made.expect_refused(made.scene + "/depth/3.png", "has the number of");
}

TEST(BopScene, refuses_cameras_that_cannot_be_used) {
  const Folder made;
  const std::string cameras = made.scene + "/scene_camera.json";
  const auto refused = [&](const std::string& text, const std::string& words, const std::string& where = "") {
    made.write_cameras(text);
    made.expect_refused(cameras + where, words);
  };
  refused("", "is not JSON");
  refused("{\"3\":", "is not JSON");
  refused("{}", "holds no cameras");
  refused("[1]", "holds no cameras");
  refused("{\"x\":" + entry(700, 1) + "}", "entry 'x' is no image number");
  refused("{\"-3\":" + entry(700, 1) + "}", "is no image number");
  refused("{\"3\":7}", "is no image number with a camera");
  refused("{\"3\":" + entry(700, 1) + ",\"03\":" + entry(700, 1) + "}", "two entries are for image 3");
  refused("{\"3\":{\"cam_K\":[700,0,1,0,700,1,0,0,1]}}", "has no depth_scale", ", entry 3");
  refused("{\"3\":{\"depth_scale\":1}}", "has no fx", ", entry 3");
  refused("{\"3\":{\"cam_K\":[1,2],\"depth_scale\":1}}", "cam_K is not nine numbers", ", entry 3");
  refused("{\"3\":" + entry(700, 0) + "}", "depth_scale is not above 0", ", entry 3");
  refused("{\"3\":" + entry(-1, 1) + "}", "fx or fy is not above 0", ", entry 3");
  fs::remove(cameras);
  fs::create_directory(cameras);
  made.expect_refused(cameras, "is a folder");
}

}  // namespace
}  // namespace foresight
