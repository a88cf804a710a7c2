#include "benchmarks/result_plots.h"

#include <algorithm>
#include <limits>

#include "benchmarks/intervals.h"

namespace foresight {
namespace {

// The places of things in the order of their first appearance.
std::size_t place_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

}  // namespace

Plot right_pose_plot(const std::string& title, const std::vector<SummaryRow>& rows) {
  Plot plot;
  plot.title = title;
  plot.y_label = "right pose, %";
  plot.percent_y = true;
  std::vector<std::string> methods;
  for (const SummaryRow& row : rows) place_of(methods, row.method);
  plot.curves.resize(methods.size());
  for (const SummaryRow& row : rows) {
    const std::size_t method = place_of(methods, row.method);
    // Methods stand beside one another, so that their intervals can be told apart.
    const double aside = 0.12 * (static_cast<double>(method) - 0.5 * static_cast<double>(methods.size() - 1));
    const Interval interval = wilson_interval(row.right, row.objects);
    Curve& curve = plot.curves[method];
    curve.label = row.method;
    curve.style = Curve::Style::points;
    curve.x.push_back(static_cast<double>(place_of(plot.x_names, row.label)) + aside);
    curve.y.push_back(row.objects == 0 ? std::numeric_limits<double>::quiet_NaN()
                                       : 100.0 * static_cast<double>(row.right) / static_cast<double>(row.objects));
    curve.low.push_back(row.objects == 0 ? curve.y.back() : 100.0 * interval.low);
    curve.high.push_back(row.objects == 0 ? curve.y.back() : 100.0 * interval.high);
  }
  return plot;
}

}  // namespace foresight
