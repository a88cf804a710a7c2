// Plots of results, written as SVG by gnuplot.
#pragma once

#include <string>
#include <vector>

namespace foresight {

// One curve or set of points or bars; all vectors as long as x, or empty where optional.
struct Curve {
  enum class Style { line, points, line_and_points, steps, bars };
  std::string label;  // in the legend; empty: none
  std::vector<double> x;
  std::vector<double> y;     // NaN: a gap
  std::vector<double> low;   // interval about y, optional
  std::vector<double> high;  // goes with low
  Style style = Style::line;
};

struct Plot {
  std::string title;
  std::string x_label;  // with the unit
  std::string y_label;
  bool logarithmic_x = false;  // REQUIRES: every x > 0
  bool logarithmic_y = false;
  std::vector<std::string> x_names{};  // where not empty, names of x = 0, 1, 2, ... in place of numbers
  std::vector<Curve> curves{};
  bool percent_y = false;  // the y axis shows 0 to 100, whatever the values
};

// Several plots side by side in one picture, `columns` in a row. Throws InputError naming the file when it cannot be
// written or when gnuplot is not there or fails.
void write_plots(const std::string& file, const std::vector<Plot>& plots, int columns = 1);

}  // namespace foresight
