// How well a segmentation agrees with the true regions (Hoover et al., "An Experimental Comparison of Range Image
// Segmentation Algorithms", IEEE PAMI 18(7), 1996, the section on performance metrics).
#pragma once

#include <span>
#include <vector>

namespace foresight {

// correct: one true region, one found region. over_segmented: one true region, several found ones.
// under_segmented: several true regions, one found one. missed: a true region in none of these. noise: a found region
// in none of these.
enum class HooverKind { correct, over_segmented, under_segmented, missed, noise };

struct HooverInstance {
  HooverKind kind = HooverKind::correct;
  std::vector<int> truth;  // labels, ascending
  std::vector<int> found;  // labels, ascending
};

struct HooverCounts {
  long truth = 0;  // true regions
  long found = 0;  // found regions
  long correct = 0;
  long over_segmented = 0;
  long under_segmented = 0;
  long missed = 0;
  long noise = 0;
};

// Every region is in exactly one instance: of the classifications that hold for it, the one that covers more, as the
// paper resolves them. Labels above 0 are regions, all else belongs to none; a found region's cells outside every true
// region still count in its size. Order: best covered first, then missed and noise by label.
// REQUIRES: truth and found of one size; 0.5 < tolerance <= 1.
[[nodiscard]] std::vector<HooverInstance> classify_regions(std::span<const int> truth, std::span<const int> found,
                                                           double tolerance);

[[nodiscard]] HooverCounts count_instances(const std::vector<HooverInstance>& instances);

}  // namespace foresight
