#include "benchmarks/cad_constraints.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/benchmarks/boxes.h"
#include "tests/solids.h"

namespace foresight {
namespace {

// Top and right side of a box of 40 x 60 x 100 mm.
PoolVector<DescribedRegion> top_and_right() {
  return {test::rectangle({0, 0, 100}, {40, 0, 0}, {0, 60, 0}), test::rectangle({40, 0, 0}, {0, 60, 0}, {0, 0, 100})};
}

TEST(CadGeometry, of_a_box_has_the_closed_forms) {
  const CadGeometry geometry = cad_geometry(test::make_box(40, 60, 100));
  ASSERT_EQ(geometry.faces.size(), 6U);
  const AttributeVector& bottom = geometry.faces[0];
  EXPECT_NEAR(bottom[kArea], 2400.0, 1e-9);
  EXPECT_NEAR(bottom[kMaxSecondMoment], 60.0 / std::sqrt(12.0), 1e-9);
  EXPECT_NEAR(bottom[kMinSecondMoment], 40.0 / std::sqrt(12.0), 1e-9);
  EXPECT_NEAR(bottom[kMaxDiameter], std::hypot(40.0, 60.0), 1e-9);
  const double diagonal = std::sqrt(40.0 * 40.0 + 60.0 * 60.0 + 100.0 * 100.0);
  EXPECT_NEAR(geometry.relations[0][1][kMaxDistance], diagonal, 1e-9);
  EXPECT_NEAR(geometry.relations[1][0][kMaxDistance], diagonal, 1e-9);
}

TEST(CadField, matches_each_region_with_the_faces_of_its_size) {
  const CadModel box = test::make_box(40, 60, 100);
  const Database database = test::database_of_copies(box, 1);
  const CadGeometry geometry = cad_geometry(box);
  const HypothesisField field = cad_field(top_and_right(), database, {&geometry}, {0.8, 1.1});
  ASSERT_EQ(field.matches.size(), 4U);  // bottom and top; left and right
  EXPECT_EQ(field.by_region[0].size(), 2U);
  EXPECT_EQ(field.by_region[1].size(), 2U);
  for (const PoolVector<int>& supports : field.supports) EXPECT_EQ(supports.size(), 2U);  // all at right angles
}

TEST(CadField, lets_a_region_be_part_of_a_larger_face_only_without_a_lower_bound) {
  const CadModel box = test::make_box(40, 60, 100);
  const Database database = test::database_of_copies(box, 1);
  const CadGeometry geometry = cad_geometry(box);
  const HypothesisField loose = cad_field(top_and_right(), database, {&geometry}, {});
  const HypothesisField close = cad_field(top_and_right(), database, {&geometry}, {0.8, 1.1});
  EXPECT_EQ(loose.by_region[0].size(), 6U);  // 40 x 60 fits into every face, 60 x 100 into its own alone
  EXPECT_EQ(loose.by_region[1].size(), 2U);
  EXPECT_GT(loose.matches.size(), close.matches.size());
}

TEST(CadField, supports_only_pairs_that_meet_at_the_angle_of_the_faces) {
  const CadModel box = test::make_box(40, 60, 100);
  const Database database = test::database_of_copies(box, 1);
  const CadGeometry geometry = cad_geometry(box);
  PoolVector<DescribedRegion> regions = top_and_right();
  const double lean = 20.0 * std::numbers::pi / 180.0;
  regions[1].region.normal = Eigen::Vector3d(std::cos(lean), 0.0, std::sin(lean));
  for (const PoolVector<int>& supports : cad_field(regions, database, {&geometry}, {}).supports) {
    EXPECT_TRUE(supports.empty());
  }
}

}  // namespace
}  // namespace foresight
