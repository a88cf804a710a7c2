// Real depth-camera frames of cartons on a pallet, with a mask for each instance of some and no poses (boxes/ of the
// data folder).
#pragma once

#include <string>
#include <vector>

#include "common/camera.h"
#include "common/range_image.h"
#include "common/region_attributes.h"
#include "compiler/cad_model.h"

namespace foresight {

// The cells of one box in one frame.
struct BoxMask {
  std::string name;        // "small_box 3"
  int object = 0;          // index into the models
  std::vector<int> cells;  // ascending
  DescribedRegion top;     // the plane that most of the mask lies on, and the cells that lie on it
  double visible = 0.0;    // area of the mask's data on that plane / the model's largest face; above 1 with side faces
};

struct BoxFrame {
  std::string name;
  RangeImage image;
  std::vector<BoxMask> masks;  // ascending in the values of the mask image
};

// A mask's plane by random sampling (deterministic): most cells within `reach` mm of it. REQUIRES: 3 cells with data.
[[nodiscard]] BoxMask describe_mask(std::vector<int> cells, const CadModel& model, const RangeImage& image,
                                    const PinholeCamera& camera, double reach = 8.0);

// Whether the folder holds them; says on the terminal that `experiment` is skipped where it does not.
[[nodiscard]] bool has_box_frames(const std::string& folder, const std::string& experiment);

// The two frames of `boxes`, pallet_0 with masks of small boxes and pallet_1 with masks of medium ones. The depth
// images come without a camera: it is the sensor's. Throws InputError: a file that read_grey_png refuses, one of
// another size than the camera's, a mask of fewer than 3 data points, models of other names.
[[nodiscard]] std::vector<BoxFrame> read_box_frames(const std::string& boxes, const std::vector<CadModel>& models,
                                                    const PinholeCamera& camera);

}  // namespace foresight
