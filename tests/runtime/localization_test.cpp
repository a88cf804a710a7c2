#include "runtime/localization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/random.h"
#include "runtime/nearest_data_point.h"
#include "runtime/robust_loss.h"
#include "tests/runtime/box_scene.h"

namespace foresight {
namespace {

using test::box_image;
using test::box_model;
using test::box_model_of_one_aspect;
using test::box_pose;
using test::kBoxCentre;
using test::moved;
using test::Screen;

constexpr double kDegree = 0.017453292519943295;
constexpr int kStarts = 50;

const ViewingSphere& sphere() {
  static const ViewingSphere s(kAspectCells);
  return s;
}

// The true pose moved by `mm` and turned by `degrees`, both in a direction of their own for every start.
Pose start_near(const Pose& truth, int start, double mm, double degrees) {
  Random random(7, static_cast<std::uint64_t>(start));
  const Eigen::Vector3d translation = mm * random.direction();
  return moved(truth, translation, degrees * kDegree * random.direction());
}

bool same(const Pose& a, const Pose& b) { return a.rotation == b.rotation && a.translation == b.translation; }

// Within so many millimetres and as many degrees.
bool close(const Pose& found, const Pose& truth, double tolerance) {
  return (found * kBoxCentre - truth * kBoxCentre).norm() < tolerance &&
         rotation_angle(found.rotation * truth.rotation.transpose()) < tolerance * kDegree;
}

struct Experiment {
  Loss loss = Loss::lorentzian;
  int starts = kStarts;
  double start_error = 10.0;  // mm and degrees
  double tolerance = 1.5;     // mm and degrees
};

struct Converged {
  int poses = 0;
  int evaluations = 0;
};

Converged count_converged(const RangeImage& image, const Experiment& experiment) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(image);
  LocalizationOptions options;
  options.loss = experiment.loss;
  options.most_rounds = 20;
  Converged converged;
  for (int i = 0; i < experiment.starts; ++i) {
    const Pose start = start_near(box_pose(), i, experiment.start_error, experiment.start_error);
    const Localization found = localize(model, sphere(), start, data, options);
    converged.poses += close(found.T_sensor_model, box_pose(), experiment.tolerance) ? 1 : 0;
    converged.evaluations += found.energy_evaluations;
  }
  return converged;
}

TEST(VisiblePoints, are_those_of_the_faces_turned_to_the_camera) {
  const CompiledModel model = box_model();
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Pose pose =
        moved(box_pose(), 100.0 * random.direction(), rotation_angle(random.rotation()) * random.direction());
    const PoolVector<int> visible = visible_points(model, sphere(), pose);
    EXPECT_TRUE(std::is_sorted(visible.begin(), visible.end()));
    const Eigen::Vector3d to_camera = (-(pose * kBoxCentre)).normalized();
    for (std::size_t i = 0; i < model.surface.points.size(); ++i) {
      double facing = -1.0;
      for (const int face : model.surface.points[i].faces) {
        facing = std::max(facing, to_camera.dot(pose.rotation * test::box_normal(face)));
      }
      const bool seen = std::binary_search(visible.begin(), visible.end(), static_cast<int>(i));
      // A cell of the sphere reaches up to about 22 degrees from its centre.
      if (facing > 0.5) {
        EXPECT_TRUE(seen) << facing;
      }
      if (facing < -0.3) {
        EXPECT_FALSE(seen) << facing;
      }
    }
  }
}

TEST(VisiblePoints, are_none_without_faces_in_the_aspect_or_from_the_centre) {
  CompiledModel model = box_model();
  model.centre = Eigen::Vector3d::Zero();
  EXPECT_TRUE(visible_points(model, sphere(), Pose{}).empty());
  for (std::vector<int>& aspect : model.surface.aspects) aspect.clear();
  EXPECT_TRUE(visible_points(model, sphere(), box_pose()).empty());
}

