#include "runtime/recognize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "common/errors.h"
#include "runtime/canonical_pose.h"
#include "tests/images.h"
#include "tests/runtime/compiled_objects.h"

namespace foresight {
namespace {

using test::castle_and_stick;
using test::compiled_objects;
using test::pose_of;
using test::surface_distance;
using test::visible_scene;

const PinholeCamera& camera() { return compiled_objects().content().sensor.camera; }

RecognitionResult recognize_in(const RangeImage& image, const RecognizeOptions& options = {},
                               const Deadline& deadline = {}) {
  return recognize(image, camera(), compiled_objects(), options, deadline);
}

constexpr std::array<Method, 2> kMethods = {Method::two_way, Method::paper};

RecognizeOptions with(Method method) {
  RecognizeOptions options;
  options.method = method;
  return options;
}

const Scene& one_object() {
  static const Scene scene = visible_scene(1, 0);
  return scene;
}

const Scene& two_objects() {
  static const Scene scene = visible_scene(2, 0);
  return scene;
}

// Whether a detection is an object of the scene at its place.
bool is_right(const Detection& detection, const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& object) {
    const CompiledModel& model = compiled_objects().models()[static_cast<std::size_t>(object.model)];
    return detection.object == model.name && surface_distance(model, pose_of(detection), object.T_sensor_model) < 5.0;
  });
}

void expect_consistent(const RecognitionResult& result) {
  const Statistics& s = result.statistics;
  EXPECT_EQ(s.possible_matches, s.regions * static_cast<long>(compiled_objects().faces().size()));
  EXPECT_LE(s.threshold_matches, s.possible_matches);
  EXPECT_LE(s.active_matches, s.threshold_matches);
  EXPECT_LE(s.verifications, s.hypotheses);
  EXPECT_TRUE(s.pose_checks == 0 || s.pose_checks >= s.verifications);  // 0: the paper's method
  EXPECT_GE(s.energy_evaluations, s.verifications);
  EXPECT_LE(static_cast<long>(result.detections.size()), s.verifications);
  const StageTimes& t = result.milliseconds;
  for (const double time : {t.extract, t.field, t.hypotheses, t.localize, t.verify}) EXPECT_GE(time, 0.0);
  EXPECT_LE(t.extract + t.field + t.hypotheses + t.localize + t.verify, t.total + 0.001);
}

void expect_well_formed(const RecognitionResult& result, const RecognizeOptions& options) {
  std::set<int> regions;
  int last_rank = 0;
  for (const Detection& detection : result.detections) {
    EXPECT_TRUE(is_rotation(pose_of(detection).rotation));
    EXPECT_EQ(detection.T_sensor_model[15], 1.0);
    if (options.method == Method::paper) {
      EXPECT_GE(detection.matched, options.smallest_matched);
      EXPECT_GE(detection.coherent, options.smallest_coherent);
      EXPECT_LE(detection.occluding, options.largest_occluding);
      EXPECT_EQ(detection.score, detection.matched);
      EXPECT_GT(detection.rank, last_rank) << "detections come in the order of their hypotheses";
      EXPECT_TRUE(detection.faces.size() == 2 || detection.faces.size() == 3);
    } else {
      EXPECT_GE(detection.score, 0.5);
      EXPECT_LE(detection.score, 1.0);
      EXPECT_GE(detection.rank, 1);
    }
    EXPECT_LE(detection.rank, result.statistics.hypotheses);
    last_rank = detection.rank;
    EXPECT_FALSE(detection.faces.empty());
    EXPECT_EQ(detection.regions.size(), detection.faces.size());
    for (const int region : detection.regions) {
      EXPECT_GE(region, 0);
      EXPECT_LT(region, result.statistics.regions);
      EXPECT_TRUE(regions.insert(region).second) << "two detections rest on region " << region;
    }
  }
}

void expect_same(const RecognitionResult& a, const RecognitionResult& b) {
  EXPECT_EQ(a.complete, b.complete);
  ASSERT_EQ(a.detections.size(), b.detections.size());
  for (std::size_t i = 0; i < a.detections.size(); ++i) {
    EXPECT_EQ(a.detections[i].object, b.detections[i].object);
    EXPECT_EQ(a.detections[i].T_sensor_model, b.detections[i].T_sensor_model);
    EXPECT_EQ(a.detections[i].score, b.detections[i].score);
    EXPECT_EQ(a.detections[i].rank, b.detections[i].rank);
    EXPECT_EQ(a.detections[i].faces, b.detections[i].faces);
    EXPECT_EQ(a.detections[i].regions, b.detections[i].regions);
  }
  EXPECT_EQ(a.statistics.active_matches, b.statistics.active_matches);
  EXPECT_EQ(a.statistics.hypotheses, b.statistics.hypotheses);
  EXPECT_EQ(a.statistics.verifications, b.statistics.verifications);
  EXPECT_EQ(a.statistics.energy_evaluations, b.statistics.energy_evaluations);
}

