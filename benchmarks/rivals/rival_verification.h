// Which of the poses that a rival proposes are to be reported. The libraries leave this to their users.
//
// Each point of the model's surface that faces the sensor at the pose is looked up in the cell it falls into:
//   matched       data nearby whose normal agrees
//   violating     it stands in front of the data, or on them with another normal: the sensor would have seen it
//   missing       no data, by a sensor whose scans show a background there: a shadow, which says nothing; by one whose
//                 scans show nothing behind the objects: the object is not there
//   hidden        behind the data, outside the image: nothing known
// A pose may be reported when enough of its points are matched, of those that could be and of all. Of those poses, of
// all objects, the one that explains most and contradicts least is reported; what it explains counts for no other; and
// so on, until none is left that explains enough anew.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/rivals/rival_scene.h"

namespace foresight {

struct RivalVerificationOptions {
  double distance = 3.0;          // data nearer than this along the line of sight match. Unit: mm. Limit: > 0.
  double sigmas = 4.0;            // and at least this many standard deviations of the sensor. Limit: >= 0.
  double normal_angle = 0.6;      // normals within this agree. Unit: rad. Limit: > 0.
  double smallest_share = 0.8;    // matched / (matched + violating + missing). Limit: [0, 1].
  double smallest_visible = 0.3;  // matched / facing the sensor. Limit: [0, 1].
  double smallest_new = 0.6;      // of the matched points, not explained by a pose already reported. Limit: [0, 1].
  double contradiction = 2.0;     // what a contradicting point costs in matched ones. Limit: >= 0.
};

struct PoseCandidate {
  int object = 0;
  Pose T_sensor_model;
};

struct ReportedPose {
  int candidate = 0;   // index into those given
  double share = 0.0;  // matched / (matched + violating + missing)
};

// models: the objects' points, evenly spread and of the same spacing for all; the candidates index them.
[[nodiscard]] std::vector<ReportedPose> poses_to_report(const RivalScene& scene, const SensorModel& sensor,
                                                        const std::vector<OrientedPoints>& models,
                                                        const std::vector<PoseCandidate>& candidates,
                                                        const RivalVerificationOptions& options = {});

}  // namespace foresight