TEST(LocalizationEnergy, sums_rho_over_distances_to_the_nearest_data_points) {
  const CompiledModel model = box_model();
  RangeImage image(32, 32);
  image[5] = Eigen::Vector3f(10.0F, 20.0F, 850.0F);
  const NearestDataPoint data(image);
  for (const Loss loss : {Loss::lorentzian, Loss::tukey, Loss::huber, Loss::gaussian}) {
    LocalizationOptions options;
    options.loss = loss;
    options.sigma = 20.0;
    const PoolVector<int> visible = {0, 17, 100};
    double expected = 0.0;
    for (const int i : visible) {
      const Eigen::Vector3d x = box_pose() * model.surface.points[static_cast<std::size_t>(i)].position.cast<double>();
      expected += rho(loss, (x - Eigen::Vector3d(10.0, 20.0, 850.0)).norm() / 20.0);
    }
    EXPECT_NEAR(localization_energy(model, visible, box_pose(), data, options), expected, 1e-9 * expected);
  }
}

TEST(LocalizationEnergy, is_least_near_the_true_pose) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  const PoolVector<int> visible = visible_points(model, sphere(), box_pose());
  const double at_truth = localization_energy(model, visible, box_pose(), data, {});
  for (int i = 0; i < kStarts; ++i) {
    EXPECT_GT(localization_energy(model, visible, start_near(box_pose(), i, 3.0, 3.0), data, {}), at_truth);
  }
}

TEST(EnergyGradient, agrees_with_finite_differences) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  for (const Loss loss : {Loss::lorentzian, Loss::tukey, Loss::huber, Loss::gaussian}) {
    LocalizationOptions options;
    options.loss = loss;
    for (int i = 0; i < 5; ++i) {
      const Pose pose = start_near(box_pose(), i, 6.0, 6.0);
      const PoolVector<int> visible = visible_points(model, sphere(), pose);
      const auto energy = [&](const Eigen::Vector3d& translation, const Eigen::Vector3d& v) {
        return localization_energy(model, visible, moved(pose, translation, v), data, options);
      };
      const EnergyGradient gradient =
          energy_gradient(evaluate_energy(model, visible, pose, data, options), pose * model.centre, options);
      const Eigen::Vector3d none = Eigen::Vector3d::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d h = 1e-4 * Eigen::Vector3d::Unit(axis);
        const Eigen::Vector3d r = 1e-6 * Eigen::Vector3d::Unit(axis);
        EXPECT_NEAR(gradient.translation[axis], (energy(h, none) - energy(-h, none)) / 2e-4,
                    1e-3 * gradient.translation.norm());
        EXPECT_NEAR(gradient.rotation[axis], (energy(none, r) - energy(none, -r)) / 2e-6,
                    1e-3 * gradient.rotation.norm());
      }
    }
  }
}

TEST(EnergyGradient, is_zero_where_every_point_lies_on_its_data_point) {
  EnergyEvaluation evaluation;
  evaluation.residuals = {{{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}, 0.0}, {{4.0, 2.0, 3.0}, {4.0, 2.0, 3.0}, 0.0}};
  const EnergyGradient gradient = energy_gradient(evaluation, Eigen::Vector3d::Zero(), {});
  EXPECT_EQ(gradient.translation, Eigen::Vector3d::Zero());
  EXPECT_EQ(gradient.rotation, Eigen::Vector3d::Zero());
}

TEST(Localization, never_raises_the_energy_within_one_aspect) {
  const CompiledModel model = box_model_of_one_aspect();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  for (const Loss loss : {Loss::lorentzian, Loss::tukey, Loss::huber, Loss::gaussian}) {
    for (int i = 0; i < 2; ++i) {
      LocalizationOptions options;
      options.loss = loss;
      const Pose start = start_near(box_pose(), i, 10.0, 10.0);
      double energy = localization_energy(model, visible_points(model, sphere(), start), start, data, options);
      for (const int rounds : {1, 2, 20}) {  // longer refinements go on where shorter ones end
        options.most_rounds = rounds;
        const double next = localize(model, sphere(), start, data, options).energy;
        EXPECT_LE(next, energy);
        energy = next;
      }
    }
  }
}

