#include "benchmarks/box_scans.h"

#include <algorithm>
#include <map>

#include "benchmarks/real_scans.h"
#include "common/errors.h"
#include "common/plane_fit.h"
#include "common/random.h"
#include "common/scan_file.h"

namespace foresight {
namespace {

// Which mask image belongs to which frame, and what it shows.
struct FrameFiles {
  const char* frame;
  const char* object;
};
constexpr FrameFiles kFrames[] = {{"pallet_0", "small_box"}, {"pallet_1", "medium_box"}};

std::vector<int> near_plane(const std::vector<int>& cells, const RangeImage& image, const Plane& plane, double reach) {
  std::vector<int> near;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(near),
               [&](int cell) { return std::abs(plane.distance(image[cell].cast<double>())) <= reach; });
  return near;
}

Plane fit_plane(const std::vector<int>& cells, const RangeImage& image) {
  PointSums sums;
  for (const int cell : cells) sums.add(image[cell].cast<double>());
  return sums.fit();
}

// The cells of the plane that most cells lie on. Masks reach over edges, so that a plane through all cells is none.
std::vector<int> most_common_plane(const std::vector<int>& cells, const RangeImage& image, double reach) {
  constexpr int kDraws = 200;  // of three cells; a plane with half the cells is missed once in 10^11 masks
  constexpr int kRefits = 3;
  Random random(1);
  const auto any = [&] {
    return cells[static_cast<std::size_t>(random.integer(0, static_cast<int>(cells.size()) - 1))];
  };
  std::vector<int> best = cells;
  std::size_t most = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const std::vector<int> three = {any(), any(), any()};
    std::vector<int> near = near_plane(cells, image, fit_plane(three, image), reach);
    if (near.size() <= most) continue;
    most = near.size();
    best = std::move(near);
  }
  for (int refit = 0; refit < kRefits; ++refit) {
    std::vector<int> near = near_plane(cells, image, fit_plane(best, image), reach);
    if (near.size() >= 3) best = std::move(near);
  }
  return best;
}

double largest_face(const CadModel& model) {
  double area = 0.0;
  for (const CadFace& face : model.faces) area = std::max(area, face.area);
  return area;
}

// A mask's or a depth image's values by cell, of the camera's size.
std::vector<int> read_image(const std::string& file, const PinholeCamera& camera) {
  int rows = 0, columns = 0;
  std::vector<int> values = read_grey_png(file, rows, columns);
  if (rows != camera.rows || columns != camera.columns)
    throw InputError(file, "it has another size than the sensor's camera", "give a sensor of that size with --sensor");
  return values;
}

RangeImage read_depth(const std::string& file, const PinholeCamera& camera) {
  const std::vector<int> millimetres = read_image(file, camera);
  RangeImage image(camera.rows, camera.columns);
  for (int cell = 0; cell < image.size(); ++cell) {
    const int depth = millimetres[static_cast<std::size_t>(cell)];
    if (depth > 0) image[cell] = (depth * camera.ray(cell / image.columns, cell % image.columns)).cast<float>();
  }
  return image;
}

}  // namespace

BoxMask describe_mask(std::vector<int> cells, const CadModel& model, const RangeImage& image,
                      const PinholeCamera& camera, double reach) {
  BoxMask mask;
  std::vector<int> with_data;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(with_data), [&](int cell) { return image.valid(cell); });
  std::vector<int> top = most_common_plane(with_data, image, reach);
  const Plane plane = fit_plane(top, image);
  const auto on_plane = [&](const std::vector<int>& chosen) {
    return describe({{chosen.begin(), chosen.end()}, plane.normal, plane.offset, 0.0}, image, camera);
  };
  mask.visible = on_plane(with_data).attributes[kArea] / largest_face(model);
  mask.top = on_plane(std::move(top));
  mask.cells = std::move(cells);
  return mask;
}

bool has_box_frames(const std::string& folder, const std::string& experiment) {
  return has_data_file(folder, "boxes/scans/pallet_0.png", experiment);
}

std::vector<BoxFrame> read_box_frames(const std::string& boxes, const std::vector<CadModel>& models,
                                      const PinholeCamera& camera) {
  std::vector<BoxFrame> frames;
  for (const FrameFiles& files : kFrames) {
    const std::string object = files.object;
    const auto model = std::find_if(models.begin(), models.end(), [&](const CadModel& m) { return m.name == object; });
    const std::string mask_file = boxes + "/masks/" + files.frame + "_" + object + ".png";
    if (model == models.end())
      throw InputError(mask_file, "its boxes are no model's", "give the model " + object + " with --cad");
    BoxFrame& frame = frames.emplace_back();
    frame.name = files.frame;
    frame.image = read_depth(boxes + "/scans/" + frame.name + ".png", camera);
    std::map<int, std::vector<int>> cells;
    const std::vector<int> values = read_image(mask_file, camera);
    for (int cell = 0; cell < frame.image.size(); ++cell) {
      if (values[static_cast<std::size_t>(cell)] > 0) cells[values[static_cast<std::size_t>(cell)]].push_back(cell);
    }
    for (auto& [value, of_mask] : cells) {
      const std::string name = object + " " + std::to_string(value);
      if (std::count_if(of_mask.begin(), of_mask.end(), [&](int cell) { return frame.image.valid(cell); }) < 3)
        throw InputError(mask_file, "the mask " + name + " shows no surface", "give the masks that belong to the scan");
      BoxMask& mask = frame.masks.emplace_back(describe_mask(std::move(of_mask), *model, frame.image, camera));
      mask.name = name;
      mask.object = static_cast<int>(model - models.begin());
    }
  }
  return frames;
}

}  // namespace foresight
