// Right or wrong? Reported poses against true ones, by the largest surface distance that the object's symmetries leave.
//
// Right pose: the true object, with MSSD (BOP's maximum symmetry-aware surface distance: the largest distance of a
// vertex between reported and true pose, minimised over the symmetries and the listed equally good poses) of at most 5
// mm or 5 % of the object's diameter, whichever is larger.
#pragma once

#include <functional>
#include <vector>

#include "common/pose.h"
#include "compiler/cad_model.h"
#include "compiler/symmetries.h"

namespace foresight {

inline constexpr double kRightDistance = 5.0;  // Unit: mm.
inline constexpr double kRightShare = 0.05;    // of the diameter
inline constexpr double kPresentShare = 0.5;   // of the diameter: farther from every instance is a false positive

// What scoring needs to know about an object.
struct ScoredObject {
  std::vector<Eigen::Vector3d> vertices;  // Unit: mm.
  std::vector<Pose> symmetries;           // T_model_model, the identity first
  double diameter = 0.0;                  // Unit: mm.

  [[nodiscard]] double tolerance() const;  // Unit: mm.
};
[[nodiscard]] ScoredObject scored_object(const CadModel& model);

// Unit: mm.
[[nodiscard]] double mssd(const ScoredObject& object, const Pose& reported, const Pose& truth);

struct TrueObject {
  int object = 0;           // index into the objects scored
  std::vector<Pose> poses;  // T_sensor_model; the true one first, then equally good ones. Not empty.
  double visible_fraction = 1.0;
};

struct PosedObject {
  int object = -1;  // index into the objects scored; -1: an object that is not scored, never right
  Pose T_sensor_model;
};

struct ReportedObject {
  int object = -1;  // -1: an object that is not scored
  Pose T_sensor_model;
  std::vector<PosedObject> alternatives = {};  // what the report names as equally good
};

enum class Verdict {
  missed,             // of a true object only: nothing right was reported
  right,              // right pose
  declared,           // not right, but one of the alternatives it names is: right object, right pose
  indistinguishable,  // neither, but the view cannot tell the two poses apart
  wrong_pose,         // the object is there, the pose is not right
  false_positive,     // no true instance of that object within half its diameter
  duplicate,          // right, or right by an alternative, for an instance that another report has already
};

struct SceneVerdicts {
  std::vector<Verdict> reported;  // one a report; never missed
  std::vector<Verdict> truth;     // one a true object: right, declared, indistinguishable or missed
  std::vector<bool> named;        // one a true object: reported whatever its pose, each report used once; alternatives
                                  // do not count
};

// Whether the view cannot tell the reported pose from the true one.
using CannotTell = std::function<bool(int object, const Pose& reported, const Pose& truth)>;

// Each true object takes at most one report, the nearest right one first, then the one with the nearest right
// alternative, then the nearest indistinguishable one. cannot_tell is asked only about pairs that are not right.
[[nodiscard]] SceneVerdicts score_scene(const std::vector<ScoredObject>& objects, const std::vector<TrueObject>& truth,
                                        const std::vector<ReportedObject>& reported, const CannotTell& cannot_tell);

}  // namespace foresight
