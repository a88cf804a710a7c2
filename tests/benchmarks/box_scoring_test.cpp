#include "benchmarks/box_scoring.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "compiler/sensor_file.h"
#include "compiler/sensor_simulator.h"
#include "tests/benchmarks/solids.h"
#include "tests/support.h"

namespace foresight {
namespace {

CompiledModel drawable(const CadModel& cad) {
  CompiledModel model;
  for (const Eigen::Vector3d& vertex : cad.vertices) model.vertices.push_back(vertex.cast<float>());
  model.triangles = cad.triangles;
  return model;
}

// Two boxes of one kind on a floor, and the mask of the first.
class TwoBoxes : public testing::Test {
 protected:
  TwoBoxes() {
    const std::vector<PlacedObject> placed = {{&box_, kLeft}, {&box_, kRight}};
    const std::vector<BackgroundPlane> floor = {{-Eigen::Vector3d::UnitZ(), -915.0}};
    SensorModel sensor = paper_sensor();
    const SimulatedScan scan = SimulatedScene(placed, floor).scan(sensor, Random(1));
    image_ = scan.image;
    camera_ = sensor.camera;
    for (const int object : {0, 1}) {
      std::vector<int> cells;
      for (int cell = 0; cell < image_.size(); ++cell) {
        if (scan.labels[static_cast<std::size_t>(cell)].object == object) cells.push_back(cell);
      }
      (object == 0 ? masks_ : others_).push_back(describe_mask(cells, box_, image_, camera_));
    }
  }

  BoxVerdicts score(const std::vector<ReportedObject>& reported) const {
    return score_boxes({image_, camera_, models_, masks_, {}}, reported);
  }
  BoxVerdict verdict(const Pose& pose, int object = 0) const { return score({{object, pose}}).reported.front(); }

  static Pose moved(const Pose& pose, const Eigen::Vector3d& by) { return {pose.rotation, pose.translation + by}; }

