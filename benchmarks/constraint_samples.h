// What the attributes of faces, and of pairs of faces, come to in sample views and in views held out from them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/truth_file.h"
#include "common/density.h"
#include "compiler/face_samples.h"

namespace foresight {

struct AttributeSamples {
  std::string name;
  std::vector<double> samples;   // of the sample views
  std::vector<double> held_out;  // of the views held out
  Density density;               // compiled from the samples; no mass where there are none
  double bin_width = 0.0;        // of all densities of this attribute in the model
  double cad_value = 0.0;
  double cad_sigma = 0.0;  // of a measurement of that value
  bool angle = false;
};

// A face of an object with its four attributes, or two faces with their two relation attributes.
struct ConstraintSubject {
  std::string object;
  std::vector<int> faces;                    // one, or two in ascending order
  std::vector<AttributeSamples> attributes;  // samples of one view stand at the same place in all

  [[nodiscard]] std::string name() const;  // "castle 3", "castle 3+7"
};

// n views of the model alone from random directions, uniform on the sphere. Apart from the viewing sphere's views: both
// directions and noise. extraction: as the scans' sensor wants it.
[[nodiscard]] std::vector<ViewSample> random_views(const CadModel& model, const SensorModel& sensor, int n,
                                                   std::uint64_t seed);

// What the regions of real scans show of each model, by their true poses: a region shows the face that most of its
// cells show when the scene is simulated. One list per model; objects hide one another in these scans.
[[nodiscard]] std::vector<std::vector<ViewSample>> measured_views(const std::vector<CadModel>& models,
                                                                  const SensorModel& sensor, const std::string& abw);

// Every face and pair of faces of the model that a sample view or a held-out view shows; faces first, both ascending.
// sensor: of the held-out views, for the spread about CAD values. density: how densities are compiled.
[[nodiscard]] std::vector<ConstraintSubject> subjects_of(const CadModel& model, const std::vector<ViewSample>& samples,
                                                         const std::vector<ViewSample>& held_out,
                                                         const SensorModel& sensor, const DensityOptions& density = {});

}  // namespace foresight
