// The one place that names a version of Embree: its header and the calls whose form differs between Embree 3 and 4.
// Private to sensor_simulator.cpp.
#pragma once

#include <embree3/rtcore.h>

namespace foresight::embree {

// First hit of a ray. Single rays: a hit cannot depend on the rays cast beside it.
inline void intersect(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}

// Any hit; sets ray.tfar to -infinity when there is one.
inline void occlude(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}

}  // namespace foresight::embree