TEST(Localization, reports_the_energy_of_its_pose) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  for (const int rounds : {1, 2, 50}) {
    LocalizationOptions options;
    options.most_rounds = rounds;
    for (int i = 0; i < 10; ++i) {
      const Localization found = localize(model, sphere(), start_near(box_pose(), i, 15.0, 15.0), data, options);
      const PoolVector<int> visible = visible_points(model, sphere(), found.T_sensor_model);
      EXPECT_EQ(found.energy, localization_energy(model, visible, found.T_sensor_model, data, options));
    }
  }
}

TEST(Localization, takes_whole_steps_and_counts_every_evaluation) {
  const CompiledModel model = box_model_of_one_aspect();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  LocalizationOptions options;
  options.most_rounds = 1;
  options.translation_step = 0.7;
  options.rotation_step = 0.5 * kDegree;
  for (int i = 0; i < 10; ++i) {
    const Pose start = start_near(box_pose(), i, 10.0, 10.0);
    const Localization found = localize(model, sphere(), start, data, options);
    const double steps = (found.T_sensor_model * kBoxCentre - start * kBoxCentre).norm() / 0.7;
    const double turns = rotation_angle(found.T_sensor_model.rotation * start.rotation.transpose()) / (0.5 * kDegree);
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_NEAR(turns, std::round(turns), 1e-9);
    // The start, and in each of the two line searches every step and the trial that ended it.
    EXPECT_EQ(found.energy_evaluations, 1 + std::lround(steps) + 1 + std::lround(turns) + 1);
  }
}

TEST(Localization, stops_where_a_second_refinement_takes_no_step) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  for (int i = 0; i < 20; ++i) {
    const Localization found = localize(model, sphere(), start_near(box_pose(), i, 10.0, 10.0), data, {});
    const Localization again = localize(model, sphere(), found.T_sensor_model, data, {});
    EXPECT_TRUE(same(again.T_sensor_model, found.T_sensor_model));
    EXPECT_EQ(again.energy, found.energy);
    EXPECT_EQ(again.energy_evaluations, 3);  // the start, one trial in translation, one in rotation
  }
}

TEST(Localization, keeps_the_rotation_a_rotation) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  for (int i = 0; i < 15; ++i) {
    const Localization found = localize(model, sphere(), start_near(box_pose(), i, 20.0, 20.0), data, {});
    EXPECT_TRUE(is_rotation(found.T_sensor_model.rotation, 1e-14));
  }
}

TEST(Localization, converges_from_10_mm_and_10_degrees) {
  const Converged lorentzian = count_converged(box_image(box_pose(), PinholeCamera{}), {});
  EXPECT_GE(lorentzian.poses, 45);
  EXPECT_LT(lorentzian.evaluations, 100 * kStarts);
}

// A screen hides 57 and 115 of the 284 visible points. All outliers lie on one side and pull together, so that the
// least energy itself moves off the true pose: by about 1 and 4 degrees for the Lorentzian, anywhere for the Gaussian.
TEST(Localization, survives_a_screen_before_a_fifth_of_the_object_with_the_lorentzian_only) {
  const RangeImage image = box_image(box_pose(), PinholeCamera{}, {Screen{800.0, 0, 115}});
  EXPECT_GE(count_converged(image, {Loss::lorentzian, 20, 5.0, 2.5}).poses, 18);
  EXPECT_GE(count_converged(image, {Loss::tukey, 20, 5.0, 2.5}).poses, 18);
  EXPECT_LE(count_converged(image, {Loss::gaussian, 20, 5.0, 2.5}).poses, 2);
}

TEST(Localization, comes_near_behind_a_screen_before_half_of_the_object_with_the_lorentzian_only) {
  const RangeImage image = box_image(box_pose(), PinholeCamera{}, {Screen{800.0, 0, 127}});
  EXPECT_GE(count_converged(image, {Loss::lorentzian, 10, 5.0, 5.0}).poses, 8);
  EXPECT_GE(count_converged(image, {Loss::tukey, 10, 5.0, 5.0}).poses, 8);
  EXPECT_EQ(count_converged(image, {Loss::gaussian, 10, 5.0, 5.0}).poses, 0);
}

