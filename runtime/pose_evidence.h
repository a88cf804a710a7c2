// What a scan says for and against an object at a pose, cell by cell and region by region: two-way verification.
//
// Beyond the paper, whose α, β, γ ask only whether template points find data near them: any cluttered surface offers
// such data. Here the object is drawn at the pose, and the data must also not contradict it: where the sensor sees
// through the object, where regions run on beyond its faces, where its surface has another orientation.
#pragma once

#include <array>
#include <limits>

#include "common/camera.h"
#include "common/compiled_model.h"
#include "common/memory_pool.h"
#include "common/pose.h"
#include "common/range_image.h"
#include "common/region_attributes.h"
#include "common/sensor_model.h"

namespace foresight {

// A scan with its regions, as evidence for or against poses is read from it.
struct LabelledScan {
  const RangeImage& image;
  const PinholeCamera& camera;
  const SensorModel& sensor;
  const PoolVector<DescribedRegion>& regions;
  PoolVector<float> depths;    // by cell: z, NaN without data. Unit: mm.
  PoolVector<int> labels;      // by cell: 0 = no region, i + 1 = regions[i]
  PoolVector<bool> taken;      // by cell: explained by another object already, so that it contradicts this one
  PoolVector<int> free_cells;  // by region: those that are not taken
  float nearest = std::numeric_limits<float>::infinity();  // of the depths. Unit: mm.
};

// Nothing taken. The scan refers to all that is given.
[[nodiscard]] LabelledScan label_scan(const RangeImage& image, const PinholeCamera& camera, const SensorModel& sensor,
                                      const PoolVector<DescribedRegion>& regions);

// Whether other objects explain at least half of a region.
[[nodiscard]] bool is_taken(const LabelledScan& scan, int region);

// Data of a surface at its place are nearer than this to it: three standard deviations of the sensor, and what
// localization leaves. Unit: mm.
[[nodiscard]] double agreeing_distance(const SensorModel& sensor);

struct EvidenceOptions {
  double distance = 4.0;        // data this near to the drawn surface, across it, agree. Unit: mm.
  double normal_cosine = 0.87;  // of a region's normal with that of the surface it lies on. 30 degrees.
  // Of so many rows, and of so many columns, one is looked at, and its cells stand for the others. Limit: >= 1.
  int stride = 1;
};

// How poses are judged: by data at agreeing_distance, and by cells about a millimetre apart where the sensor's are
// finer.
[[nodiscard]] EvidenceOptions judging_options(const SensorModel& sensor);

// Counts of the cells that would show the object, leaving out its outlines, where half a cell decides.
struct PoseEvidence {
  int drawn = 0;        // cells
  int explained = 0;    // data on the surface, with its normal where a region tells it
  int tilted = 0;       // data on the surface, but of a region with another normal
  int behind = 0;       // data behind the surface: the sensor saw through it
  int front = 0;        // data before the surface: hidden by something
  int beyond = 0;       // beyond the image: unseen as well
  int shadowed = 0;     // no data, where something may keep the projector's light away: unseen, too
  int missing = 0;      // no data otherwise
  int largest = 0;      // explained cells of the face, or triangle, with most of them
  double owned = 0.0;   // explained cells, each counting the share of its region that the object explains
  int faces = 0;        // or triangles, with at least 12 cells whose data say something: not missing, not unseen
  int faces_found = 0;  // of them, those of which at least half of these cells are explained
  PoolVector<int> explained_of_region;  // cells, by region
};

// The inputs of an acceptance model.
[[nodiscard]] std::array<double, kEvidenceFeatureCount> evidence_features(const PoseEvidence& evidence);

// log(p / (1 - p)) of the probability p that a pose with this evidence is right.
[[nodiscard]] double log_odds_right(const AcceptanceModel& model,
                                    const std::array<double, kEvidenceFeatureCount>& features);
// That probability.
[[nodiscard]] double probability_right(const AcceptanceModel& model,
                                       const std::array<double, kEvidenceFeatureCount>& features);
[[nodiscard]] double probability_right(const AcceptanceModel& model, const PoseEvidence& evidence);

[[nodiscard]] PoseEvidence gather_evidence(const CompiledModel& model, const Pose& T_sensor_model,
                                           const LabelledScan& scan, const EvidenceOptions& options = {});

// The cell is explained. Again: changes nothing.
void take(LabelledScan& scan, int cell);

// Takes the cells that the object explains, and what is left of regions of which hardly anything is.
void take_explained(const CompiledModel& model, const Pose& T_sensor_model, const EvidenceOptions& options,
                    LabelledScan& scan);

}  // namespace foresight
