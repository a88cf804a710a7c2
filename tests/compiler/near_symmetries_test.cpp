#include "compiler/near_symmetries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "compiler/compile.h"
#include "compiler/sensor_file.h"
#include "compiler/symmetries.h"
#include "tests/benchmarks/solids.h"
#include "tests/compiler/solids.h"
#include "tests/solids.h"

namespace foresight {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<Symmetry> near_of(const CadModel& model) {
  return find_near_symmetries(model, symmetry_group(model, kMostExactSymmetries),
                              near_symmetry_options(paper_sensor(), model.diameter()));
}

// A block of 60 x 60 x 40 mm with one vertical edge cut off by `cut` mm.
CadModel chamfered_block(double cut) {
  return test::make_extrusion({{0, 0}, {60, 0}, {60, 60 - cut}, {60 - cut, 60}, {0, 60}}, 40.0);
}

TEST(NearSymmetries, of_a_nearly_square_box_are_a_quarter_turn) {
  const std::vector<Symmetry> near = near_of(test::cuboid(50, 54, 80));
  ASSERT_EQ(near.size(), 1U);  // the other quarter turn differs by a half turn, which is exact
  EXPECT_FALSE(near[0].exact);
  EXPECT_GT(near[0].overlap, 0.95);
  const Eigen::Matrix3d& rotation = near[0].T_model_model.rotation;
  EXPECT_NEAR(std::abs(rotation(2, 2)), 1.0, 0.01);
  EXPECT_NEAR(std::abs(rotation(0, 1)), 1.0, 0.01);
}

TEST(NearSymmetries, of_a_block_with_one_chamfer_are_the_turns_that_lay_it_elsewhere) {
  const std::vector<Symmetry> near = near_of(chamfered_block(10.0));
  // Three quarter turns and the four turns upside down are seven; one half turn about the diagonal is exact, so that
  // two of them each differ by it.
  EXPECT_EQ(symmetry_group(chamfered_block(10.0), 512).size(), 2U);
  ASSERT_EQ(near.size(), 3U);
  for (const Symmetry& symmetry : near) {
    EXPECT_NEAR(std::abs(symmetry.T_model_model.rotation(2, 2)), 1.0, 1e-3);
    EXPECT_GT(symmetry.overlap, 0.85);
    EXPECT_LT(symmetry.overlap, 1.0);
  }
}

TEST(NearSymmetries, overlap_less_the_larger_the_mark) {
  double before = 1.0;
  for (const double cut : {10.0, 20.0, 30.0}) {
    const std::vector<Symmetry> near = near_of(chamfered_block(cut));
    ASSERT_FALSE(near.empty()) << cut;
    EXPECT_LT(near.front().overlap, before) << cut;
    before = near.front().overlap;
  }
}

TEST(NearSymmetries, of_what_has_none_are_none) {
  EXPECT_TRUE(near_of(test::cuboid(40, 60, 100)).empty());
  EXPECT_TRUE(near_of(test::make_step()).empty());
}

TEST(NearSymmetries, of_a_plate_are_no_slides_along_itself) {
  EXPECT_TRUE(near_of(test::cuboid(160, 80, 5)).empty());
  EXPECT_TRUE(near_of(test::cuboid(300, 20, 20)).empty());
}

TEST(NearSymmetries, leave_the_exact_ones_out) {
  EXPECT_TRUE(near_of(test::cuboid(50, 50, 50)).empty());
  EXPECT_TRUE(near_of(test::cuboid(50, 50, 90)).empty());
}

TEST(NearSymmetries, are_apart_from_each_other_and_from_the_exact_ones) {
  const CadModel model = test::cuboid(50, 52, 54);
  const std::vector<Pose> group = symmetry_group(model, kMostExactSymmetries);
  const NearSymmetryOptions options = near_symmetry_options(paper_sensor(), model.diameter());
  std::vector<Symmetry> near = find_near_symmetries(model, group, options);
  EXPECT_EQ(near.size(), 5U);  // a cube's 24 turns are 6 lots of the box's four
  near.push_back({Pose{}, true, 1.0});
  for (std::size_t i = 0; i < near.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      for (const Pose& symmetry : group) {
        const Pose other = near[k].T_model_model * symmetry;
        double farthest = 0.0;
        for (const Eigen::Vector3d& vertex : model.vertices)
          farthest = std::max(farthest, (near[i].T_model_model * vertex - other * vertex).norm());
        EXPECT_GE(farthest, options.separation);
      }
    }
  }
}

