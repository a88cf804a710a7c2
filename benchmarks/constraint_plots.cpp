#include "benchmarks/constraint_plots.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "benchmarks/constraint_scores.h"

namespace foresight {
namespace {

const char* unit_of(const std::string& attribute) {
  if (attribute == kAttributeNames[kArea]) return "mm²";
  return attribute == kRelationNames[kOrientation] ? "rad" : "mm";
}

constexpr int kDrawnBins = 60;  // finer than the compiled ones, which span all faces of a model

// What one plot shows, in equal bins.
struct DrawnRange {
  double from = 0.0;
  double to = 0.0;

  [[nodiscard]] double bin_width() const { return (to - from) / kDrawnBins; }
};

// All samples and the bounds about the CAD value, with a margin.
DrawnRange range_of(const AttributeSamples& attribute, const Constraint& bounds) {
  DrawnRange range{bounds.low, bounds.high};
  for (const std::vector<double>* values : {&attribute.samples, &attribute.held_out}) {
    for (const double value : *values) {
      range.from = std::min(range.from, value);
      range.to = std::max(range.to, value);
    }
  }
  const double margin = 0.03 * (range.to - range.from);
  return {std::max(0.0, range.from - margin), range.to + margin};  // no attribute is negative
}

// Share of the values in each bin.
Curve shares(const std::vector<double>& values, const DrawnRange& range) {
  std::vector<long> counts(kDrawnBins, 0);
  for (const double value : values)
    ++counts[static_cast<std::size_t>(std::clamp((value - range.from) / range.bin_width(), 0.0, kDrawnBins - 1.0))];
  Curve curve;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    curve.x.push_back(range.from + (static_cast<double>(bin) + 0.5) * range.bin_width());
    curve.y.push_back(static_cast<double>(counts[bin]) / static_cast<double>(std::max<std::size_t>(1, values.size())));
  }
  return curve;
}

// The compiled distribution: the mass of its bins, spread evenly over each.
Curve compiled_curve(const AttributeSamples& attribute, const DrawnRange& range) {
  constexpr int kPlaces = 1200;
  Curve curve;
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = range.from + (range.to - range.from) * i / kPlaces;
    curve.x.push_back(x);
    curve.y.push_back(attribute.density.probability(x) * range.bin_width() / attribute.bin_width);
  }
  return curve;
}

// A normal distribution as the mass of a drawn bin about each place.
Curve normal_curve(const Constraint& normal, const DrawnRange& range) {
  constexpr int kPlaces = 300;
  const double width = range.bin_width();
  Curve curve;
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = range.from + (range.to - range.from) * i / kPlaces;
    Constraint moved = normal;  // so that x is the middle of bin 0
    moved.mean = normal.mean - x + 0.5 * width;
    curve.x.push_back(x);
    curve.y.push_back(moved.probability(0.5 * width, width));
  }
  return curve;
}

// Two vertical lines, joined along the axis.
Curve bounds_curve(double low, double high, double top) {
  return {"", {low, low, high, high}, {top, 0, 0, top}, {}, {}};
}

double highest(const Curve& curve) { return *std::max_element(curve.y.begin(), curve.y.end()); }

}  // namespace

Plot attribute_plot(const AttributeSamples& attribute, const std::string& title, const std::string& held_out) {
  const auto constraints = constraints_on(attribute);
  const DrawnRange range = range_of(attribute, constraints[5]);
  Plot plot;
  plot.title = title;
  plot.x_label = attribute.name + " (" + unit_of(attribute.name) + ")";
  plot.y_label = "share in a bin";
  const auto add = [&](Curve curve, const std::string& label, Curve::Style style) {
    curve.label = label;
    curve.style = style;
    plot.curves.push_back(std::move(curve));
  };
  const auto count = [](const std::vector<double>& values) { return " (" + std::to_string(values.size()) + ")"; };
  add(shares(attribute.samples, range), "sample views" + count(attribute.samples), Curve::Style::bars);
  add(shares(attribute.held_out, range), held_out + count(attribute.held_out), Curve::Style::steps);
  add(compiled_curve(attribute, range), "sensor model, compiled", Curve::Style::line);
  for (const std::size_t c : {1, 2}) {
    if (constraints[c].kind == ConstraintKind::normal)
      add(normal_curve(constraints[c], range), kConstraintNames[c], Curve::Style::line);
  }
  double top = 0.0;
  for (const Curve& curve : plot.curves) top = std::max(top, highest(curve));
  add(bounds_curve(std::max(range.from, constraints[5].low), constraints[5].high, top),
      attribute.angle ? "CAD value ± 3 sigma" : "CAD value × 0.8 to 1.1", Curve::Style::line);
  add(bounds_curve(attribute.cad_value, attribute.cad_value, top), "CAD value", Curve::Style::line);
  return plot;
}

}  // namespace foresight
