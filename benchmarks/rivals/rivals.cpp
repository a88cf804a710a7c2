#include "benchmarks/rivals/rivals.h"

#include <cassert>

#include "benchmarks/rivals/make_rivals.h"

namespace foresight {

std::vector<std::string> rival_names() { return {"pcl-ppf", "pcl-fpfh", "opencv-ppf"}; }

Contestant make_rival(const std::string& name, const std::vector<CadModel>& models, const SensorModel& sensor) {
  if (name == "pcl-ppf") return make_pcl_ppf(models, sensor);
  if (name == "pcl-fpfh") return make_pcl_fpfh(models, sensor);
  assert(name == "opencv-ppf");
  return make_opencv_ppf(models, sensor);
}

}  // namespace foresight
