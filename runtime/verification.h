// Is the object there? The matched, coherent and occluding fractions of Section V.C.
#pragma once

#include <vector>

#include "common/camera.h"
#include "common/compiled_model.h"
#include "common/pose.h"
#include "common/range_image.h"
#include "common/viewing_sphere.h"
#include "runtime/nearest_data.h"

namespace foresight {

struct VerificationOptions {
  double match_distance = 4.0;       // 2 sigma: a nearer template point is matched. Unit: mm. Limit: > 0.
  double smallest_matched = 0.5;     // alpha. Limit: 0 to 1.
  double smallest_coherent = 0.4;    // beta. Limit: 0 to 1.
  double largest_occluding = 0.175;  // gamma. Limit: 0 to 1.
};

struct Verification {
  int visible = 0;         // |V(q)|
  double matched = 0.0;    // alpha = |M(q)| / |V(q)|
  double coherent = 0.0;   // beta, over the visible neighbours of every visible point
  double occluding = 0.0;  // gamma = |Occ(q)| / |V(q)|; a point occludes when the data point in its cell is farther by
                           // more than match_distance
  bool accepted = false;
};

// sphere: ViewingSphere(80). camera: of the image. With no visible point nothing is accepted.
[[nodiscard]] Verification verify(const CompiledModel& model, const ViewingSphere& sphere, const Pose& T_sensor_model,
                                  const RangeImage& image, const PinholeCamera& camera, const NearestData& data,
                                  const VerificationOptions& options);

}  // namespace foresight
