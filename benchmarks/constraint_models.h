// Ways to constrain one attribute of a region that may show a face (Section III, Fig. 2): the compiled histogram of the
// sensor model, and what recognition systems without a sensor model use instead.
#pragma once

#include <array>
#include <span>

#include "common/density.h"

namespace foresight {

// Standard deviations from its mean within which a normal distribution keeps a value: it is zero nowhere, so that some
// limit has to be set before it can prune.
inline constexpr double kNormalReach = 3.0;

enum class ConstraintKind { histogram, normal, bounds };

struct Constraint {
  ConstraintKind kind = ConstraintKind::bounds;
  Density density;     // histogram
  double mean = 0.0;   // normal
  double sigma = 0.0;  // normal. Limit: >= 0; 0 keeps nothing but the mean.
  double low = 0.0;    // bounds; low > high keeps nothing
  double high = 0.0;

  // Whether a match with this value survives: P(f|M) > 0 for the histogram.
  [[nodiscard]] bool keeps(double value) const;
  // Probability of a value in the bin of this width that holds `value`, bins counted from 0: the unit of P(f|M). Bounds
  // are uniform in between.
  [[nodiscard]] double probability(double value, double bin_width) const;
};

inline constexpr int kConstraintCount = 6;
inline constexpr std::array<const char*, kConstraintCount> kConstraintNames = {
    "sensor model", "fitted normal", "CAD normal", "CAD at most", "CAD at most + 3 sigma", "CAD 0.8 to 1.1"};

// One attribute of one face, or of two.
struct AttributeKnowledge {
  std::span<const double> samples;  // from the sample views; may be empty
  Density density;                  // compiled from them; no mass where they are empty
  double cad_value = 0.0;           // of the CAD geometry alone
  double cad_sigma = 0.0;           // of a measurement of that value. Limit: > 0.
  bool angle =
      false;  // hiding a part makes an area or a length less, not an angle: its bounds are cad_value +- 3 sigma
};

// In the order of kConstraintNames. The fitted normal has the samples' mean and standard deviation (cad_sigma when
// there is one sample only) and keeps nothing when there is none.
[[nodiscard]] std::array<Constraint, kConstraintCount> constraints_for(const AttributeKnowledge& knowledge);

}  // namespace foresight