TEST(Localization, goes_the_same_way_in_a_model_frame_with_another_origin) {
  // Steps turn about the model's centre: where the CAD file has its origin makes no difference.
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  const Eigen::Vector3d shift(500.0, 300.0, -200.0);
  CompiledModel shifted = box_model();
  shifted.centre += shift;
  for (TemplatePoint& point : shifted.surface.points) point.position += shift.cast<float>();
  for (int i = 0; i < 10; ++i) {
    const Pose start = start_near(box_pose(), i, 10.0, 10.0);
    const Pose shifted_start{start.rotation, start.translation - start.rotation * shift};
    const Pose here = localize(box_model(), sphere(), start, data, {}).T_sensor_model;
    const Pose there = localize(shifted, sphere(), shifted_start, data, {}).T_sensor_model;
    EXPECT_LT((here.rotation - there.rotation).norm(), 1e-3);
    EXPECT_LT((here * kBoxCentre - there * (kBoxCentre + shift)).norm(), 0.1);
  }
}

TEST(Localization, ends_within_its_cap_when_the_aspect_alternates) {
  // Every aspect shows one other face: each step may change what is seen.
  CompiledModel model = box_model();
  for (int cell = 0; cell < kAspectCells; ++cell) model.surface.aspects[static_cast<std::size_t>(cell)] = {cell % 6};
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  int capped = 0;
  for (int i = 0; i < 4; ++i) {
    const Localization found = localize(model, sphere(), start_near(box_pose(), i, 10.0, 20.0), data, {});
    EXPECT_TRUE(std::isfinite(found.energy));
    EXPECT_LT(found.energy_evaluations, 10000);
    capped += localize(model, sphere(), found.T_sensor_model, data, {}).energy_evaluations > 3 ? 1 : 0;
  }
  EXPECT_GT(capped, 0);  // the cap was needed
}

TEST(Localization, returns_a_start_in_which_nothing_is_visible) {
  CompiledModel model = box_model();
  for (std::vector<int>& aspect : model.surface.aspects) aspect.clear();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  const Localization found = localize(model, sphere(), box_pose(), data, {});
  EXPECT_TRUE(same(found.T_sensor_model, box_pose()));
  EXPECT_EQ(found.energy, 0.0);
}

TEST(Localization, gives_the_same_bits_again) {
  const Pose start = start_near(box_pose(), 3, 10.0, 10.0);
  const auto run = [&start] {
    const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
    return localize(box_model(), sphere(), start, data, {});
  };
  const Localization first = run();
  const Localization second = run();
  EXPECT_TRUE(same(first.T_sensor_model, second.T_sensor_model));
  EXPECT_EQ(first.energy, second.energy);
  EXPECT_EQ(first.energy_evaluations, second.energy_evaluations);
}

LocalizationOptions reaching(double reach) {
  LocalizationOptions options;
  options.reach = reach;
  return options;
}

TEST(LocalizationReach, a_reach_beyond_all_data_changes_nothing) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  for (int i = 0; i < 5; ++i) {
    const Pose start = start_near(box_pose(), i, 8.0, 8.0);
    const Localization all = localize(model, sphere(), start, data, {});
    const Localization reached = localize(model, sphere(), start, data, reaching(1e4));
    EXPECT_TRUE(same(all.T_sensor_model, reached.T_sensor_model)) << i;
    EXPECT_EQ(all.energy, reached.energy);
    EXPECT_EQ(all.energy_evaluations, reached.energy_evaluations);
  }
}

// What an evaluation near by spares must not show in the sum.
TEST(LocalizationReach, an_evaluation_near_by_changes_no_energy) {
  const CompiledModel model = box_model();
  const RangeImage image = box_image(box_pose(), PinholeCamera{});
  const NearestDataPoint data(image);
  const LocalizationOptions options = reaching(6.0);
  for (int i = 0; i < 5; ++i) {
    Pose pose = start_near(box_pose(), i, 15.0, 10.0);
    const PoolVector<int> visible = visible_points(model, sphere(), pose);
    EnergyEvaluation before = evaluate_energy(model, visible, pose, data, options);
    int nowhere = 0;
    for (int step = 0; step < 12; ++step) {
      pose = start_near(pose, step, 0.9, 0.7);
      const EnergyEvaluation after = evaluate_energy(model, visible, pose, data, options, &before);
      EXPECT_NEAR(after.energy, evaluate_energy(model, visible, pose, data, options).energy, 1e-9 * after.energy);
      for (const auto& residual : after.residuals) nowhere += residual.data_index < 0 ? 1 : 0;
      before = after;
    }
    EXPECT_GT(nowhere, 100);
  }
}

