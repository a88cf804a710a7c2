// Whatever recognizes objects in a scan: this project's method or a rival.
#pragma once

#include <functional>
#include <string>

#include "common/camera.h"
#include "common/range_image.h"
#include "runtime/foresight.h"

namespace foresight {

struct Contestant {
  std::string name;
  std::function<RecognitionResult(const RangeImage&, const PinholeCamera&)> recognize;
};

}  // namespace foresight
