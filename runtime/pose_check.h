// A first look at a pose: a hundred points of the surface against the range image, in microseconds. It puts start poses
// in order; what they are worth is decided by the evidence of every cell (pose_evidence.h) after localization.
#pragma once

#include <utility>

#include "common/memory_pool.h"
#include "common/pose.h"
#include "common/viewing_sphere.h"
#include "runtime/database.h"
#include "runtime/pose_evidence.h"

namespace foresight {

// A region that data on a face belong to.
struct FaceSupport {
  int region = 0;
  int face = 0;
  double cells = 0.0;  // how many of the region's, as estimated from samples
};

// Cells that would show the object, estimated from samples; compare PoseEvidence.
struct PoseCheck {
  double total = 0.0;
  double explained = 0.0;
  double owned = 0.0;
  double contradicted = 0.0;  // behind or tilted
  double hidden = 0.0;
  PoolVector<FaceSupport> supports;

  // Owned less contradicted cells as a share of all, with a doubt that outweighs a handful; at most 1.
  [[nodiscard]] double quality() const;
};

struct PoseCheckOptions {
  int samples = 96;       // about as many of the points in sight
  double distance = 8.0;  // of data that agree. Unit: mm.
  double normal_cosine = 0.87;
};

// Not for several threads at once: it learns the samples of each aspect as it goes.
class PoseChecker {
 public:
  PoseChecker(const Database& database, const LabelledScan& scan, const PoseCheckOptions& options = {});

  // A pose of which the first samples show that its quality hardly reaches `least_quality` is looked at no further:
  // what is counted then is what they showed.
  [[nodiscard]] PoseCheck check(int model, const Pose& T_sensor_model, double least_quality = kAnyQuality);

  static constexpr double kAnyQuality = -1.0;

 private:
  struct Sample {
    Eigen::Vector3f position;  // model frame. Unit: mm.
    int face = 0;              // its place in the aspect
    float area = 0.0F;         // that it stands for. Unit: mm^2.
  };
  // A face at the pose looked at.
  struct PosedFace {
    Eigen::Vector3f normal;  // sensor frame
    float height = 0.0F;     // of the camera over its plane. Unit: mm.
  };
  // Template points of a face: those in its middle, and those on its edges.
  struct FacePoints {
    PoolVector<int> middle;
    PoolVector<int> edge;
  };
  const PoolVector<FacePoints>& points_of(int model);
  const PoolVector<Sample>& samples_of(int model, int aspect);
  [[nodiscard]] PoolVector<Sample> choose_samples(int model, const std::vector<int>& faces);
  void pose_faces(const CompiledModel& model, const std::vector<int>& faces, const Pose& T_sensor_model);
  void look_at(const Sample& sample, const Eigen::Vector3f& point, int face, PoseCheck& check);

  const Database& database_;
  const LabelledScan& scan_;
  PoseCheckOptions options_;
  ViewingSphere sphere_{kAspectCells};
  float squared_least_cosine_ = 0.0F;
  PoolVector<PoolVector<FacePoints>> points_;                 // by model and face, once asked for
  PoolMap<std::pair<int, int>, PoolVector<Sample>> samples_;  // by model and aspect
  PoolVector<double> of_region_;                              // scratch: explained cells
  PoolVector<PosedFace> posed_;                               // scratch: the faces of the aspect
};

// The pose moved so that the planes of its faces lie in those of the regions that support them: least squares over
// planes, weighted by their cells; directions that no plane decides stay as they are. Regions of which the object
// explains less than a third take no part.
[[nodiscard]] Pose refit_to_planes(const CompiledModel& model, const Pose& T_sensor_model, const PoseCheck& check,
                                   const PoolVector<DescribedRegion>& regions);

}  // namespace foresight
