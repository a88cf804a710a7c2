#include "benchmarks/constraint_scores.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/intervals.h"

namespace foresight {
namespace {

using Constraints = std::array<Constraint, kConstraintCount>;

std::size_t held_out_count(const ConstraintSubject& subject) { return subject.attributes.front().held_out.size(); }

void add_true_samples(const ConstraintSubject& subject, const std::vector<Constraints>& constraints,
                      std::vector<ConstraintTallies>& tallies) {
  for (std::size_t i = 0; i < held_out_count(subject); ++i) {
    for (std::size_t c = 0; c < kConstraintCount; ++c) {
      bool kept = true;
      double joint = 0.0;
      for (std::size_t k = 0; k < constraints.size(); ++k) {
        const AttributeSamples& attribute = subject.attributes[k];
        const Constraint& constraint = constraints[k][c];
        const double value = attribute.held_out[i];
        const double log_likelihood =
            std::log(std::max(kLeastProbability, constraint.probability(value, attribute.bin_width)));
        const bool keeps = constraint.keeps(value);
        tallies[k][c].add({1, keeps ? 1 : 0, 0, 0, log_likelihood});
        kept = kept && keeps;
        joint += log_likelihood;
      }
      tallies.back()[c].add({1, kept ? 1 : 0, 0, 0, joint});
    }
  }
}

void add_false_samples(const ConstraintSubject& other, const std::vector<Constraints>& constraints,
                       std::vector<ConstraintTallies>& tallies) {
  for (std::size_t i = 0; i < held_out_count(other); ++i) {
    for (std::size_t c = 0; c < kConstraintCount; ++c) {
      bool kept = true;
      for (std::size_t k = 0; k < constraints.size(); ++k) {
        const bool keeps = constraints[k][c].keeps(other.attributes[k].held_out[i]);
        tallies[k][c].add({0, 0, 1, keeps ? 1 : 0, 0.0});
        kept = kept && keeps;
      }
      tallies.back()[c].add({0, 0, 1, kept ? 1 : 0, 0.0});
    }
  }
}

// n, kept %, interval.
void add_share(long kept, long n, std::vector<std::string>& row) {
  const Interval interval = wilson_interval(kept, n);
  const double share = n > 0 ? static_cast<double>(kept) / static_cast<double>(n) : std::nan("");
  row.push_back(std::to_string(n));
  for (const double value : {share, interval.low, interval.high}) row.push_back(decimal(100.0 * value, 2));
}

const std::vector<std::string> kTallyHeader = {"true samples", "true kept %",   "true low",
                                               "true high",    "false samples", "false kept %",
                                               "false low",    "false high",    "mean log-likelihood"};

void add_tally(const ConstraintTally& tally, std::vector<std::string>& row) {
  add_share(tally.true_kept, tally.true_samples, row);
  add_share(tally.false_kept, tally.false_samples, row);
  row.push_back(decimal(
      tally.true_samples > 0 ? tally.log_likelihood / static_cast<double>(tally.true_samples) : std::nan(""), 3));
}

std::string attribute_name(const ConstraintSubject& subject, std::size_t k) {
  if (k < subject.attributes.size()) return subject.attributes[k].name;
  return subject.faces.size() == 1 ? "all four" : "both relations";
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? std::nan("") : sum / static_cast<double>(values.size());
}

}  // namespace

void ConstraintTally::add(const ConstraintTally& other) {
  true_samples += other.true_samples;
  true_kept += other.true_kept;
  false_samples += other.false_samples;
  false_kept += other.false_kept;
  log_likelihood += other.log_likelihood;
}

std::array<Constraint, kConstraintCount> constraints_on(const AttributeSamples& attribute) {
  return constraints_for(
      {attribute.samples, attribute.density, attribute.cad_value, attribute.cad_sigma, attribute.angle});
}

std::vector<ConstraintTallies> score_subject(const std::vector<ConstraintSubject>& subjects, std::size_t index) {
  const ConstraintSubject& subject = subjects[index];
  std::vector<Constraints> constraints;
  for (const AttributeSamples& attribute : subject.attributes) constraints.push_back(constraints_on(attribute));
  std::vector<ConstraintTallies> tallies(subject.attributes.size() + 1);
  add_true_samples(subject, constraints, tallies);
  for (std::size_t other = 0; other < subjects.size(); ++other) {
    if (other != index && subjects[other].faces.size() == subject.faces.size())
      add_false_samples(subjects[other], constraints, tallies);
  }
  return tallies;
}

Table constraint_table(const std::vector<ConstraintResult>& results, std::uint64_t seed) {
  Table table;
  table.header = {"scans", "face", "attribute", "constraint", "CAD value", "sample views", "mean of samples"};
  table.header.insert(table.header.end(), kTallyHeader.begin(), kTallyHeader.end());
  table.header.emplace_back("seed");
  for (const ConstraintResult& result : results) {
    for (std::size_t s = 0; s < result.subjects.size(); ++s) {
      const ConstraintSubject& subject = result.subjects[s];
      for (std::size_t k = 0; k < result.scores[s].size(); ++k) {
        const bool single = k < subject.attributes.size();
        for (std::size_t c = 0; c < kConstraintCount; ++c) {
          std::vector<std::string> row = {result.scans,
                                          subject.name(),
                                          attribute_name(subject, k),
                                          kConstraintNames[c],
                                          decimal(single ? subject.attributes[k].cad_value : std::nan(""), 3),
                                          std::to_string(subject.attributes.front().samples.size()),
                                          decimal(single ? mean_of(subject.attributes[k].samples) : std::nan(""), 3)};
          add_tally(result.scores[s][k][c], row);
          row.push_back(std::to_string(seed));
          table.rows.push_back(std::move(row));
        }
      }
    }
  }
  return table;
}

Table constraint_summary(const std::vector<ConstraintResult>& results, std::uint64_t seed) {
  Table table;
  table.header = {"constraint", "attribute", "scans"};
  table.header.insert(table.header.end(), kTallyHeader.begin(), kTallyHeader.end());
  table.header.emplace_back("seed");
  for (const ConstraintResult& result : results) {
    std::vector<std::pair<std::string, ConstraintTallies>> sums;  // in the order met: faces, then pairs
    for (std::size_t s = 0; s < result.subjects.size(); ++s) {
      for (std::size_t k = 0; k < result.scores[s].size(); ++k) {
        const std::string name = attribute_name(result.subjects[s], k);
        auto sum = std::find_if(sums.begin(), sums.end(), [&](const auto& entry) { return entry.first == name; });
        if (sum == sums.end()) sum = sums.insert(sums.end(), {name, {}});
        for (std::size_t c = 0; c < kConstraintCount; ++c) sum->second[c].add(result.scores[s][k][c]);
      }
    }
    for (const auto& [name, tallies] : sums) {
      for (std::size_t c = 0; c < kConstraintCount; ++c) {
        std::vector<std::string> row = {kConstraintNames[c], name, result.scans};
        add_tally(tallies[c], row);
        row.push_back(std::to_string(seed));
        table.rows.push_back(std::move(row));
      }
    }
  }
  return table;
}

}  // namespace foresight
