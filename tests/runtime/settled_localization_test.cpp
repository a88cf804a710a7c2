#include "runtime/settled_localization.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "runtime/nearest_data_cell.h"
#include "tests/runtime/learned_database.h"

namespace foresight {
namespace {

using Eigen::Vector3d;
using test::box_pose;
using test::kBoxCentre;
using test::SeenScan;

constexpr double kDegree = std::numbers::pi / 180.0;

const Database& database() {
  static const Database loaded = test::database_of({test::box_model()});
  return loaded;
}
const CompiledModel& box() { return database().models()[0]; }

// A scan with what both localizations need.
struct Scene {
  SeenScan seen;
  PinholeCamera camera;
  NearestDataCell data;
  ScanContext context;
  LabelledScan labelled;
  PoseChecker settling;

  explicit Scene(const RangeImage& image)
      : seen(image),
        data(seen.image, camera),
        context{seen.image, camera, database(), seen.regions, data},
        labelled(seen.labelled()),
        settling(database(), labelled, settling_options(seen.sensor)) {}
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  Localization settled(const Pose& start) {
    return localize_and_settle(context, labelled, 0, start, {}, settling).localization;
  }
  [[nodiscard]] Localization plain(const Pose& start) const {
    const LocalizationOptions options = near_localization_options({});
    return localize(box(), context.sphere, start, context.data, options);
  }
  // How much the scan agrees, less how much it disagrees.
  [[nodiscard]] double balance(const Pose& pose) const {
    EvidenceOptions fine;
    fine.distance = agreeing_distance(seen.sensor);
    const PoseEvidence e = gather_evidence(box(), pose, labelled, fine);
    return e.owned - e.behind - e.tilted - e.front;
  }
};

Pose start_near(const Pose& truth, std::uint64_t index, double mm, double degrees) {
  Random random(31, index);
  const Vector3d shift = mm * random.direction();
  return test::moved(truth, shift, degrees * kDegree * random.direction());
}

double turn_between(const Pose& a, const Pose& b) { return rotation_angle(a.rotation.transpose() * b.rotation); }
double distance_between(const Pose& a, const Pose& b) { return (a * kBoxCentre - b * kBoxCentre).norm(); }

TEST(SettledLocalization, ends_nearer_to_the_truth_than_localization_alone) {
  Scene scene(test::box_image(box_pose(), PinholeCamera{}));
  double plain_distance = 0.0;
  double plain_turn = 0.0;
  double settled_distance = 0.0;
  double settled_turn = 0.0;
  constexpr int kStarts = 15;
  for (std::uint64_t index = 0; index < kStarts; ++index) {
    const Pose start = start_near(box_pose(), index, 4.0, 3.0);
    const Pose plain = scene.plain(start).T_sensor_model;
    const Pose settled = scene.settled(start).T_sensor_model;
    plain_distance += distance_between(plain, box_pose());
    plain_turn += turn_between(plain, box_pose());
    settled_distance += distance_between(settled, box_pose());
    settled_turn += turn_between(settled, box_pose());
  }
  EXPECT_LT(settled_distance, 0.7 * plain_distance);
  EXPECT_LT(settled_turn, 0.7 * plain_turn);
  EXPECT_LT(settled_distance / kStarts, 0.5);
  EXPECT_LT(settled_turn / kStarts, 0.5 * kDegree);
}

TEST(SettledLocalization, the_scan_never_agrees_less_with_the_settled_pose) {
  for (const auto& screens : {std::vector<test::Screen>{}, std::vector<test::Screen>{{700.0, 0, 110}}}) {
    Scene scene(test::box_image(box_pose(), PinholeCamera{}, screens));
    for (std::uint64_t index = 0; index < 12; ++index) {
      for (const double off : {3.0, 15.0, 60.0}) {
        const Pose start = start_near(box_pose(), index, off, off);
        const Localization plain = scene.plain(start);
        const Localization settled = scene.settled(start);
        EXPECT_GE(scene.balance(settled.T_sensor_model), scene.balance(plain.T_sensor_model)) << index << " " << off;
        EXPECT_EQ(settled.energy_evaluations, plain.energy_evaluations);
        EXPECT_TRUE(is_rotation(settled.T_sensor_model.rotation, 1e-9));
      }
    }
  }
}

TEST(SettledLocalization, keeps_the_localized_pose_where_no_plane_is_near) {
  // Far from the object nothing is pulled and nothing settles.
  Scene scene(test::box_image(box_pose(), PinholeCamera{}));
  const Pose start = test::moved(box_pose(), {0, 0, 200}, {0, 0, 0});
  const Pose settled = scene.settled(start).T_sensor_model;
  EXPECT_LT(distance_between(settled, start), 1e-9);
  EXPECT_LT(turn_between(settled, start), 1e-6);
}

TEST(SettledLocalization, gives_the_same_bits_again) {
  const Pose start = start_near(box_pose(), 3, 5.0, 4.0);
  const RangeImage image = test::box_image(box_pose(), PinholeCamera{});
  Scene first(image);
  Scene second(image);
  (void)second.settled(start_near(box_pose(), 4, 9.0, 9.0));
  const Pose a = first.settled(start).T_sensor_model;
  const Pose b = second.settled(start).T_sensor_model;
  EXPECT_EQ(a.rotation, b.rotation);
  EXPECT_EQ(a.translation, b.translation);
}

TEST(SettlingOptions, look_farther_the_noisier_the_sensor) {
  SensorModel quiet;
  quiet.depth_noise = 0.0;
  quiet.depth_quantization = 0.0;
  SensorModel noisy = quiet;
  noisy.depth_noise = 2.0;
  EXPECT_GT(settling_options(noisy).distance, settling_options(quiet).distance);
  EXPECT_GT(settling_options(quiet).distance, agreeing_distance(quiet));
}

}  // namespace
}  // namespace foresight
