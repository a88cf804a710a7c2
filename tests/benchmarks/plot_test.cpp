#include "benchmarks/plot.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "common/errors.h"
#include "tests/support.h"

namespace foresight {
namespace {

using test::TemporaryFolder;

std::string read_text(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Plot small_plot() {
  Plot plot;
  plot.title = "it's <small> & \"quoted\"";
  plot.x_label = "x_1";
  plot.y_label = "share, %";
  plot.curves = {{"first", {1, 2, 4}, {10, std::numeric_limits<double>::quiet_NaN(), 30}, {}, {}, Curve::Style::line}};
  return plot;
}

TEST(Plot, holds_titles_and_labels_as_they_were_given) {
  const TemporaryFolder folder;
  const std::string file = folder.path() + "/plot.svg";
  write_plots(file, {small_plot(), small_plot()}, 2);
  const std::string text = read_text(file);
  EXPECT_NE(text.find("it's &lt;small> &amp; "), std::string::npos);
  EXPECT_NE(text.find("x_1"), std::string::npos);
  EXPECT_NE(text.find("first"), std::string::npos);
  EXPECT_NE(text.find("</svg>"), std::string::npos);
}

TEST(Plot, names_stand_at_their_bars) {
  const TemporaryFolder folder;
  Plot plot = small_plot();
  plot.x_names = {"visible >= 50 %", "castle"};
  plot.curves = {{"", {0, 1}, {3, 4}, {2, 3}, {4, 5}, Curve::Style::bars}};
  const std::string file = folder.path() + "/bars.svg";
  write_plots(file, {plot});
  EXPECT_NE(read_text(file).find("castle"), std::string::npos);
  EXPECT_NE(read_text(file).find("50 %<"), std::string::npos) << "a percent sign is no format";
}

TEST(Plot, of_nothing_says_so) {
  const TemporaryFolder folder;
  Plot plot = small_plot();
  plot.curves.front().y.assign(3, std::numeric_limits<double>::quiet_NaN());
  const std::string file = folder.path() + "/empty.svg";
  write_plots(file, {plot});
  EXPECT_NE(read_text(file).find("no data"), std::string::npos);
}

TEST(Plot, same_data_give_the_same_bytes) {
  const TemporaryFolder folder;
  write_plots(folder.path() + "/a.svg", {small_plot()});
  write_plots(folder.path() + "/b.svg", {small_plot()});
  EXPECT_EQ(read_text(folder.path() + "/a.svg"), read_text(folder.path() + "/b.svg"));
}

TEST(Plot, failure_names_the_file_and_leaves_nothing) {
  const TemporaryFolder folder;
  const std::string file = folder.path() + "/none/plot.svg";
  EXPECT_THROW(write_plots(file, {small_plot()}), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace foresight
