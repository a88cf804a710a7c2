#include "benchmarks/cad_attributes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/images.h"
#include "tests/solids.h"

namespace foresight {
namespace {

// Faces of make_box: bottom, top, front (-y), right (+x), back (+y), left (-x).
TEST(CadAttributes, of_a_rectangle_are_its_closed_formulas) {
  const AttributeVector top = cad_attributes(test::make_box(40, 90, 20), 1);
  EXPECT_NEAR(top[kArea], 3600.0, 1e-9);
  EXPECT_NEAR(top[kMaxSecondMoment], 90.0 / std::sqrt(12.0), 1e-9);
  EXPECT_NEAR(top[kMinSecondMoment], 40.0 / std::sqrt(12.0), 1e-9);
  EXPECT_NEAR(top[kMaxDiameter], std::hypot(40.0, 90.0), 1e-9);
}

TEST(CadAttributes, of_an_l_shape_are_the_sum_of_its_rectangles) {
  // The bottom of the step: 60 x 15 and, above its left end, 25 x 25.
  const AttributeVector bottom = cad_attributes(test::make_step(), 0);
  const double a = 60.0 * 15.0, b = 25.0 * 25.0, area = a + b;
  const Eigen::Vector2d at_a(30.0, 7.5), at_b(12.5, 27.5), mean = (a * at_a + b * at_b) / area;
  const auto part = [&](double share, const Eigen::Vector2d& at, double width, double height) -> Eigen::Matrix2d {
    const Eigen::Vector2d d = at - mean;
    Eigen::Matrix2d own = Eigen::Vector2d(width * width / 12.0, height * height / 12.0).asDiagonal();
    return share / area * (own + d * d.transpose());
  };
  const Eigen::Matrix2d covariance = part(a, at_a, 60, 15) + part(b, at_b, 25, 25);
  EXPECT_NEAR(bottom[kArea], area, 1e-9);
  const double max = bottom[kMaxSecondMoment], min = bottom[kMinSecondMoment];
  EXPECT_NEAR(max * max + min * min, covariance.trace(), 1e-8);
  EXPECT_NEAR(max * max * min * min, covariance.determinant(), 1e-6);
  EXPECT_NEAR(bottom[kMaxDiameter], std::hypot(60.0, 40.0), 1e-9) << "from the far end of one arm to that of the other";
}

TEST(CadAttributes, do_not_change_with_a_motion) {
  const CadModel step = test::make_step();
  Random random(4);
  const CadModel elsewhere = test::moved(step, {random.rotation(), {300.0, -50.0, 800.0}});
  for (int face = 0; face < static_cast<int>(step.faces.size()); ++face) {
    for (std::size_t k = 0; k < kAttributeCount; ++k)
      EXPECT_NEAR(cad_attributes(step, face)[k], cad_attributes(elsewhere, face)[k], 1e-6);
    for (std::size_t k = 0; k < kRelationCount; ++k)
      EXPECT_NEAR(cad_relations(step, face, 2)[k], cad_relations(elsewhere, face, 2)[k], 1e-6);
  }
}

TEST(CadAttributes, are_what_extraction_measures_of_a_wholly_visible_face) {
  const PinholeCamera camera;
  const double cell = 600.0 / camera.fx;
  const RangeImage image = test::render({test::facing({3.0, -5.0, 600.0}, 90.0, 40.0)}, camera);
  const auto regions = extract_regions(image, camera, {});
  ASSERT_EQ(regions.size(), 1u);
  const CadModel box = test::make_box(90, 40, 20);
  const AttributeVector cad = cad_attributes(box, 1), sigmas = cad_attribute_sigmas(box, 1, cell);
  for (std::size_t k = 0; k < kAttributeCount; ++k) {
    EXPECT_LT(std::abs(regions[0].attributes[k] - cad[k]), 3.0 * sigmas[k]) << kAttributeNames[k];
  }
}

TEST(CadAttributes, relate_two_faces_by_angle_and_farthest_corners) {
  const CadModel box = test::make_box(40, 90, 20);
  const RelationVector opposite = cad_relations(box, 0, 1), adjacent = cad_relations(box, 1, 3);
  EXPECT_NEAR(opposite[kOrientation], std::numbers::pi, 1e-9);
  EXPECT_NEAR(opposite[kMaxDistance], std::sqrt(1600.0 + 8100.0 + 400.0), 1e-9);
  EXPECT_NEAR(adjacent[kOrientation], std::numbers::pi / 2.0, 1e-9);
  EXPECT_EQ(adjacent, cad_relations(box, 3, 1)) << "symmetric";
}

TEST(CadAttributes, are_surer_on_a_finer_grid) {
  const CadModel box = test::make_box(40, 90, 20);
  const AttributeVector fine = cad_attribute_sigmas(box, 1, 0.5), coarse = cad_attribute_sigmas(box, 1, 1.0);
  EXPECT_NEAR(coarse[kArea], 0.5 * 1.0 * 260.0, 1e-9) << "half a cell times the perimeter";
  for (std::size_t k = 0; k < kAttributeCount; ++k) EXPECT_NEAR(coarse[k], 2.0 * fine[k], 1e-9);
  const RelationVector quiet = cad_relation_sigmas(box, 1, 3, 1.0, 0.1),
                       noisy = cad_relation_sigmas(box, 1, 3, 1.0, 0.4);
  EXPECT_NEAR(noisy[kOrientation], 4.0 * quiet[kOrientation], 1e-12);
}

}  // namespace
}  // namespace foresight
