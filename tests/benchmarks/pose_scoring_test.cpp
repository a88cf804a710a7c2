#include "benchmarks/pose_scoring.h"

#include <gtest/gtest.h>

#include "common/random.h"
#include "tests/benchmarks/solids.h"

namespace foresight {
namespace {

// Diameter 102.5 mm: the tolerance is 5.12 mm and half the diameter 51.2 mm.
ScoredObject box() { return scored_object(test::cuboid(40, 50, 80)); }

Pose random_pose(Random& random) {
  const Eigen::Matrix3d rotation = random.rotation();
  return {rotation, Eigen::Vector3d(random.uniform(-100, 100), random.uniform(-100, 100), random.uniform(700, 900))};
}

Pose moved(const Pose& pose, double distance) {
  return {pose.rotation, pose.translation + Eigen::Vector3d(distance, 0, 0)};
}

Pose at(double x) { return {Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, 0, 800)}; }

// A quarter turn about z: no symmetry of the box.
Pose turned(double x) { return {rotation_from_vector({0, 0, 1.5707963267948966}), Eigen::Vector3d(x, 0, 800)}; }

bool never(int, const Pose&, const Pose&) { return false; }
bool always(int, const Pose&, const Pose&) { return true; }

TEST(Mssd, is_zero_at_the_truth_and_at_every_symmetric_pose) {
  Random random(3);
  const ScoredObject object = box();
  for (int i = 0; i < 20; ++i) {
    const Pose truth = random_pose(random);
    for (const Pose& symmetry : object.symmetries) EXPECT_NEAR(mssd(object, truth * symmetry, truth), 0.0, 1e-9);
  }
}

TEST(Mssd, of_a_moved_object_is_the_distance_it_moved) {
  Random random(4);
  for (const double distance : {0.5, 4.0, 19.0}) {
    const Pose truth = random_pose(random);
    EXPECT_NEAR(mssd(box(), moved(truth, distance), truth), distance, 1e-9);
  }
}

TEST(Mssd, does_not_change_when_both_poses_move_or_swap) {
  Random random(5);
  const ScoredObject object = box();
  for (int i = 0; i < 20; ++i) {
    const Pose a = random_pose(random);
    const Pose b = random_pose(random);
    const Pose both = random_pose(random);
    EXPECT_NEAR(mssd(object, a, b), mssd(object, both * a, both * b), 1e-9);
    EXPECT_NEAR(mssd(object, a, b), mssd(object, b, a), 1e-9);
  }
}

TEST(Mssd, without_symmetries_sees_the_turn) {
  ScoredObject object = box();
  const Pose half_turn{rotation_from_vector({0, 0, 3.141592653589793}), {0, 0, 800}};
  EXPECT_NEAR(mssd(object, half_turn, at(0)), 0.0, 1e-9);
  object.symmetries.resize(1);
  EXPECT_NEAR(mssd(object, half_turn, at(0)), std::hypot(40, 50), 1e-9);
}

TEST(Tolerance, is_5_mm_or_5_percent_whichever_is_larger) {
  ScoredObject object;
  object.diameter = 60.0;
  EXPECT_DOUBLE_EQ(object.tolerance(), 5.0);
  object.diameter = 180.0;
  EXPECT_DOUBLE_EQ(object.tolerance(), 9.0);
}

TEST(Scoring, tells_right_from_wrong_from_absent) {
  const std::vector<TrueObject> truth = {{0, {at(0)}, 1.0}};
  const auto verdict = [&](const Pose& reported) {
    return score_scene({box()}, truth, {{0, reported}}, never).reported.front();
  };
  EXPECT_EQ(verdict(at(5.0)), Verdict::right);
  EXPECT_EQ(verdict(at(5.3)), Verdict::wrong_pose);
  EXPECT_EQ(verdict(at(51.0)), Verdict::wrong_pose);
  EXPECT_EQ(verdict(at(51.5)), Verdict::false_positive);
}

TEST(Scoring, of_another_object_is_a_false_positive_wherever_it_is) {
  const std::vector<ScoredObject> objects = {box(), box()};
  const SceneVerdicts verdicts = score_scene(objects, {{0, {at(0)}, 1.0}}, {{1, at(0)}, {-1, at(0)}}, always);
  EXPECT_EQ(verdicts.reported, (std::vector{Verdict::false_positive, Verdict::false_positive}));
  EXPECT_EQ(verdicts.truth.front(), Verdict::missed);
  EXPECT_FALSE(verdicts.named.front());
}

TEST(Scoring, counts_each_instance_once) {
  const SceneVerdicts verdicts =
      score_scene({box()}, {{0, {at(0)}, 1.0}}, {{0, at(3)}, {0, at(1)}, {0, at(30)}}, never);
  EXPECT_EQ(verdicts.reported, (std::vector{Verdict::duplicate, Verdict::right, Verdict::wrong_pose}));
  EXPECT_EQ(verdicts.truth.front(), Verdict::right);
}

TEST(Scoring, gives_each_instance_of_one_object_its_own_report) {
  const std::vector<TrueObject> truth = {{0, {at(0)}, 1.0}, {0, {at(200)}, 1.0}, {0, {at(400)}, 1.0}};
  const SceneVerdicts verdicts = score_scene({box()}, truth, {{0, at(201)}, {0, at(2)}}, never);
  EXPECT_EQ(verdicts.reported, (std::vector{Verdict::right, Verdict::right}));
  EXPECT_EQ(verdicts.truth, (std::vector{Verdict::right, Verdict::right, Verdict::missed}));
  EXPECT_EQ(verdicts.named, (std::vector{true, true, false}));
}

TEST(Scoring, takes_an_equally_good_pose_for_right) {
  EXPECT_EQ(score_scene({box()}, {{0, {at(0)}, 1.0}}, {{0, turned(1)}}, never).reported.front(), Verdict::wrong_pose);
  EXPECT_EQ(score_scene({box()}, {{0, {at(0), turned(0)}, 1.0}}, {{0, turned(1)}}, never).reported.front(),
            Verdict::right);
}

TEST(Scoring, keeps_what_the_view_cannot_tell_apart_from_what_is_right) {
  const std::vector<TrueObject> truth = {{0, {at(0)}, 1.0}};
  EXPECT_EQ(score_scene({box()}, truth, {{0, turned(0)}}, always).reported.front(), Verdict::indistinguishable);
  EXPECT_EQ(score_scene({box()}, truth, {{0, turned(0)}}, never).reported.front(), Verdict::wrong_pose);
  EXPECT_EQ(score_scene({box()}, truth, {{0, at(1)}}, always).reported.front(), Verdict::right);
  // A right report takes the instance before an indistinguishable one does.
  const SceneVerdicts both = score_scene({box()}, truth, {{0, turned(0)}, {0, at(1)}}, always);
  EXPECT_EQ(both.reported, (std::vector{Verdict::wrong_pose, Verdict::right}));
}

TEST(Scoring, takes_a_report_with_a_right_alternative_for_declared) {
  const std::vector<ScoredObject> objects = {box(), box()};
  const std::vector<TrueObject> truth = {{0, {at(0)}, 1.0}};
  const auto verdicts = [&](const ReportedObject& report) { return score_scene(objects, truth, {report}, always); };
  for (const ReportedObject& report :
       {ReportedObject{0, turned(0), {{0, at(200)}, {0, at(2)}}},  // another pose of the object
        ReportedObject{0, at(300), {{0, at(2)}}},                  // the object elsewhere
        ReportedObject{1, at(0), {{0, at(2)}}}}) {                 // another object
    EXPECT_EQ(verdicts(report).reported.front(), Verdict::declared);
    EXPECT_EQ(verdicts(report).truth.front(), Verdict::declared);
  }
  EXPECT_EQ(verdicts({0, at(1), {{0, at(2)}}}).reported.front(), Verdict::right);
}

TEST(Scoring, asks_for_the_right_object_and_pose_among_the_alternatives) {
  const std::vector<ScoredObject> objects = {box(), box()};
  const std::vector<TrueObject> truth = {{0, {at(0)}, 1.0}};
  const auto verdict = [&](const ReportedObject& report) {
    return score_scene(objects, truth, {report}, never).reported.front();
  };
  EXPECT_EQ(verdict({0, turned(0), {{0, at(6)}, {1, at(0)}, {-1, at(0)}}}), Verdict::wrong_pose);
  EXPECT_EQ(verdict({1, at(0), {{0, turned(0)}}}), Verdict::false_positive);
}

TEST(Scoring, gives_an_instance_to_a_right_report_before_a_declaring_one) {
  const std::vector<ReportedObject> reported = {{0, at(300), {{0, at(0)}}}, {0, at(4)}};
  const SceneVerdicts verdicts = score_scene({box()}, {{0, {at(0)}, 1.0}}, reported, never);
  EXPECT_EQ(verdicts.reported, (std::vector{Verdict::duplicate, Verdict::right}));
  EXPECT_EQ(verdicts.truth.front(), Verdict::right);
  // One report declares one instance, not two.
  const SceneVerdicts two =
      score_scene({box()}, {{0, {at(0)}, 1.0}, {0, {at(200)}, 1.0}}, {{0, at(400), {{0, at(0)}, {0, at(200)}}}}, never);
  EXPECT_EQ(two.reported.front(), Verdict::declared);
  EXPECT_EQ(two.truth, (std::vector{Verdict::declared, Verdict::missed}));
}

TEST(Scoring, names_an_object_whatever_its_pose) {
  const SceneVerdicts verdicts = score_scene({box()}, {{0, {at(0)}, 1.0}}, {{0, turned(300)}}, never);
  EXPECT_EQ(verdicts.reported.front(), Verdict::false_positive);
  EXPECT_EQ(verdicts.truth.front(), Verdict::missed);
  EXPECT_TRUE(verdicts.named.front());
}

TEST(Scoring, of_nothing_reported_misses_everything) {
  const SceneVerdicts verdicts = score_scene({box()}, {{0, {at(0)}, 1.0}}, {}, never);
  EXPECT_TRUE(verdicts.reported.empty());
  EXPECT_EQ(verdicts.truth.front(), Verdict::missed);
  EXPECT_FALSE(verdicts.named.front());
}

}  // namespace
}  // namespace foresight