  const Pose kLeft{Eigen::Matrix3d::Identity(), {-50, 0, 900}};
  const Pose kRight{Eigen::Matrix3d::Identity(), {50, 20, 900}};
  const CadModel box_ = test::cuboid(80, 50, 30);
  const std::vector<CompiledModel> models_ = {drawable(box_), drawable(test::cuboid(140, 90, 30))};
  RangeImage image_;
  PinholeCamera camera_;
  std::vector<BoxMask> masks_, others_;
};

TEST_F(TwoBoxes, at_its_true_pose_a_box_is_found) {
  const BoxVerdicts verdicts = score({{0, kLeft}});
  EXPECT_EQ(verdicts.reported, std::vector{BoxVerdict::found});
  EXPECT_EQ(verdicts.report_of_mask, std::vector{0});
  const DrawnOnCells drawn = drawn_on(models_[0], kLeft, image_, camera_, masks_[0].cells);
  EXPECT_GT(drawn.share, 0.99);
  EXPECT_LT(drawn.residual, 0.2);
}

TEST_F(TwoBoxes, turned_by_a_symmetry_a_box_is_found) {
  const Eigen::Matrix3d half_turn = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_EQ(verdict({half_turn, kLeft.translation}), BoxVerdict::found);
}

TEST_F(TwoBoxes, a_shifted_turned_lifted_or_tilted_box_is_invented) {
  const auto turned = [&](double angle, const Eigen::Vector3d& axis) {
    return Pose{Eigen::AngleAxisd(angle, axis).toRotationMatrix(), kLeft.translation};
  };
  EXPECT_EQ(verdict(moved(kLeft, {25, 0, 0})), BoxVerdict::invented);
  EXPECT_EQ(verdict(turned(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ())), BoxVerdict::invented);
  EXPECT_EQ(verdict(moved(kLeft, {0, 0, -6})), BoxVerdict::invented);
  EXPECT_EQ(verdict(moved(kLeft, {0, 0, 6})), BoxVerdict::invented);
  EXPECT_EQ(verdict(turned(0.5, Eigen::Vector3d::UnitY())), BoxVerdict::invented);
  EXPECT_EQ(verdict(moved(kLeft, {2000, 0, 0})), BoxVerdict::invented);  // out of sight
}

TEST_F(TwoBoxes, a_larger_box_of_another_kind_explains_no_mask) {
  EXPECT_EQ(verdict(kLeft, 1), BoxVerdict::invented);
  EXPECT_EQ(score({{1, kLeft}}).report_of_mask, std::vector{-1});
}

TEST_F(TwoBoxes, of_two_reports_on_a_mask_the_one_that_covers_more_is_found) {
  const BoxVerdicts verdicts = score({{0, moved(kLeft, {10, 0, 0})}, {0, kLeft}});
  EXPECT_EQ(verdicts.reported, (std::vector{BoxVerdict::duplicate, BoxVerdict::found}));
  EXPECT_EQ(verdicts.report_of_mask, std::vector{1});
}

TEST_F(TwoBoxes, a_box_on_data_without_a_mask_is_neither_found_nor_invented) {
  EXPECT_EQ(verdict(kRight), BoxVerdict::unmasked);
  EXPECT_EQ(verdict(moved(kRight, {0, 0, 8})), BoxVerdict::invented);  // inside the box, no surface there
}

TEST_F(TwoBoxes, a_mask_that_is_not_counted_excuses_a_report) {
  // Overlapping masks, as of another frame: the report explains the one that is not counted.
  std::vector<int> both = masks_[0].cells;
  both.insert(both.end(), others_[0].cells.begin(), others_[0].cells.end());
  std::sort(both.begin(), both.end());
  const std::vector<BoxMask> wide = {describe_mask(both, box_, image_, camera_)};
  const std::vector<ReportedObject> reported = {{0, kRight}};
  EXPECT_EQ(score_boxes({image_, camera_, models_, wide, {}}, reported).reported.front(), BoxVerdict::invented);
  EXPECT_EQ(score_boxes({image_, camera_, models_, wide, others_}, reported).reported.front(), BoxVerdict::unmasked);
}

TEST_F(TwoBoxes, every_report_counts_for_one_mask) {
  const std::vector<BoxMask> twice = {masks_[0], masks_[0]};
  const BoxVerdicts verdicts = score_boxes({image_, camera_, models_, twice, {}}, {{0, kLeft}});
  EXPECT_EQ(std::count(verdicts.report_of_mask.begin(), verdicts.report_of_mask.end(), 0), 1);
}

TEST_F(TwoBoxes, the_residual_is_measured_across_the_surface) {
  EXPECT_EQ(score({}).report_of_mask, std::vector{-1});
  const Pose tilted{Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitX()).toRotationMatrix(), {0, 0, 900}};
  const std::vector<PlacedObject> placed = {{&box_, tilted}};
  const SimulatedScan scan = SimulatedScene(placed).scan(paper_sensor(), Random(1));
  std::vector<int> top;  // of the face that looks at the sensor most
  for (int cell = 0; cell < scan.image.size(); ++cell) {
    const CellLabel& label = scan.labels[static_cast<std::size_t>(cell)];
    if (label.object == 0 && (tilted.rotation * box_.faces[static_cast<std::size_t>(label.face)].normal).z() < -0.7)
      top.push_back(cell);
  }
  ASSERT_GT(top.size(), 500U);
  const Pose sunk = moved(tilted, tilted.rotation * Eigen::Vector3d(0, 0, 3.0));
  EXPECT_NEAR(drawn_on(models_[0], sunk, scan.image, paper_sensor().camera, top).residual, 3.0, 0.1);
}

// A box laid on the top of a mask, its long side along the mask's. Box frame: centre of the cuboid, long side x, z up.
Pose laid_on(const BoxMask& mask, double height) {
  const Eigen::Vector3d up = mask.top.region.normal;
  Pose pose;
  pose.rotation << mask.top.major_axis, up.cross(mask.top.major_axis), up;
  pose.translation = mask.top.centroid - 0.5 * height * up;
  return pose;
}

TEST(BoxesByHand, laid_on_the_tops_of_real_masks_are_found_and_shifted_are_not) {
  const std::string data = test::real_data_folder();
  if (data.empty()) GTEST_SKIP() << "no real data beside the checkout";
  std::vector<CadModel> cads = {test::cuboid(340, 250, 95), test::cuboid(255, 155, 100)};
  cads[0].name = "medium_box";
  cads[1].name = "small_box";
  const std::vector<CompiledModel> models = {drawable(cads[0]), drawable(cads[1])};
  const PinholeCamera camera = read_sensor_file(test::project_file("models/sensors/depth_camera.textproto")).camera;
  long found = 0, masks = 0;
  for (const BoxFrame& frame : read_box_frames(data + "/boxes", cads, camera)) {
    std::vector<ReportedObject> laid, shifted;
    for (const BoxMask& mask : frame.masks) {
      laid.push_back({mask.object, laid_on(mask, mask.object == 0 ? 95 : 100)});
      shifted.push_back(laid.back());
      shifted.back().T_sensor_model.translation += 100.0 * mask.top.major_axis;
    }
    const BoxScene scene{frame.image, camera, models, frame.masks, {}};
    const auto count_found = [&](const BoxVerdicts& verdicts) {
      return std::count(verdicts.reported.begin(), verdicts.reported.end(), BoxVerdict::found);
    };
    masks += static_cast<long>(frame.masks.size());
    found += count_found(score_boxes(scene, laid));
    EXPECT_EQ(count_found(score_boxes(scene, shifted)), 0) << frame.name;
  }
  EXPECT_EQ(masks, 13);
  EXPECT_EQ(found, masks);
}

}  // namespace
}  // namespace foresight
