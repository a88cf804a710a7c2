// Right or wrong? Reported poses against true ones, by the largest surface distance that the object's symmetries leave.
//
// Right pose: the true object, within its tolerance (runtime/pose_distance.h) of the true pose or of one of those
// listed as equally good.
#pragma once

#include <functional>
#include <vector>

#include "common/pose.h"
#include "compiler/cad_model.h"
#include "compiler/symmetries.h"
#include "runtime/pose_distance.h"

namespace foresight {

inline constexpr double kPresentShare = 0.5;  // of the diameter: farther from every instance is a false positive

// With the symmetries that find_symmetries finds.
[[nodiscard]] ScoredObject scored_object(const CadModel& model);

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
