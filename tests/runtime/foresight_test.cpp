#include "runtime/foresight.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <fstream>
#include <memory>
#include <thread>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "compiler/database_writer.h"
#include "runtime/recognize.h"
#include "tests/images.h"
#include "tests/runtime/compiled_objects.h"

namespace foresight {
namespace {

using test::compiled_objects;

// A database on disk and a scan in memory, as a program that links the library has them.
struct Client {
  test::TemporaryFolder folder;
  std::string file = folder.file("objects.db");
  RangeImage image = test::visible_scene(2, 0).scan.image;

  Client() { std::ofstream(file, std::ios::binary) << encode_database(compiled_objects().content()); }
  [[nodiscard]] RangeImageView view() const { return {image.rows, image.columns, image.points.front().data()}; }
};

void expect_same(const RecognitionResult& a, const RecognitionResult& b) {
  EXPECT_EQ(a.complete, b.complete);
  EXPECT_EQ(a.statistics.verifications, b.statistics.verifications);
  EXPECT_EQ(a.statistics.energy_evaluations, b.statistics.energy_evaluations);
  ASSERT_EQ(a.detections.size(), b.detections.size());
  for (std::size_t i = 0; i < a.detections.size(); ++i) {
    EXPECT_EQ(a.detections[i].object, b.detections[i].object);
    EXPECT_EQ(a.detections[i].T_sensor_model, b.detections[i].T_sensor_model);
    EXPECT_EQ(a.detections[i].score, b.detections[i].score);
    EXPECT_EQ(a.detections[i].quaternion, b.detections[i].quaternion);
    EXPECT_EQ(a.detections[i].covariance, b.detections[i].covariance);
    EXPECT_EQ(a.detections[i].faces, b.detections[i].faces);
    EXPECT_EQ(a.detections[i].regions, b.detections[i].regions);
  }
}

TEST(Recognizer, recognizes_as_in_process_from_a_saved_database) {
  const Client client;
  const Recognizer recognizer(client.file);
  const RecognitionResult result = recognizer.recognize(client.view());
  EXPECT_EQ(result.detections.size(), 2U);
  expect_same(result, recognize(client.image, fit_camera(client.image).value(), compiled_objects(), {}));
}

TEST(Recognizer, finds_the_same_objects_as_with_the_sensors_own_camera) {
  const Client client;
  const RecognitionResult fitted = Recognizer(client.file).recognize(client.view());
  const RecognitionResult given =
      recognize(client.image, compiled_objects().content().sensor.camera, compiled_objects(), {});
  ASSERT_EQ(fitted.detections.size(), given.detections.size());
  for (std::size_t i = 0; i < given.detections.size(); ++i)
    EXPECT_EQ(fitted.detections[i].object, given.detections[i].object);
}

TEST(Recognizer, names_its_objects_in_the_order_of_the_database) {
  const Client client;
  const Recognizer recognizer(client.file);
  EXPECT_EQ(recognizer.object_names(), (std::vector<std::string>{"castle", "stick"}));
  EXPECT_EQ(recognizer.database().models().size(), 2U);
}

TEST(Recognizer, can_be_moved) {
  const Client client;
  Recognizer first(client.file);
  const RecognitionResult before = first.recognize(client.view());
  Recognizer second(std::move(first));
  expect_same(second.recognize(client.view()), before);
  RecognizeOptions none;
  none.most_verifications = 1;
  Recognizer third(client.file, none);
  third = std::move(second);
  expect_same(third.recognize(client.view()), before);
}

TEST(Recognizer, heeds_its_options) {
  const Client client;
  RecognizeOptions one;
  one.most_detections = 1;
  EXPECT_EQ(Recognizer(client.file, one).recognize(client.view()).detections.size(), 1U);
}

TEST(Recognizer, stops_at_its_deadline) {
  const Client client;
  const Recognizer recognizer(client.file);
  const RecognitionResult late = recognizer.recognize(client.view(), std::chrono::milliseconds(0));
  EXPECT_FALSE(late.complete);
  EXPECT_TRUE(late.detections.empty());
  EXPECT_TRUE(recognizer.recognize(client.view(), std::chrono::hours(1)).complete);
}

TEST(Recognizer, gives_the_same_in_a_result_that_held_another) {
  const Client client;
  const Recognizer recognizer(client.file);
  const RecognitionResult fresh = recognizer.recognize(client.view());
  ASSERT_EQ(fresh.detections.size(), 2U);
  const RangeImage wall = test::render({test::facing({0, 0, 900}, 1000, 1000)}, PinholeCamera{});
  const RangeImageView nothing{wall.rows, wall.columns, wall.points.front().data()};
  RecognitionResult result;
  for (int turn = 0; turn < 3; ++turn) {
    recognizer.recognize(client.view(), std::nullopt, result);
    expect_same(result, fresh);
    EXPECT_TRUE(result.complete);
    recognizer.recognize(nothing, std::nullopt, result);
    EXPECT_TRUE(result.detections.empty());
    recognizer.recognize(client.view(), std::chrono::milliseconds(0), result);
    EXPECT_FALSE(result.complete);
  }
}

TEST(Recognizer, keeps_nothing_in_a_result_that_it_could_not_fill) {
  const Client client;
  const Recognizer recognizer(client.file);
  RecognitionResult result = recognizer.recognize(client.view());
  ASSERT_FALSE(result.detections.empty());
  EXPECT_THROW(recognizer.recognize({}, std::nullopt, result), InputError);
  EXPECT_TRUE(result.detections.empty());
  recognizer.recognize(client.view(), std::nullopt, result);  // and goes on
  EXPECT_EQ(result.detections.size(), 2U);
}

TEST(Recognizer, needs_the_same_memory_for_the_same_scan_every_time) {
  const Client client;
  const Recognizer recognizer(client.file);
  const long needed = recognizer.recognize(client.view()).statistics.pool_bytes;
  EXPECT_GT(needed, 1 << 20);
  EXPECT_EQ(recognizer.recognize(client.view()).statistics.pool_bytes, needed);
  RecognizeOptions reserving;
  reserving.reserved_memory = static_cast<std::size_t>(needed);
  const RecognitionResult result = Recognizer(client.file, reserving).recognize(client.view());
  EXPECT_LE(result.statistics.pool_bytes, needed);
  expect_same(result, recognizer.recognize(client.view()));
}

TEST(Recognizer, gives_identical_results_to_several_threads) {
  const Client client;
  const Recognizer recognizer(client.file);
  const RecognitionResult alone = recognizer.recognize(client.view());
  std::vector<RecognitionResult> results(4);
  std::vector<std::thread> threads;
  for (RecognitionResult& result : results) {
    threads.emplace_back([&] { result = recognizer.recognize(client.view()); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const RecognitionResult& result : results) expect_same(result, alone);
}

TEST(Recognizer, recognizers_of_one_database_give_every_thread_the_same_bits) {
  const Client client;
  const RecognitionResult alone = Recognizer(client.file).recognize(client.view());
  std::vector<RecognitionResult> results(4);
  std::vector<std::thread> threads;
  {
    const std::shared_ptr<const Database> shared = load_shared_database(client.file);
    for (RecognitionResult& result : results) {
      threads.emplace_back([&client, &result, shared] { result = Recognizer(shared).recognize(client.view()); });
    }
  }
  for (std::thread& thread : threads) thread.join();
  for (const RecognitionResult& result : results) expect_same(result, alone);
}

TEST(Recognizer, keeps_the_database_it_was_given) {
  const Client client;
  auto shared = load_shared_database(client.file);
  const std::weak_ptr<const Database> watched = shared;
  {
    const Recognizer first(shared);
    const Recognizer second(std::move(shared));
    EXPECT_EQ(&first.database(), &second.database());
    EXPECT_EQ(watched.use_count(), 2);
  }
  EXPECT_TRUE(watched.expired());
}

Eigen::Matrix3d rotation_of(const std::array<double, 4>& quaternion) {
  return Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3]).toRotationMatrix();
}

TEST(Recognizer, tells_pose_and_uncertainty_of_both_methods_whole) {
  const Client client;
  const auto shared = load_shared_database(client.file);
  for (const Method method : {Method::two_way, Method::paper}) {
    RecognizeOptions options;
    options.method = method;
    const RecognitionResult result = Recognizer(shared, options).recognize(client.view());
    EXPECT_FALSE(result.detections.empty());
    for (const Detection& detection : result.detections) {
      EXPECT_LT((rotation_of(detection.quaternion) - test::pose_of(detection).rotation).norm(), 1e-12);
      EXPECT_GE(detection.quaternion[0], 0.0);
      const Eigen::Map<const Eigen::Matrix<double, 6, 6>> covariance(detection.covariance.data());
      EXPECT_EQ(Eigen::MatrixXd(covariance), Eigen::MatrixXd(covariance.transpose()));
      EXPECT_EQ(covariance.llt().info(), Eigen::Success);
      EXPECT_LT(covariance(0, 0), 1e3);  // some data say where it is
      for (const double side : detection.box_size) EXPECT_GT(side, 0.0);
    }
  }
}

TEST(Detection, has_one_quaternion_for_each_rotation) {
  CompiledModel model;
  model.vertices = {{1.0F, 2.0F, 3.0F}, {5.0F, -2.0F, 4.0F}};
  Random random(8);
  const double pi = 3.14159265358979323846;
  std::vector<Eigen::Vector3d> vectors = {{0, 0, 0}, {pi, 0, 0}, {0, -pi, 0}, {0, 0, pi}, {0, pi / 2, 0}};
  for (int i = 0; i < 50; ++i) vectors.push_back(random.uniform(0.0, pi) * random.direction());
  for (const Eigen::Vector3d& vector : vectors) {
    RefinedPose refined{};
    refined.localization.T_sensor_model.rotation = rotation_from_vector(vector);
    const Detection detection = to_detection(model, refined);
    const auto& q = detection.quaternion;
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 1e-12);
    EXPECT_GE(q[0], 0.0);
    EXPECT_LT((rotation_of(q) - refined.localization.T_sensor_model.rotation).norm(), 1e-9);
  }
  const Detection detection = to_detection(model, {});
  EXPECT_EQ(detection.box_centre, (std::array<double, 3>{3.0, 0.0, 3.5}));
  EXPECT_EQ(detection.box_size, (std::array<double, 3>{4.0, 4.0, 1.0}));
}

TEST(Recognizer, takes_every_kind_of_invalid_cell_for_a_hole) {
  const Client client;
  Client damaged;
  const std::vector<Eigen::Vector3f> bad = {{0, 0, 0},
                                            {1, 1, -900},
                                            {std::numeric_limits<float>::infinity(), 0, 900},
                                            {0, 0, std::numeric_limits<float>::infinity()},
                                            {0, std::numeric_limits<float>::quiet_NaN(), 900}};
  std::size_t next = 0;
  for (int cell = 0; cell < damaged.image.size(); ++cell) {
    if (!damaged.image.valid(cell)) damaged.image[cell] = bad[next++ % bad.size()];
  }
  ASSERT_GT(next, 100U);
  const Recognizer recognizer(client.file);
  expect_same(recognizer.recognize(damaged.view()), recognizer.recognize(client.view()));
}

TEST(Recognizer, refuses_views_outside_their_limits) {
  const Client client;
  const Recognizer recognizer(client.file);
  const float* xyz = client.view().xyz;
  EXPECT_THROW((void)recognizer.recognize({client.image.rows, client.image.columns, nullptr}), InputError);
  for (const auto& [rows, columns] : {std::pair(31, 64), {64, 31}, {0, 0}, {-64, 64}, {4097, 64}, {64, 4097}}) {
    EXPECT_THROW((void)recognizer.recognize({rows, columns, xyz}), InputError) << rows << " x " << columns;
  }
}

TEST(Recognizer, refuses_views_without_data_or_without_a_pinhole_grid) {
  const Client client;
  const Recognizer recognizer(client.file);
  const auto refused = [&](const std::vector<float>& xyz) {
    EXPECT_THROW((void)recognizer.recognize({64, 64, xyz.data()}), InputError);
  };
  refused(std::vector<float>(64 * 64 * 3, std::numeric_limits<float>::quiet_NaN()));
  refused(std::vector<float>(64 * 64 * 3, 0.0F));
  std::vector<float> scattered;
  Random random(1);
  for (int i = 0; i < 64 * 64; ++i) {
    for (const double value : {random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(600, 1200)}) {
      scattered.push_back(static_cast<float>(value));
    }
  }
  refused(scattered);
}

TEST(Recognizer, uses_databases_without_acceptance_models_by_the_papers_method_alone) {
  const Client client;
  CompiledDatabase content = compiled_objects().content();
  for (CompiledModel& model : content.models) model.acceptance = {};
  const std::string old = client.folder.file("old.db");
  std::ofstream(old, std::ios::binary) << encode_database(content);
  EXPECT_THROW(Recognizer{old}, DatabaseError);
  EXPECT_THROW(Recognizer{load_shared_database(old)}, DatabaseError);
  RecognizeOptions paper;
  paper.method = Method::paper;
  expect_same(Recognizer(old, paper).recognize(client.view()), Recognizer(client.file, paper).recognize(client.view()));
}

TEST(Recognizer, refuses_files_and_options_it_cannot_use) {
  const Client client;
  EXPECT_THROW(Recognizer(client.folder.file("missing.db")), InputError);
  const std::string foreign = client.folder.file("foreign.db");
  std::ofstream(foreign) << "OFF\n";
  EXPECT_THROW(Recognizer{foreign}, DatabaseError);
  RecognizeOptions wrong;
  wrong.smallest_matched = 7.0;
  EXPECT_THROW(Recognizer(client.file, wrong), UsageError);
  EXPECT_THROW(Recognizer(load_shared_database(client.file), wrong), UsageError);
  EXPECT_THROW((void)load_shared_database(foreign), DatabaseError);
}

TEST(Recognizer, loads_from_memory_what_it_loads_from_a_file) {
  const Client client;
  auto bytes = std::make_unique<std::string>("x" + read_whole_file(client.file));  // at an odd address, for once
  const Recognizer embedded(DatabaseBytes{bytes->data() + 1, bytes->size() - 1});
  bytes.reset();
  expect_same(embedded.recognize(client.view()), Recognizer(client.file).recognize(client.view()));
}

TEST(Recognizer, refuses_bytes_that_are_no_whole_database) {
  const Client client;
  const std::string bytes = read_whole_file(client.file);
  const auto fault = [](const DatabaseBytes& given) {
    try {
      const Recognizer recognizer(given);
    } catch (const DatabaseError& error) {
      EXPECT_EQ(error.file(), "(memory)");
      return error.fault();
    }
    return DatabaseFault::incompatible;
  };
  EXPECT_EQ(fault({}), DatabaseFault::wrong_kind);
  EXPECT_EQ(fault({nullptr, 100}), DatabaseFault::wrong_kind);
  EXPECT_EQ(fault({bytes.data(), 0}), DatabaseFault::wrong_kind);
  EXPECT_EQ(fault({bytes.data(), bytes.size() - 1}), DatabaseFault::truncated);
  RecognizeOptions wrong;
  wrong.smallest_matched = 7.0;
  EXPECT_THROW(Recognizer(DatabaseBytes{bytes.data(), bytes.size()}, wrong), UsageError);
}

TEST(Version, has_three_numbers) {
  int major = -1;
  int minor = -1;
  int patch = -1;
  char rest = 0;
  EXPECT_EQ(std::sscanf(version(), "%d.%d.%d%c", &major, &minor, &patch, &rest), 3);
  EXPECT_EQ(major, FORESIGHT_API_VERSION_MAJOR);
  EXPECT_EQ(minor, FORESIGHT_API_VERSION_MINOR);
  EXPECT_EQ(patch, FORESIGHT_API_VERSION_PATCH);
}

}  // namespace
}  // namespace foresight
