// Other people's recognizers, each built into a full chain as a competent user would: from CAD models and a range image
// to objects with poses.
//
// - pcl-ppf: PCL's PPFEstimation, PPFHashMapSearch and PPFRegistration (Drost et al., CVPR 2010), then ICP, point to
//   plane;
// - pcl-fpfh: PCL's FPFHEstimation and SampleConsensusPrerejective (Buch et al., ICRA 2013), then ICP, point to plane;
// - opencv-ppf: OpenCV's surface_matching, PPF3DDetector, then its ICP.
//
// Help that all of them get from here, because the libraries leave it to their users:
//   - the model: points spread evenly over the CAD surface, with the exact outward normals;
//   - the scene: normals from the grid, towards the sensor; thinned to the spacing of the model's points;
//   - a table or backdrop, where the sensor model says that scans show one: the planes that cover much of the scan are
//     found by RANSAC and taken away (rival_scene.h);
//   - PCL's two return one pose a call: they are called for several overlapping windows of the scene, each as large as
//     the model (rival_scene.h), so that they can find an object among others, and a second chance where the first pose
//     was wrong;
//   - ICP is given only the model points that face the sensor at the pose it starts from;
//   - a decision which poses to report (rival_verification.h): without one they would report every object in every
//   scan.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/experiment.h"
#include "common/sensor_model.h"
#include "compiler/cad_model.h"

namespace foresight {

[[nodiscard]] std::vector<std::string> rival_names();

// Trains the rival on the CAD models for scans of this sensor. Its `recognize` may be called from several threads and
// returns the same for the same scan every time. verifications = poses refined by ICP and checked; milliseconds:
// extract = normals, background and thinning, hypotheses = features, voting or RANSAC, localize = ICP, verify = the
// decision. REQUIRES: name is one of rival_names().
[[nodiscard]] Contestant make_rival(const std::string& name, const std::vector<CadModel>& models,
                                    const SensorModel& sensor);

}  // namespace foresight