TEST(Recognize, finds_an_object_with_three_visible_faces_at_its_pose) {
  for (std::uint64_t index = 0; index < 10; ++index) {
    const Scene scene = visible_scene(1, index);
    for (const Method method : kMethods) {
      const RecognitionResult result = recognize_in(scene.scan.image, with(method));
      EXPECT_TRUE(result.complete);
      ASSERT_FALSE(result.detections.empty()) << "scene " << index;
      EXPECT_TRUE(is_right(result.detections[0], scene)) << "scene " << index;
      expect_consistent(result);
      expect_well_formed(result, with(method));
    }
  }
}

TEST(Recognize, finds_both_of_two_objects) {
  for (const Method method : kMethods) {
    const RecognitionResult result = recognize_in(two_objects().scan.image, with(method));
    ASSERT_EQ(result.detections.size(), 2U);
    EXPECT_NE(result.detections[0].object, result.detections[1].object);
    for (const Detection& detection : result.detections)
      EXPECT_TRUE(is_right(detection, two_objects())) << detection.object;
    expect_consistent(result);
    expect_well_formed(result, with(method));
  }
}

TEST(Recognize, gives_the_same_result_twice) {
  for (const Method method : kMethods) {
    expect_same(recognize_in(two_objects().scan.image, with(method)),
                recognize_in(two_objects().scan.image, with(method)));
  }
}

// Scenes that show the castle, which has three symmetries beside the identity.
std::vector<Scene> castle_scenes() {
  std::vector<Scene> scenes;
  for (std::uint64_t index = 0; scenes.size() < 5; ++index) {
    Scene scene = visible_scene(1, index);
    if (scene.objects[0].model == 0) scenes.push_back(std::move(scene));
  }
  return scenes;
}

TEST(Recognize, reports_the_canonical_one_of_equivalent_poses_by_default) {
  const CompiledModel& castle = compiled_objects().models()[0];
  for (const Scene& scene : castle_scenes()) {
    const RecognitionResult result = recognize_in(scene.scan.image);
    ASSERT_FALSE(result.detections.empty());
    const Detection& detection = result.detections[0];
    ASSERT_EQ(detection.object, castle.name);
    EXPECT_TRUE(is_right(detection, scene));
    const Pose pose = pose_of(detection);
    EXPECT_TRUE(canonical_pose(castle, pose).rotation.isApprox(pose.rotation, 1e-12));
    const Pose truth = canonical_pose(castle, scene.objects[0].T_sensor_model);
    EXPECT_LT(rotation_angle(truth.rotation.transpose() * pose.rotation), 0.1);
  }
}

TEST(Recognize, reports_poses_as_found_with_the_papers_method) {
  const CompiledModel& castle = compiled_objects().models()[0];
  int others = 0;
  for (const Scene& scene : castle_scenes()) {
    for (const Detection& detection : recognize_in(scene.scan.image, with(Method::paper)).detections) {
      if (detection.object != castle.name) continue;
      const Pose pose = pose_of(detection);
      others += canonical_pose(castle, pose).rotation.isApprox(pose.rotation, 1e-12) ? 0 : 1;
    }
  }
  EXPECT_GT(others, 0) << "one of four is canonical by chance";
}

TEST(Recognize, lists_faces_that_lie_at_the_reported_pose_where_their_regions_are) {
  for (const Scene& scene : castle_scenes()) {
    const auto regions = extract_regions(scene.scan.image, camera(), compiled_objects().content().segmentation);
    for (const Method method : kMethods) {
      for (const Detection& detection : recognize_in(scene.scan.image, with(method)).detections) {
        if (!is_right(detection, scene)) continue;
        const CompiledModel& model = compiled_objects().models()[detection.object == "castle" ? 0 : 1];
        const Pose pose = pose_of(detection);
        for (std::size_t i = 0; i < detection.faces.size(); ++i) {
          const ModelFace& face = model.faces[static_cast<std::size_t>(detection.faces[i])];
          const DescribedRegion& region = regions[static_cast<std::size_t>(detection.regions[i])];
          EXPECT_GT((pose.rotation * face.normal).dot(region.region.normal), 0.9);
          EXPECT_LT(std::abs((pose.inverse() * region.centroid).dot(face.normal) - face.offset), 4.0);
        }
      }
    }
  }
}