TEST(NearSymmetries, move_with_the_object) {
  const CadModel model = chamfered_block(10.0);
  const Pose T_there_here{rotation_from_vector({0.4, -1.1, 0.3}), {30, -200, 75}};
  CadModel moved = model;
  for (Eigen::Vector3d& vertex : moved.vertices) vertex = T_there_here * vertex;
  find_planar_faces(moved, {});
  const std::vector<Symmetry> here = near_of(model);
  const std::vector<Symmetry> there = near_of(moved);
  ASSERT_EQ(here.size(), there.size());
  const std::vector<Pose> group = symmetry_group(model, kMostExactSymmetries);
  for (const Symmetry& symmetry : there) {
    const Pose back = T_there_here.inverse() * symmetry.T_model_model * T_there_here;
    const auto same = [&](const Symmetry& other) {
      return std::any_of(group.begin(), group.end(), [&](const Pose& exact) {
        return rotation_angle((other.T_model_model * exact).rotation.transpose() * back.rotation) < 0.05;
      });
    };
    EXPECT_TRUE(std::any_of(here.begin(), here.end(), same));
  }
}

TEST(NearSymmetries, come_in_the_order_of_their_overlap) {
  const std::vector<Symmetry> near = near_of(chamfered_block(15.0));
  EXPECT_GT(near.size(), 1U);
  for (const Symmetry& symmetry : near) {
    EXPECT_GE(symmetry.overlap, NearSymmetryOptions{}.least_overlap);
    EXPECT_LE(symmetry.overlap, near.front().overlap);
  }
  EXPECT_TRUE(std::is_sorted(near.begin(), near.end(),
                             [](const Symmetry& a, const Symmetry& b) { return a.overlap > b.overlap; }));
}

TEST(NearSymmetries, are_the_same_every_time) {
  const std::vector<Symmetry> first = near_of(test::cuboid(50, 52, 54));
  const std::vector<Symmetry> second = near_of(test::cuboid(50, 52, 54));
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].T_model_model.rotation, second[i].T_model_model.rotation);
    EXPECT_EQ(first[i].overlap, second[i].overlap);
  }
}

TEST(NearSymmetryOptions, follow_the_noise_up_to_a_share_of_the_object) {
  SensorModel sensor = paper_sensor();
  EXPECT_DOUBLE_EQ(near_symmetry_options(sensor, 200.0).distance, 4.0);
  sensor.depth_noise = 2.0;
  EXPECT_GT(near_symmetry_options(sensor, 200.0).distance, 6.0);
  EXPECT_DOUBLE_EQ(near_symmetry_options(sensor, 40.0).distance, 2.0);
}

TEST(Symmetries, of_a_compiled_model_are_exact_ones_first_without_the_identity) {
  const std::vector<Symmetry> symmetries = list_symmetries(test::cuboid(50, 54, 80), paper_sensor());
  ASSERT_EQ(symmetries.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(symmetries[i].exact, i < 3);
    EXPECT_GT(rotation_angle(symmetries[i].T_model_model.rotation), 0.1 * kPi);
  }
  EXPECT_EQ(symmetries[0].overlap, 1.0);
}

TEST(Symmetries, are_part_of_a_compiled_model) {
  CompileOptions options;
  options.samples.views = 20;
  options.acceptance.scenes = 3;
  const CadModel cad = test::cuboid(50, 54, 80);
  const std::vector<Symmetry> compiled = compile_model(cad, paper_sensor(), options).symmetries;
  const std::vector<Symmetry> expected = list_symmetries(cad, paper_sensor());
  ASSERT_EQ(compiled.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(compiled[i].T_model_model.rotation, expected[i].T_model_model.rotation);
    EXPECT_EQ(compiled[i].exact, expected[i].exact);
  }
}

TEST(Symmetries, of_a_cylinder_of_many_facets_stay_within_the_caps) {
  for (const int facets : {24, 300}) {
    std::vector<Eigen::Vector2d> outline;
    for (int i = 0; i < facets; ++i)
      outline.emplace_back(40.0 * std::cos(2 * kPi * i / facets), 40.0 * std::sin(2 * kPi * i / facets));
    const std::vector<Symmetry> symmetries = list_symmetries(test::make_extrusion(outline, 60.0), paper_sensor());
    const auto exact = std::count_if(symmetries.begin(), symmetries.end(), [](const Symmetry& s) { return s.exact; });
    EXPECT_EQ(exact, facets == 24 ? 47 : 0);  // 600 turns are more than are kept
    EXPECT_LE(static_cast<std::ptrdiff_t>(symmetries.size()) - exact, kMostNearSymmetries);
  }
}

}  // namespace
}  // namespace foresight
