#include "benchmarks/hoover.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

namespace foresight {
namespace {

// Sizes of the regions of both images and of what they share.
struct Overlaps {
  std::map<int, double> truth;                 // P_n by label
  std::map<int, double> found;                 // P_m by label
  std::map<std::pair<int, int>, double> both;  // O_mn by (found, truth); only where > 0
};

Overlaps overlaps_of(std::span<const int> truth, std::span<const int> found) {
  Overlaps overlaps;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] > 0) ++overlaps.truth[truth[i]];
    if (found[i] > 0) ++overlaps.found[found[i]];
    if (truth[i] > 0 && found[i] > 0) ++overlaps.both[{found[i], truth[i]}];
  }
  return overlaps;
}

// A classification that holds, with the mean of its two coverages.
struct Candidate {
  HooverInstance instance;
  double coverage = 0.0;
};

void add_correct(const Overlaps& overlaps, double tolerance, std::vector<Candidate>& candidates) {
  for (const auto& [labels, shared] : overlaps.both) {
    const double of_found = shared / overlaps.found.at(labels.first);
    const double of_truth = shared / overlaps.truth.at(labels.second);
    if (of_found >= tolerance && of_truth >= tolerance)
      candidates.push_back({{HooverKind::correct, {labels.second}, {labels.first}}, 0.5 * (of_found + of_truth)});
  }
}

// One region that several regions of the other image lie in: each of these inside by the tolerance, all of them
// together covering the one by the tolerance.
struct Split {
  std::vector<int> parts;
  double shared = 0.0;
  double parts_size = 0.0;
};

std::map<int, Split> splits_of(const Overlaps& overlaps, double tolerance, bool of_truth) {
  std::map<int, Split> splits;
  for (const auto& [labels, shared] : overlaps.both) {
    const int part = of_truth ? labels.first : labels.second;
    const double size = of_truth ? overlaps.found.at(part) : overlaps.truth.at(part);
    if (shared < tolerance * size) continue;
    Split& split = splits[of_truth ? labels.second : labels.first];
    split.parts.push_back(part);
    split.shared += shared;
    split.parts_size += size;
  }
  return splits;
}

void add_splits(const Overlaps& overlaps, double tolerance, bool of_truth, std::vector<Candidate>& candidates) {
  for (const auto& [whole, split] : splits_of(overlaps, tolerance, of_truth)) {
    const double size = of_truth ? overlaps.truth.at(whole) : overlaps.found.at(whole);
    if (split.parts.size() < 2 || split.shared < tolerance * size) continue;
    const double coverage = 0.5 * (split.shared / split.parts_size + split.shared / size);
    if (of_truth) {
      candidates.push_back({{HooverKind::over_segmented, {whole}, split.parts}, coverage});
    } else {
      candidates.push_back({{HooverKind::under_segmented, split.parts, {whole}}, coverage});
    }
  }
}

bool any_used(const std::vector<int>& labels, const std::map<int, double>& unused) {
  return std::any_of(labels.begin(), labels.end(), [&](int label) { return !unused.contains(label); });
}

}  // namespace

std::vector<HooverInstance> classify_regions(std::span<const int> truth, std::span<const int> found, double tolerance) {
  assert(truth.size() == found.size() && tolerance > 0.5 && tolerance <= 1.0);
  const Overlaps overlaps = overlaps_of(truth, found);
  std::vector<Candidate> candidates;
  add_correct(overlaps, tolerance, candidates);
  add_splits(overlaps, tolerance, true, candidates);
  add_splits(overlaps, tolerance, false, candidates);
  // Ties: correct before over- before under-segmented, as they were added.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.coverage > b.coverage; });

  std::map<int, double> missed = overlaps.truth;
  std::map<int, double> noise = overlaps.found;
  std::vector<HooverInstance> instances;
  for (Candidate& candidate : candidates) {
    HooverInstance& instance = candidate.instance;
    if (any_used(instance.truth, missed) || any_used(instance.found, noise)) continue;
    for (const int label : instance.truth) missed.erase(label);
    for (const int label : instance.found) noise.erase(label);
    instances.push_back(std::move(instance));
  }
  for (const auto& [label, size] : missed) instances.push_back({HooverKind::missed, {label}, {}});
  for (const auto& [label, size] : noise) instances.push_back({HooverKind::noise, {}, {label}});
  return instances;
}

HooverCounts count_instances(const std::vector<HooverInstance>& instances) {
  HooverCounts counts;
  for (const HooverInstance& instance : instances) {
    counts.truth += static_cast<long>(instance.truth.size());
    counts.found += static_cast<long>(instance.found.size());
    counts.correct += instance.kind == HooverKind::correct ? 1 : 0;
    counts.over_segmented += instance.kind == HooverKind::over_segmented ? 1 : 0;
    counts.under_segmented += instance.kind == HooverKind::under_segmented ? 1 : 0;
    counts.missed += instance.kind == HooverKind::missed ? 1 : 0;
    counts.noise += instance.kind == HooverKind::noise ? 1 : 0;
  }
  return counts;
}

}  // namespace foresight
