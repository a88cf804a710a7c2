#include "benchmarks/plot.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "benchmarks/table.h"
#include "common/errors.h"

namespace foresight {
namespace {

constexpr int kWidth = 640;  // of one plot. Unit: px.
constexpr int kHeight = 400;
constexpr int kLegendRow = 18;
// Colours that colour-blind readers can tell apart (Okabe and Ito, "Color Universal Design", 2008).
constexpr std::array<const char*, 7> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                 "#E69F00", "#56B4E9", "#000000"};

// In single quotes gnuplot reads everything literally but the quote itself.
std::string in_quotes(const std::string& text) {
  std::string result(1, '\'');
  for (const char c : text) {
    if (c == '\n') continue;
    result += c;
    if (c == '\'') result += c;
  }
  result += '\'';
  return result;
}

// Names of ticks are format strings to gnuplot.
std::string tick_name(const std::string& name) {
  std::string result;
  for (const char c : name) result.append(c == '%' ? 2 : 1, c);
  return in_quotes(result);
}

std::string number(double value) { return std::isfinite(value) ? decimal(value, 9) : std::string("NaN"); }

std::string data_block(const std::string& name, const Curve& curve) {
  assert(curve.y.size() == curve.x.size());
  assert(curve.low.empty() || (curve.low.size() == curve.x.size() && curve.high.size() == curve.x.size()));
  std::string text = name + " << EOD\n";
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    text.append(number(curve.x[i])).append(" ").append(number(curve.y[i]));
    if (!curve.low.empty()) text.append(" ").append(number(curve.low[i])).append(" ").append(number(curve.high[i]));
    text += "\n";
  }
  return text + "EOD\n";
}

std::string style_of(Curve::Style style) {
  switch (style) {
    case Curve::Style::line:
      return "lines lw 2";
    case Curve::Style::points:
      return "points pt 7 ps 0.5";
    case Curve::Style::line_and_points:
      return "linespoints lw 2 pt 7 ps 0.6";
    case Curve::Style::steps:
      return "histeps lw 2";
    case Curve::Style::bars:
      return "boxes fs solid 0.6 noborder";
  }
  return "lines";
}

// The words that draw one curve.
std::string drawing(const std::string& block, const Curve& curve, std::size_t index) {
  const std::string colour = std::string(" lc rgb '") + kColours[index % kColours.size()] + "'";
  const std::string title = curve.label.empty() ? " notitle" : " title " + in_quotes(curve.label);
  std::string text;
  if (!curve.low.empty()) text = block + " using 1:2:3:4 with yerrorbars pt 0 lw 1" + colour + " notitle, ";
  text.append(block).append(" using 1:2 with ").append(style_of(curve.style)).append(colour).append(title);
  return text;
}

// Whether there is a point to draw at all: gnuplot refuses a plot of nothing.
bool is_empty(const Plot& plot) {
  return std::all_of(plot.curves.begin(), plot.curves.end(), [](const Curve& curve) {
    return std::none_of(curve.y.begin(), curve.y.end(), [](double y) { return std::isfinite(y); });
  });
}

std::string plot_commands(const Plot& plot, std::size_t index) {
  std::string text;
  std::string drawings;
  bool bars = false;
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    const std::string name = std::string("$p").append(std::to_string(index)).append("c").append(std::to_string(c));
    text += data_block(name, plot.curves[c]);
    drawings += c == 0 ? "plot " : ", ";
    drawings += drawing(name, plot.curves[c], c);
    bars = bars || plot.curves[c].style == Curve::Style::bars;
  }
  text += "set title " + in_quotes(plot.title) + "\nset xlabel " + in_quotes(plot.x_label) + "\nset ylabel " +
          in_quotes(plot.y_label) + "\n";
  text += plot.logarithmic_x ? "set logscale x\n" : "unset logscale x\n";
  text += plot.logarithmic_y ? "set logscale y\n" : "unset logscale y\n";
  text += bars ? "set boxwidth 0.8 relative\nset yrange [0:*]\n" : "set yrange [*:*]\n";
  if (plot.percent_y) text += "set yrange [0:100]\n";
  if (plot.x_names.empty()) {
    text += "set xtics autofreq norotate\nset xrange [*:*]\n";
  } else {
    text += "set xtics rotate by -25 (";
    for (std::size_t i = 0; i < plot.x_names.size(); ++i)
      text.append(i > 0 ? ", " : "").append(tick_name(plot.x_names[i])).append(" ").append(std::to_string(i));
    text += ")\nset xrange [-0.6:" + decimal(static_cast<double>(plot.x_names.size()) - 0.4, 1) + "]\n";
  }
  return text + (is_empty(plot) ? std::string("plot [0:1][0:1] NaN title 'no data'") : drawings) + "\n";
}

std::string script_for(const std::string& file, const std::vector<Plot>& plots, int columns) {
  std::size_t legend = 0;
  for (const Plot& plot : plots) legend = std::max(legend, plot.curves.size());
  const int count = static_cast<int>(plots.size());
  const int rows = (count + columns - 1) / columns;
  const int height = kHeight + kLegendRow * static_cast<int>(legend);
  std::string text = "set terminal svg size " + std::to_string(kWidth * columns) + "," + std::to_string(height * rows) +
                     " noenhanced font 'sans,13' background rgb 'white'\nset output " + in_quotes(file) +
                     "\nset grid lc rgb '#dddddd'\nset border 3\nset tics nomirror\n"
                     "set key below vertical maxcols 2 noenhanced\nset pointintervalbox 0\nset datafile missing "
                     "'NaN'\nset offsets graph 0.03, "
                     "graph 0.03, graph 0.03, graph 0.03\n";
  text += "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) + "\n";
  for (std::size_t i = 0; i < plots.size(); ++i) text += plot_commands(plots[i], i);
  return text + "unset multiplot\nset output\n";
}

}  // namespace

void write_plots(const std::string& file, const std::vector<Plot>& plots, int columns) {
  assert(columns >= 1);
  // Written beside the target first: gnuplot leaves half a picture where it fails.
  const std::string unfinished = file + ".unfinished";
  const std::string script = script_for(unfinished, plots, columns);
  std::FILE* gnuplot = popen("gnuplot 2>/dev/null", "w");
  const bool written = gnuplot != nullptr && std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  const int status = gnuplot != nullptr ? pclose(gnuplot) : -1;
  std::error_code failed;
  if (written && status == 0) std::filesystem::rename(unfinished, file, failed);
  if (written && status == 0 && !failed) return;
  std::filesystem::remove(unfinished, failed);
  throw InputError(file, "the plot cannot be drawn",
                   "install gnuplot (Debian: gnuplot-nox) and give a folder that can be written");
}

}  // namespace foresight