TEST(Recognize, finds_nothing_in_an_empty_image) {
  const RecognitionResult result = recognize_in(RangeImage(camera().rows, camera().columns));
  EXPECT_TRUE(result.complete);
  EXPECT_TRUE(result.detections.empty());
  EXPECT_EQ(result.statistics.regions, 0);
  EXPECT_EQ(result.statistics.verifications, 0);
  expect_consistent(result);
}

TEST(Recognize, finds_nothing_on_an_unknown_plane) {
  const RangeImage wall = test::render({test::facing({0, 0, 900}, 1000, 1000)}, camera());
  const RangeImage card = test::render({test::facing({0, 0, 900}, 90, 55)}, camera());
  for (const RangeImage& image : {wall, card}) {
    for (const Method method : kMethods) {
      const RecognitionResult result = recognize_in(image, with(method));
      EXPECT_TRUE(result.complete);
      EXPECT_EQ(result.statistics.regions, 1);
      EXPECT_TRUE(result.detections.empty());
    }
  }
}

TEST(Recognize, finds_nothing_in_stray_points) {
  RangeImage image(camera().rows, camera().columns);
  Random random(5);
  for (int cell = 0; cell < image.size(); ++cell) {
    const double depth = random.uniform(600.0, 1200.0);
    image[cell] = (depth * camera().ray(cell / image.columns, cell % image.columns)).cast<float>();
  }
  for (const Method method : kMethods) EXPECT_TRUE(recognize_in(image, with(method)).detections.empty());
}

TEST(Recognize, stops_at_a_deadline_and_says_so) {
  for (const Method method : kMethods) {
    const auto past = std::chrono::steady_clock::now() - std::chrono::seconds(1);
    const RecognitionResult late = recognize_in(one_object().scan.image, with(method), past);
    EXPECT_FALSE(late.complete);
    EXPECT_TRUE(late.detections.empty());
    EXPECT_EQ(late.statistics.verifications, 0);
    EXPECT_EQ(late.statistics.regions, 0);  // not even extraction was begun
    const auto far = std::chrono::steady_clock::now() + std::chrono::hours(1);
    expect_same(recognize_in(one_object().scan.image, with(method), far),
                recognize_in(one_object().scan.image, with(method)));
  }
}

// Wherever a deadline falls, what is reported by then is right, and less than everything is called incomplete.
TEST(Recognize, an_answer_cut_short_says_so_and_is_still_right) {
  const RecognitionResult whole = recognize_in(two_objects().scan.image, {});
  int incomplete = 0;
  for (const double share : {0.01, 0.1, 0.2, 0.4, 0.6, 0.8}) {
    const auto allowed = std::chrono::duration<double, std::milli>(share * whole.milliseconds.total);
    const auto deadline =
        std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(allowed);
    const RecognitionResult cut = recognize_in(two_objects().scan.image, {}, deadline);
    if (cut.complete) continue;
    ++incomplete;
    EXPECT_LE(cut.detections.size(), whole.detections.size());
    for (const Detection& detection : cut.detections) {
      EXPECT_TRUE(std::any_of(whole.detections.begin(), whole.detections.end(),
                              [&](const Detection& other) { return other.object == detection.object; }));
    }
  }
  EXPECT_GT(incomplete, 0);
}

TEST(Recognize, stops_after_the_detections_asked_for) {
  for (const Method method : kMethods) {
    RecognizeOptions one = with(method);
    one.most_detections = 1;
    const RecognitionResult all = recognize_in(two_objects().scan.image, with(method));
    const RecognitionResult first = recognize_in(two_objects().scan.image, one);
    ASSERT_EQ(first.detections.size(), 1U);
    EXPECT_TRUE(first.complete);
    EXPECT_EQ(first.detections[0].T_sensor_model, all.detections[0].T_sensor_model);
    EXPECT_LT(first.statistics.verifications, all.statistics.verifications);
  }
}

