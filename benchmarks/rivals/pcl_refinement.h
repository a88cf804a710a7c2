// PCL's ICP, point to plane, of model points to the points of one scene. Includes no PCL.
#pragma once

#include <memory>

#include "benchmarks/rivals/oriented_points.h"

namespace foresight {

struct PclRefinementOptions {
  double spacing = 3.0;        // of the scene's points. Unit: mm. Limit: > 0.
  double far_distance = 10.0;  // correspondences in the first round, and
  double near_distance = 4.0;  // in the second are no farther. Unit: mm. Limit: > 0.
  int iterations = 12;         // a round. Limit: >= 1.
};

class PclRefinement {
 public:
  explicit PclRefinement(const OrientedPoints& scene, const PclRefinementOptions& options = {});
  ~PclRefinement();
  PclRefinement(PclRefinement&&) noexcept;

  // Of the model's points those count that face the sensor at the round's start.
  [[nodiscard]] Pose refine(const OrientedPoints& model, const Pose& start) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace foresight
