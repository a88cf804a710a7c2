// Does this program, with this database, on this machine still recognize what it did when the database was compiled?
//
// The compiler left a golden scan of each object (common/golden_scan.h), in which it had recognized the object with a
// database of that object alone. The same is done again here: so an object fails where program, database or machine is
// at fault, and never because another object of the database looks like it.
#pragma once

#include <string>
#include <vector>

#include "runtime/database.h"
#include "runtime/foresight.h"

namespace foresight {

enum class SelftestVerdict {
  right,           // a reported pose is right (runtime/pose_distance.h)
  ambiguous,       // none is, but one of the alternatives that a report names
  wrong,           // reported at wrong poses only
  not_found,       // not reported
  no_golden_scan,  // nothing to test: the compiler recognized the object in no view, or knew no golden scans
};
[[nodiscard]] bool is_failure(SelftestVerdict verdict);  // wrong, not_found

struct ObjectSelftest {
  std::string object;
  SelftestVerdict verdict = SelftestVerdict::no_golden_scan;
  // Of the pose that is right, else of the nearest reported one, from the true pose or one that looks the same. 0 where
  // nothing is reported.
  double position_error = 0.0;  // of the object's centre. Unit: mm.
  double angle_error = 0.0;     // Unit: rad.
  double score = 0.0;           // of that pose
  double milliseconds = 0.0;    // of recognition
};

// What recognition in the golden scan came to. REQUIRES: the model has one, and all detections are of the model.
[[nodiscard]] ObjectSelftest judge_golden_scan(const RecognitionResult& recognized, const CompiledModel& model);

// One object. settings: of the database; its models play no part.
[[nodiscard]] ObjectSelftest selftest_object(const CompiledModel& model, const CompiledDatabase& settings);

struct SelftestCounts {
  int passed = 0;    // right or ambiguous
  int failed = 0;    // wrong or not found
  int untested = 0;  // no golden scan

  // At least one object was tested, and none failed.
  [[nodiscard]] bool all_right() const { return passed > 0 && failed == 0; }
};
[[nodiscard]] SelftestCounts count_verdicts(const std::vector<ObjectSelftest>& results);

// For eyes: one line each, with its line break.
[[nodiscard]] std::string selftest_line(const ObjectSelftest& result);
[[nodiscard]] std::string selftest_summary(const SelftestCounts& counts, const std::string& compiler_version);

}  // namespace foresight
