#include "benchmarks/result_plots.h"

#include <gtest/gtest.h>

#include <cmath>

namespace foresight {
namespace {

SummaryRow row(const std::string& method, const std::string& label, long right, long objects) {
  SummaryRow result;
  result.method = method;
  result.label = label;
  result.right = right;
  result.objects = objects;
  return result;
}

TEST(ResultPlots, have_a_curve_a_method_and_a_place_a_set) {
  const Plot plot = right_pose_plot("t", {row("a", "castle", 1, 2), row("a", "all", 3, 4), row("b", "castle", 2, 2)});
  ASSERT_EQ(plot.curves.size(), 2U);
  EXPECT_EQ(plot.x_names, (std::vector<std::string>{"castle", "all"}));
  EXPECT_EQ(plot.curves[0].y, (std::vector<double>{50.0, 75.0}));
  EXPECT_EQ(plot.curves[1].y, (std::vector<double>{100.0}));
  EXPECT_LT(plot.curves[0].x[0], plot.curves[1].x[0]);  // beside one another
}

TEST(ResultPlots, show_intervals_about_the_share) {
  const Curve curve = right_pose_plot("t", {row("a", "all", 3, 4)}).curves.front();
  EXPECT_LT(curve.low.front(), 75.0);
  EXPECT_GT(curve.high.front(), 75.0);
}

TEST(ResultPlots, leave_a_gap_where_nothing_was_counted) {
  const Curve curve = right_pose_plot("t", {row("a", "all", 0, 0)}).curves.front();
  EXPECT_TRUE(std::isnan(curve.y.front()));
  EXPECT_TRUE(std::isnan(curve.low.front()));
}

}  // namespace
}  // namespace foresight