TEST(LocalizationPoints, a_share_of_them_comes_as_near) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  LocalizationOptions few;
  few.most_points = 120;
  int all_come = 0;
  int few_come = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose start = start_near(box_pose(), i, 8.0, 6.0);
    all_come += close(localize(model, sphere(), start, data, {}).T_sensor_model, box_pose(), 1.5) ? 1 : 0;
    few_come += close(localize(model, sphere(), start, data, few).T_sensor_model, box_pose(), 1.5) ? 1 : 0;
  }
  EXPECT_GT(all_come, 15);
  EXPECT_GE(few_come, all_come - 2);
  const Pose start = start_near(box_pose(), 1, 8.0, 6.0);
  few.most_points = 100000;
  EXPECT_TRUE(same(localize(model, sphere(), start, data, few).T_sensor_model,
                   localize(model, sphere(), start, data, {}).T_sensor_model));
}

TEST(LocalizationReach, points_without_data_near_count_as_at_the_reach) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  const Pose pose = start_near(box_pose(), 1, 12.0, 10.0);
  const PoolVector<int> visible = visible_points(model, sphere(), pose);
  const EnergyEvaluation all = evaluate_energy(model, visible, pose, data, {});
  const LocalizationOptions options = reaching(5.0);
  const EnergyEvaluation near = evaluate_energy(model, visible, pose, data, options);
  ASSERT_EQ(all.residuals.size(), near.residuals.size());
  double energy = 0.0;
  int beyond = 0;
  for (std::size_t i = 0; i < all.residuals.size(); ++i) {
    const bool reached = all.residuals[i].distance < options.reach;
    EXPECT_EQ(near.residuals[i].data_index >= 0, reached);
    EXPECT_NEAR(near.residuals[i].distance, reached ? all.residuals[i].distance : options.reach, 1e-4);
    energy += rho(options.loss, near.residuals[i].distance / options.sigma);
    beyond += reached ? 0 : 1;
  }
  EXPECT_NEAR(near.energy, energy, 1e-6);
  EXPECT_LT(near.energy, all.energy);
  EXPECT_GT(beyond, 10);
  EXPECT_LT(beyond, static_cast<int>(all.residuals.size()) - 10);
}

TEST(LocalizationReach, points_without_data_near_pull_nowhere) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  const Pose far = moved(box_pose(), {0, 0, 100}, {0, 0, 0});
  const PoolVector<int> visible = visible_points(model, sphere(), far);
  const LocalizationOptions options = reaching(20.0);
  const EnergyGradient gradient =
      energy_gradient(evaluate_energy(model, visible, far, data, options), far * kBoxCentre, options);
  EXPECT_NEAR(gradient.translation.norm(), 0.0, 1e-3);
  const EnergyGradient pulled = energy_gradient(evaluate_energy(model, visible, far, data, {}), far * kBoxCentre, {});
  EXPECT_GT(pulled.translation.norm(), 1.0);
  EXPECT_TRUE(same(localize(model, sphere(), far, data, options).T_sensor_model, far));
  EXPECT_FALSE(same(localize(model, sphere(), far, data, {}).T_sensor_model, far));
}

TEST(LocalizationReach, starts_near_the_truth_converge_all_the_same) {
  const CompiledModel model = box_model();
  const NearestDataPoint data(box_image(box_pose(), PinholeCamera{}));
  int converged = 0;
  for (int i = 0; i < 20; ++i) {
    const Localization found = localize(model, sphere(), start_near(box_pose(), i, 8.0, 6.0), data, reaching(20.0));
    converged += close(found.T_sensor_model, box_pose(), 1.5) ? 1 : 0;
  }
  EXPECT_GE(converged, 18);
}

}  // namespace
}  // namespace foresight
