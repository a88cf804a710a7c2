#include "runtime/selftest.h"

#include <gtest/gtest.h>

#include "compiler/database_writer.h"
#include "runtime/foresight.h"
#include "tests/runtime/compiled_objects.h"

namespace foresight {
namespace {

using test::compiled_objects;

ObjectSelftest tested(const CompiledModel& model) { return selftest_object(model, compiled_objects().content()); }

// Castle (four poses look the same) and stick (no symmetry), as compiled.
CompiledModel castle() { return compiled_objects().models()[0]; }
CompiledModel stick() { return compiled_objects().models()[1]; }

TEST(Selftest, recognizes_every_object_as_it_was_compiled) {
  for (const CompiledModel& model : compiled_objects().models()) {
    ASSERT_TRUE(model.golden_scan) << model.name;
    const ObjectSelftest result = tested(model);
    EXPECT_EQ(result.object, model.name);
    EXPECT_EQ(result.verdict, SelftestVerdict::right);
    EXPECT_LT(result.position_error, 1.0);
    EXPECT_LT(result.angle_error, 0.02);
    EXPECT_GE(result.score, 0.5);
    EXPECT_GT(result.milliseconds, 0.0);
  }
}

TEST(Selftest, gives_the_same_bits_with_the_database_as_read) {
  const CompiledDatabase read = decode_database(encode_database(compiled_objects().content()), "x.db");
  for (std::size_t i = 0; i < read.models.size(); ++i) {
    const ObjectSelftest compiled = tested(compiled_objects().models()[i]);
    const ObjectSelftest again = selftest_object(read.models[i], read);
    EXPECT_EQ(again.position_error, compiled.position_error);
    EXPECT_EQ(again.angle_error, compiled.angle_error);
    EXPECT_EQ(again.score, compiled.score);
  }
}

TEST(Selftest, fails_with_the_golden_scan_of_another_object) {
  CompiledModel changed = stick();
  changed.golden_scan = castle().golden_scan;
  EXPECT_TRUE(is_failure(tested(changed).verdict));
}

TEST(Selftest, fails_when_the_true_pose_is_another) {
  CompiledModel changed = stick();
  changed.golden_scan->T_sensor_model.translation.x() += 30.0;
  const ObjectSelftest moved = tested(changed);
  EXPECT_EQ(moved.verdict, SelftestVerdict::wrong);
  EXPECT_NEAR(moved.position_error, 30.0, 1.0);
  changed = stick();
  Pose& pose = changed.golden_scan->T_sensor_model;
  pose = pose * Pose{rotation_from_vector({0.0, 0.0, 3.0}), Eigen::Vector3d::Zero()};
  EXPECT_EQ(tested(changed).verdict, SelftestVerdict::wrong);
}

TEST(Selftest, takes_any_pose_that_looks_the_same) {
  CompiledModel changed = castle();
  ASSERT_TRUE(changed.symmetries.at(0).exact);
  const ObjectSelftest before = tested(changed);
  Pose& pose = changed.golden_scan->T_sensor_model;
  pose = pose * changed.symmetries[0].T_model_model;
  const ObjectSelftest turned = tested(changed);
  EXPECT_EQ(turned.verdict, SelftestVerdict::right);
  EXPECT_NEAR(turned.position_error, before.position_error, 0.1);
  EXPECT_NEAR(turned.angle_error, before.angle_error, 0.01);
}

TEST(Selftest, fails_when_the_model_was_changed) {
  CompiledModel changed = stick();
  for (Eigen::Vector3f& vertex : changed.vertices) vertex *= 1.5F;
  EXPECT_TRUE(is_failure(tested(changed).verdict));
  changed = stick();
  changed.acceptance.bias = -1000.0;  // accepts nothing
  EXPECT_EQ(tested(changed).verdict, SelftestVerdict::not_found);
}

TEST(Selftest, leaves_out_objects_that_cannot_be_tested) {
  CompiledModel changed = stick();
  changed.golden_scan.reset();
  EXPECT_EQ(tested(changed).verdict, SelftestVerdict::no_golden_scan);
  changed = stick();
  changed.acceptance = {};
  EXPECT_EQ(tested(changed).verdict, SelftestVerdict::no_golden_scan);
  changed = stick();
  changed.triangle_faces.clear();
  EXPECT_EQ(tested(changed).verdict, SelftestVerdict::no_golden_scan);
}

TEST(SelftestReport, counts_and_tells_of_every_object) {
  const SelftestReport report = selftest(compiled_objects());
  EXPECT_TRUE(report.all_right) << report.text;
  EXPECT_EQ(report.failed, 0);
  EXPECT_EQ(report.untested, 0);
  for (const std::string words : {"castle: right", "stick: right", "passed: 2 right, 0 failed, 0 not tested"})
    EXPECT_NE(report.text.find(words), std::string::npos) << report.text;

  CompiledDatabase changed = compiled_objects().content();
  changed.models[1].golden_scan->T_sensor_model.translation.z() += 50.0;
  changed.models[0].golden_scan.reset();
  const SelftestReport failing = selftest(Database(changed));
  EXPECT_FALSE(failing.all_right);
  EXPECT_EQ(failing.failed, 1);
  EXPECT_EQ(failing.untested, 1);

  changed.models[1].golden_scan.reset();
  const SelftestReport nothing = selftest(Database(changed));
  EXPECT_FALSE(nothing.all_right);
  EXPECT_EQ(nothing.failed, 0);
  EXPECT_EQ(nothing.untested, 2);
}

}  // namespace
}  // namespace foresight
