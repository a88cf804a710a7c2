#include "benchmarks/constraint_plots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace foresight {
namespace {

AttributeSamples lengths() {
  AttributeSamples attribute;
  attribute.name = "max_diameter";
  for (int i = 0; i < 50; ++i) attribute.samples.push_back(20.0 + 0.2 * i);
  attribute.held_out = {22.0, 25.0, 29.0};
  attribute.density = estimate_density(attribute.samples, 0.0, 48.0, {});
  attribute.bin_width = 2.0;
  attribute.cad_value = 30.0;
  attribute.cad_sigma = 1.0;
  return attribute;
}

const Curve& curve_named(const Plot& plot, const std::string& label) {
  return *std::find_if(plot.curves.begin(), plot.curves.end(),
                       [&](const Curve& curve) { return curve.label.starts_with(label); });
}

double sum(const Curve& curve) { return std::accumulate(curve.y.begin(), curve.y.end(), 0.0); }

TEST(AttributePlot, shows_all_samples_as_shares) {
  const Plot plot = attribute_plot(lengths(), "box 1", "held-out views");
  EXPECT_EQ(plot.curves.size(), 7u);
  EXPECT_NEAR(sum(curve_named(plot, "sample views (50)")), 1.0, 1e-9);
  EXPECT_NEAR(sum(curve_named(plot, "held-out views (3)")), 1.0, 1e-9);
  EXPECT_EQ(plot.x_label, "max_diameter (mm)");
}

TEST(AttributePlot, gives_every_distribution_the_area_of_the_histograms) {
  const Plot plot = attribute_plot(lengths(), "box 1", "held-out views");
  const Curve& bars = curve_named(plot, "sample views");
  const double bin = bars.x[1] - bars.x[0];
  for (const char* label : {"sensor model, compiled", "fitted normal", "CAD normal"}) {
    const Curve& curve = curve_named(plot, label);
    EXPECT_NEAR(sum(curve) * (curve.x[1] - curve.x[0]), bin, 0.08 * bin) << label << ", but for tails outside";
  }
}

TEST(AttributePlot, draws_the_bounds_where_they_are) {
  const Plot plot = attribute_plot(lengths(), "box 1", "held-out views");
  const Curve& bounds = curve_named(plot, "CAD value × 0.8");
  EXPECT_DOUBLE_EQ(bounds.x.front(), 24.0);
  EXPECT_DOUBLE_EQ(bounds.x.back(), 33.0);
  EXPECT_DOUBLE_EQ(plot.curves.back().x.front(), 30.0);
}

TEST(AttributePlot, does_without_sample_views) {
  AttributeSamples attribute = lengths();
  attribute.samples.clear();
  attribute.density = {};
  const Plot plot = attribute_plot(attribute, "box 1", "held-out views");
  EXPECT_EQ(plot.curves.size(), 6u) << "no normal can be fitted";
  for (const Curve& curve : plot.curves) {
    for (const double y : curve.y) EXPECT_TRUE(std::isfinite(y)) << curve.label;
  }
}

}  // namespace
}  // namespace foresight
