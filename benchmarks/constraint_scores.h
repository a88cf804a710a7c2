// How well each kind of constraint keeps the matches that are right, and how few of those that are wrong.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/constraint_models.h"
#include "benchmarks/constraint_samples.h"
#include "benchmarks/table.h"

namespace foresight {

// A sample that a constraint gives less than this probability counts with this one in the log-likelihood: P(R|B) of
// Section IV.A, the explanation that is always there.
inline constexpr double kLeastProbability = 0.000003;

struct ConstraintTally {
  long true_samples = 0;  // held-out samples of the subject itself
  long true_kept = 0;
  long false_samples = 0;  // held-out samples of all others: matches that are wrong
  long false_kept = 0;
  double log_likelihood = 0.0;  // sum over the true samples

  void add(const ConstraintTally& other);
};

using ConstraintTallies = std::array<ConstraintTally, kConstraintCount>;

// By attribute of subjects[index], and last all of its attributes together: kept by each, probabilities multiplied
// (attributes are independent, Section IV.A). Others: the subjects with as many faces.
[[nodiscard]] std::vector<ConstraintTallies> score_subject(const std::vector<ConstraintSubject>& subjects,
                                                           std::size_t index);

// The constraints on one attribute of a subject.
[[nodiscard]] std::array<Constraint, kConstraintCount> constraints_on(const AttributeSamples& attribute);

// One set of subjects and their scores.
struct ConstraintResult {
  std::string scans;  // what the held-out samples come from
  std::vector<ConstraintSubject> subjects;
  std::vector<std::vector<ConstraintTallies>> scores;  // of each subject
};

// A row for each subject, attribute and constraint.
[[nodiscard]] Table constraint_table(const std::vector<ConstraintResult>& results, std::uint64_t seed);

// The same pooled over the samples of all subjects.
[[nodiscard]] Table constraint_summary(const std::vector<ConstraintResult>& results, std::uint64_t seed);

}  // namespace foresight