TEST(Recognize, stops_after_the_verifications_asked_for) {
  RecognizeOptions options = with(Method::paper);
  options.smallest_matched = 1.0;  // nothing is accepted, so that every hypothesis would be verified
  options.smallest_coherent = 1.0;
  options.largest_occluding = 0.0;
  for (const int most : {1, 3}) {
    options.most_verifications = most;
    EXPECT_EQ(recognize_in(two_objects().scan.image, options).statistics.verifications, most);
  }
}

TEST(Recognize, keeps_more_matches_active_without_pruning) {
  RecognizeOptions unpruned = with(Method::paper);
  unpruned.pruning = Pruning::none;
  const RecognitionResult all = recognize_in(one_object().scan.image, unpruned);
  const RecognitionResult pruned = recognize_in(one_object().scan.image, with(Method::paper));
  EXPECT_EQ(all.statistics.threshold_matches, pruned.statistics.threshold_matches);
  EXPECT_EQ(all.statistics.active_matches, all.statistics.threshold_matches);
  EXPECT_GE(all.statistics.active_matches, pruned.statistics.active_matches);
  EXPECT_GE(all.statistics.hypotheses, pruned.statistics.hypotheses);
  expect_consistent(all);
  ASSERT_FALSE(all.detections.empty());
  EXPECT_TRUE(is_right(all.detections[0], one_object()));
}

TEST(Recognize, runs_with_every_loss_and_prior_sign) {
  for (const Loss loss : {Loss::lorentzian, Loss::tukey, Loss::huber, Loss::gaussian}) {
    for (const PriorSign sign : {PriorSign::minus_log, PriorSign::plus_log_as_printed}) {
      for (const Method method : kMethods) {
        RecognizeOptions options = with(method);
        options.loss = loss;
        options.potentials.prior_sign = sign;
        const RecognitionResult result = recognize_in(one_object().scan.image, options);
        expect_consistent(result);
        expect_well_formed(result, options);
        if (loss != Loss::gaussian) {
          ASSERT_FALSE(result.detections.empty());
          EXPECT_TRUE(is_right(result.detections[0], one_object()));
        }
      }
    }
  }
}

TEST(RefineAndVerify, brings_a_rough_pose_home) {
  const SceneObject& object = one_object().objects[0];
  const CompiledModel& model = compiled_objects().models()[static_cast<std::size_t>(object.model)];
  const Pose& truth = object.T_sensor_model;
  const Pose turn{rotation_from_vector({0.05, -0.04, 0.05}), {0, 0, 0}};
  const Pose centre{Eigen::Matrix3d::Identity(), model.centre};
  Pose rough = truth * centre * turn * centre.inverse();
  rough.translation += Eigen::Vector3d(4.0, -3.0, 5.0);
  ASSERT_GT(surface_distance(model, rough, truth), 5.0);
  const RefinedPose refined = refine_and_verify(one_object().scan.image, camera(), model, rough, {});
  EXPECT_LT(surface_distance(model, refined.localization.T_sensor_model, truth), 2.0);
  EXPECT_TRUE(refined.verification.accepted);
  const Detection detection = to_detection(model, refined);
  EXPECT_EQ(detection.object, model.name);
  EXPECT_EQ(pose_of(detection).translation, refined.localization.T_sensor_model.translation);
  EXPECT_EQ(detection.matched, refined.verification.matched);
  EXPECT_TRUE(detection.regions.empty());
}

TEST(CheckRecognizeOptions, refuses_values_outside_their_limits) {
  const auto refused = [](auto change) {
    RecognizeOptions options;
    change(options);
    EXPECT_THROW(check(options), UsageError);
  };
  EXPECT_NO_THROW(check(RecognizeOptions{}));
  refused([](auto& o) { o.smallest_matched = -0.1; });
  refused([](auto& o) { o.smallest_matched = 1.1; });
  refused([](auto& o) { o.smallest_coherent = std::nan(""); });
  refused([](auto& o) { o.largest_occluding = 2.0; });
  refused([](auto& o) { o.largest_occluding = std::nan(""); });
  refused([](auto& o) { o.most_detections = -1; });
  refused([](auto& o) { o.potentials.support_on_on = -1e9; });
  refused([](auto& o) { o.potentials.support_off_off = 1e9; });
  refused([](auto& o) { o.potentials.contradiction_on_on = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& o) { o.potentials.contradiction_on_off = std::numeric_limits<double>::infinity(); });
  refused([](auto& o) { o.most_verifications = -1; });
}

}  // namespace
}  // namespace foresight
