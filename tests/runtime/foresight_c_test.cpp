#include "runtime/foresight_c.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "compiler/database_writer.h"
#include "runtime/foresight.h"
#include "tests/runtime/compiled_objects.h"

namespace foresight {
namespace {

using test::compiled_objects;

struct Release {
  void operator()(foresight_database* handle) const { foresight_database_release(handle); }
  void operator()(foresight_recognizer* handle) const { foresight_recognizer_release(handle); }
  void operator()(foresight_result* handle) const { foresight_result_release(handle); }
};
using DatabaseHandle = std::unique_ptr<foresight_database, Release>;
using RecognizerHandle = std::unique_ptr<foresight_recognizer, Release>;
using ResultHandle = std::unique_ptr<foresight_result, Release>;

DatabaseHandle loaded(const std::string& file) {
  foresight_database* database = nullptr;
  EXPECT_EQ(foresight_database_load(file.c_str(), &database), FORESIGHT_DONE) << foresight_last_error();
  return DatabaseHandle(database);
}

RecognizerHandle created(const DatabaseHandle& database, const foresight_options* options = nullptr) {
  foresight_recognizer* recognizer = nullptr;
  EXPECT_EQ(foresight_recognizer_create(database.get(), options, &recognizer), FORESIGHT_DONE);
  return RecognizerHandle(recognizer);
}

ResultHandle empty_result() {
  foresight_result* result = nullptr;
  EXPECT_EQ(foresight_result_create(&result), FORESIGHT_DONE);
  return ResultHandle(result);
}

// A database on disk and a scan in memory.
struct Client {
  test::TemporaryFolder folder;
  std::string file = folder.file("objects.db");
  RangeImage range = test::visible_scene(2, 0).scan.image;
  foresight_image image{sizeof(foresight_image), range.rows, range.columns, 0, range.points.front().data()};

  Client() { std::ofstream(file, std::ios::binary) << encode_database(compiled_objects().content()); }
};

foresight_detection detection(const ResultHandle& result, std::uint32_t index) {
  foresight_detection found{};
  found.size = sizeof found;
  EXPECT_EQ(foresight_result_detection(result.get(), index, &found), FORESIGHT_DONE) << foresight_last_error();
  return found;
}

void expect_same(const ResultHandle& result, const RecognitionResult& expected) {
  ASSERT_EQ(foresight_result_detection_count(result.get()), expected.detections.size());
  for (std::uint32_t i = 0; i < expected.detections.size(); ++i) {
    const Detection& want = expected.detections[i];
    const foresight_detection have = detection(result, i);
    EXPECT_EQ(have.object, want.object);
    EXPECT_TRUE(std::equal(want.T_sensor_model.begin(), want.T_sensor_model.end(), have.pose));
    EXPECT_TRUE(std::equal(want.quaternion.begin(), want.quaternion.end(), have.quaternion));
    EXPECT_TRUE(std::equal(want.covariance.begin(), want.covariance.end(), have.covariance));
    EXPECT_TRUE(std::equal(want.box_centre.begin(), want.box_centre.end(), have.box_centre));
    EXPECT_TRUE(std::equal(want.box_size.begin(), want.box_size.end(), have.box_size));
    EXPECT_EQ(std::vector<int>(have.faces, have.faces + have.face_count), want.faces);
    EXPECT_EQ(std::vector<int>(have.regions, have.regions + have.region_count), want.regions);
    EXPECT_EQ(have.score, want.score);
    EXPECT_EQ(have.matched, want.matched);
    EXPECT_EQ(have.coherent, want.coherent);
    EXPECT_EQ(have.occluding, want.occluding);
    EXPECT_EQ(have.rank, want.rank);
    ASSERT_EQ(have.alternative_count, want.ambiguous_with.size());
    for (std::uint32_t k = 0; k < have.alternative_count; ++k) {
      foresight_alternative other{};
      other.size = sizeof other;
      EXPECT_EQ(foresight_result_alternative(result.get(), i, k, &other), FORESIGHT_DONE);
      EXPECT_EQ(other.object, want.ambiguous_with[k].object);
      EXPECT_EQ(other.score, want.ambiguous_with[k].score);
    }
  }
}

void expect_refused(foresight_status status, foresight_status expected, const std::string& words) {
  EXPECT_EQ(status, expected);
  EXPECT_NE(std::string(foresight_last_error()).find(words), std::string::npos) << foresight_last_error();
}

TEST(CInterface, gives_what_the_cpp_interface_gives) {
  const Client client;
  const auto database = loaded(client.file);
  const auto recognizer = created(database);
  const auto result = empty_result();
  EXPECT_EQ(foresight_recognize(recognizer.get(), &client.image, FORESIGHT_NO_DEADLINE, result.get()), FORESIGHT_DONE);
  const RecognitionResult expected =
      Recognizer(client.file).recognize({client.range.rows, client.range.columns, client.image.xyz});
  ASSERT_EQ(expected.detections.size(), 2U);
  expect_same(result, expected);
  foresight_statistics counts{};
  counts.size = sizeof counts;
  ASSERT_EQ(foresight_result_statistics(result.get(), &counts), FORESIGHT_DONE);
  EXPECT_EQ(counts.complete, 1);
  EXPECT_EQ(counts.regions, expected.statistics.regions);
  EXPECT_EQ(counts.possible_matches, expected.statistics.possible_matches);
  EXPECT_EQ(counts.threshold_matches, expected.statistics.threshold_matches);
  EXPECT_EQ(counts.active_matches, expected.statistics.active_matches);
  EXPECT_EQ(counts.hypotheses, expected.statistics.hypotheses);
  EXPECT_EQ(counts.verifications, expected.statistics.verifications);
  EXPECT_EQ(counts.energy_evaluations, expected.statistics.energy_evaluations);
  EXPECT_EQ(counts.pose_checks, expected.statistics.pose_checks);
  foresight_times times{};
  times.size = sizeof times;
  ASSERT_EQ(foresight_result_times(result.get(), &times), FORESIGHT_DONE);
  EXPECT_GT(times.extract, 0.0);
  EXPECT_GE(times.total, times.extract + times.localize + times.verify);
}

TEST(CInterface, heeds_its_options_and_its_deadline) {
  const Client client;
  const auto database = loaded(client.file);
  const auto result = empty_result();
  foresight_options options = FORESIGHT_OPTIONS_DEFAULT;
  options.most_detections = 1;
  const auto one = created(database, &options);
  EXPECT_EQ(foresight_recognize(one.get(), &client.image, FORESIGHT_NO_DEADLINE, result.get()), FORESIGHT_DONE);
  EXPECT_EQ(foresight_result_detection_count(result.get()), 1U);
  EXPECT_EQ(foresight_recognize(one.get(), &client.image, 0, result.get()), FORESIGHT_DEADLINE);
  EXPECT_EQ(foresight_result_detection_count(result.get()), 0U);
  foresight_statistics counts{};
  counts.size = sizeof counts;
  EXPECT_EQ(foresight_result_statistics(result.get(), &counts), FORESIGHT_DONE);
  EXPECT_EQ(counts.complete, 0);
  options = FORESIGHT_OPTIONS_DEFAULT;
  options.method = FORESIGHT_METHOD_PAPER;
  options.loss = FORESIGHT_LOSS_TUKEY;
  RecognizeOptions same;
  same.method = Method::paper;
  same.loss = Loss::tukey;
  const auto paper = created(database, &options);
  EXPECT_EQ(foresight_recognize(paper.get(), &client.image, FORESIGHT_NO_DEADLINE, result.get()), FORESIGHT_DONE);
  expect_same(result,
              Recognizer(client.file, same).recognize({client.range.rows, client.range.columns, client.image.xyz}));
}

TEST(CInterface, recognizers_of_one_database_give_every_thread_the_same_bits) {
  const Client client;
  auto database = loaded(client.file);
  const RecognitionResult serial =
      Recognizer(client.file).recognize({client.range.rows, client.range.columns, client.image.xyz});
  std::vector<ResultHandle> results(4);
  std::vector<std::thread> threads;
  std::vector<RecognizerHandle> recognizers;
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i] = empty_result();
    recognizers.push_back(created(database));
  }
  database.reset();  // the recognizers share it still
  for (std::size_t i = 0; i < results.size(); ++i) {
    threads.emplace_back([&, i] {
      for (int repeat = 0; repeat < 2; ++repeat) {
        EXPECT_EQ(foresight_recognize(recognizers[i].get(), &client.image, FORESIGHT_NO_DEADLINE, results[i].get()),
                  FORESIGHT_DONE);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const ResultHandle& result : results) expect_same(result, serial);
}

TEST(CInterface, describes_the_objects_of_a_database) {
  const Client client;
  const auto database = loaded(client.file);
  ASSERT_EQ(foresight_database_object_count(database.get()), 2U);
  foresight_object object{};
  object.size = sizeof object;
  ASSERT_EQ(foresight_database_object(database.get(), 1, &object), FORESIGHT_DONE);
  const CompiledModel& model = compiled_objects().models()[1];
  EXPECT_EQ(object.name, model.name);
  EXPECT_EQ(object.diameter, model.diameter);
  for (int i = 0; i < 3; ++i) {
    double low = 1e9, high = -1e9;
    for (const auto& vertex : model.vertices) {
      low = std::min(low, static_cast<double>(vertex[i]));
      high = std::max(high, static_cast<double>(vertex[i]));
    }
    EXPECT_NEAR(object.box_centre[i], 0.5 * (low + high), 1e-9);
    EXPECT_NEAR(object.box_size[i], high - low, 1e-9);
  }
  expect_refused(foresight_database_object(database.get(), 2, &object), FORESIGHT_USAGE, "no index 2");
}

TEST(CInterface, says_what_is_wrong_with_files_as_the_programs_do) {
  const Client client;
  foresight_database* database = nullptr;
  const std::string missing = client.folder.file("missing.db");
  expect_refused(foresight_database_load(missing.c_str(), &database), FORESIGHT_BAD_INPUT, missing + ": ");
  const std::string foreign = client.folder.file("foreign.db");
  std::ofstream(foreign) << "OFF\n";
  expect_refused(foresight_database_load(foreign.c_str(), &database), FORESIGHT_BAD_DATABASE, foreign + ": ");
  EXPECT_EQ(database, nullptr);
}

TEST(CInterface, loads_from_memory_what_it_loads_from_a_file) {
  const Client client;
  std::ifstream in(client.file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  foresight_database* handle = nullptr;
  ASSERT_EQ(foresight_database_load_bytes(bytes.data(), bytes.size(), &handle), FORESIGHT_DONE);
  const DatabaseHandle database(handle);
  std::fill(bytes.begin(), bytes.end(), '\0');  // they may go
  EXPECT_EQ(foresight_database_object_count(database.get()),
            foresight_database_object_count(loaded(client.file).get()));
  foresight_database* none = nullptr;
  expect_refused(foresight_database_load_bytes(bytes.data(), bytes.size(), &none), FORESIGHT_BAD_DATABASE,
                 "(memory): ");
  expect_refused(foresight_database_load_bytes(nullptr, 3, &none), FORESIGHT_USAGE, "data: is NULL");
  EXPECT_EQ(none, nullptr);
}

TEST(CInterface, refuses_images_it_cannot_use_and_empties_the_result) {
  const Client client;
  const auto database = loaded(client.file);
  const auto recognizer = created(database);
  const auto result = empty_result();
  ASSERT_EQ(foresight_recognize(recognizer.get(), &client.image, FORESIGHT_NO_DEADLINE, result.get()), FORESIGHT_DONE);
  foresight_image image = client.image;
  image.xyz = nullptr;
  expect_refused(foresight_recognize(recognizer.get(), &image, FORESIGHT_NO_DEADLINE, result.get()),
                 FORESIGHT_BAD_INPUT, "range image: ");
  EXPECT_EQ(foresight_result_detection_count(result.get()), 0U);
  image = client.image;
  image.rows = 31;
  expect_refused(foresight_recognize(recognizer.get(), &image, FORESIGHT_NO_DEADLINE, result.get()),
                 FORESIGHT_BAD_INPUT, "range image: ");
  expect_refused(foresight_recognize(recognizer.get(), &client.image, -2, result.get()), FORESIGHT_USAGE, "deadline");
}

TEST(CInterface, refuses_null_and_indices_too_large) {
  const Client client;
  const auto database = loaded(client.file);
  const auto result = empty_result();
  foresight_recognizer* recognizer = nullptr;
  foresight_detection found{};
  found.size = sizeof found;
  expect_refused(foresight_database_load(nullptr, nullptr), FORESIGHT_USAGE, "file: is NULL");
  expect_refused(foresight_database_load(client.file.c_str(), nullptr), FORESIGHT_USAGE, "database: is NULL");
  expect_refused(foresight_recognizer_create(nullptr, nullptr, &recognizer), FORESIGHT_USAGE, "database: is NULL");
  expect_refused(foresight_recognize(nullptr, &client.image, 1, result.get()), FORESIGHT_USAGE, "recognizer: is NULL");
  expect_refused(foresight_result_detection(result.get(), 0, &found), FORESIGHT_USAGE, "no index 0");
  expect_refused(foresight_result_detection(nullptr, 0, &found), FORESIGHT_USAGE, "result: is NULL");
  expect_refused(foresight_result_alternative(result.get(), 0, 0, nullptr), FORESIGHT_USAGE, "no index 0");
  expect_refused(foresight_result_statistics(result.get(), nullptr), FORESIGHT_USAGE, "statistics: is NULL");
  expect_refused(foresight_result_create(nullptr), FORESIGHT_USAGE, "result: is NULL");
  EXPECT_EQ(foresight_result_detection_count(nullptr), 0U);
  EXPECT_EQ(foresight_database_object_count(nullptr), 0U);
  foresight_database_release(nullptr);
  foresight_recognizer_release(nullptr);
  foresight_result_release(nullptr);
}

// The database of a client after a change.
template <typename Change>
DatabaseHandle loaded_with(const Change& change) {
  CompiledDatabase content = compiled_objects().content();
  change(content.models);
  const std::string bytes = encode_database(content);
  foresight_database* handle = nullptr;
  EXPECT_EQ(foresight_database_load_bytes(bytes.data(), bytes.size(), &handle), FORESIGHT_DONE);
  return DatabaseHandle(handle);
}

TEST(CInterface, tests_itself_as_the_cpp_interface_does) {
  const auto database = loaded_with([](auto&) {});
  std::array<char, 1000> text{};
  std::uint32_t failed = 77;
  EXPECT_EQ(foresight_database_selftest(database.get(), &failed, text.data(), text.size()), FORESIGHT_DONE);
  EXPECT_EQ(failed, 0U);
  EXPECT_NE(std::string(text.data()).find("passed: 2 right"), std::string::npos) << text.data();

  const auto moved = loaded_with([](auto& models) { models[0].golden_scan->T_sensor_model.translation.x() += 60.0; });
  EXPECT_EQ(foresight_database_selftest(moved.get(), &failed, nullptr, 0), FORESIGHT_NOTHING_FOUND);
  EXPECT_EQ(failed, 1U);
  const auto none = loaded_with([](auto& models) {
    for (CompiledModel& model : models) model.golden_scan.reset();
  });
  EXPECT_EQ(foresight_database_selftest(none.get(), &failed, text.data(), text.size()), FORESIGHT_NOTHING_FOUND);
  EXPECT_EQ(failed, 0U);
  const std::string whole = text.data();

  text.fill('x');  // a text too long is cut, and ends within its capacity
  EXPECT_EQ(foresight_database_selftest(none.get(), nullptr, text.data(), 8), FORESIGHT_NOTHING_FOUND);
  EXPECT_EQ(std::string(text.data()), whole.substr(0, 7));
  EXPECT_EQ(text[8], 'x');
  expect_refused(foresight_database_selftest(nullptr, &failed, nullptr, 0), FORESIGHT_USAGE, "database: is NULL");
  expect_refused(foresight_database_selftest(none.get(), &failed, nullptr, 5), FORESIGHT_USAGE, "text: is NULL");
}

TEST(CInterface, refuses_options_outside_their_limits) {
  const Client client;
  const auto database = loaded(client.file);
  const auto refused = [&](const foresight_options& options, const std::string& words) {
    foresight_recognizer* recognizer = nullptr;
    expect_refused(foresight_recognizer_create(database.get(), &options, &recognizer), FORESIGHT_USAGE, words);
    EXPECT_EQ(recognizer, nullptr);
  };
  foresight_options options = FORESIGHT_OPTIONS_DEFAULT;
  options.method = 2;
  refused(options, "method");
  options = FORESIGHT_OPTIONS_DEFAULT;
  options.loss = -1;
  refused(options, "loss");
  options = FORESIGHT_OPTIONS_DEFAULT;
  options.most_detections = -1;
  refused(options, "most_detections");
  options = FORESIGHT_OPTIONS_DEFAULT;
  options.reserved = 1;
  refused(options, "reserved");
  options = FORESIGHT_OPTIONS_DEFAULT;
  options.size = 0;
  refused(options, "size");
}

// A struct as a later header has it.
template <typename Struct>
struct Grown {
  Struct known{};
  char later[16];
};

TEST(CInterface, structs_grow_at_their_end_only) {
  const Client client;
  const auto database = loaded(client.file);
  Grown<foresight_object> object;
  std::memset(object.later, 7, sizeof object.later);
  object.known.size = sizeof object.known;
  ASSERT_EQ(foresight_database_object(database.get(), 0, &object.known), FORESIGHT_DONE);
  EXPECT_EQ(object.known.size, sizeof object.known);
  EXPECT_EQ(object.later[0], 7);  // beyond what the caller has said
  object.known.size = sizeof object;
  ASSERT_EQ(foresight_database_object(database.get(), 0, &object.known), FORESIGHT_DONE);
  EXPECT_EQ(object.known.size, sizeof object);
  for (const char byte : object.later) EXPECT_EQ(byte, 0);  // not known to this library
  for (const std::uint32_t size : {std::uint32_t{0}, std::uint32_t{8}, ~std::uint32_t{0}}) {
    object.known.size = size;
    expect_refused(foresight_database_object(database.get(), 0, &object.known), FORESIGHT_USAGE, "its size is");
  }

  Grown<foresight_options> options;
  options.known = FORESIGHT_OPTIONS_DEFAULT;
  options.known.size = sizeof options;
  std::memset(options.later, 0, sizeof options.later);
  EXPECT_NE(created(database, &options.known), nullptr);
  options.later[15] = 1;
  foresight_recognizer* recognizer = nullptr;
  expect_refused(foresight_recognizer_create(database.get(), &options.known, &recognizer), FORESIGHT_USAGE, "too old");
}

// Sizes of ABI version 1 before reserved_memory and pool_bytes.
TEST(CInterface, serves_programs_that_know_its_first_structs) {
  constexpr std::uint32_t kOptions = 24;
  constexpr std::uint32_t kStatistics = 72;
  const Client client;
  const auto database = loaded(client.file);
  foresight_options options = FORESIGHT_OPTIONS_DEFAULT;
  options.size = kOptions;
  options.reserved_memory = ~std::uint64_t{0};  // beyond such a program's struct: not read
  const auto recognizer = created(database, &options);
  const auto result = empty_result();
  ASSERT_EQ(foresight_recognize(recognizer.get(), &client.image, FORESIGHT_NO_DEADLINE, result.get()), FORESIGHT_DONE);
  foresight_statistics counts{};
  counts.size = kStatistics;
  counts.pool_bytes = 7;
  EXPECT_EQ(foresight_result_statistics(result.get(), &counts), FORESIGHT_DONE);
  EXPECT_GT(counts.pose_checks, 0);
  EXPECT_EQ(counts.pool_bytes, 7);  // not written
  foresight_recognizer* none = nullptr;
  options.size = kOptions - 1;
  expect_refused(foresight_recognizer_create(database.get(), &options, &none), FORESIGHT_USAGE, "its size is");
}

TEST(CInterface, reserves_memory_and_says_how_much_was_used) {
  const Client client;
  const auto database = loaded(client.file);
  foresight_options options = FORESIGHT_OPTIONS_DEFAULT;
  options.reserved_memory = 16U << 20;
  const auto recognizer = created(database, &options);
  const auto result = empty_result();
  ASSERT_EQ(foresight_recognize(recognizer.get(), &client.image, FORESIGHT_NO_DEADLINE, result.get()), FORESIGHT_DONE);
  foresight_statistics counts{};
  counts.size = sizeof counts;
  EXPECT_EQ(foresight_result_statistics(result.get(), &counts), FORESIGHT_DONE);
  EXPECT_GT(counts.pool_bytes, 1 << 20);
  EXPECT_LT(counts.pool_bytes, 16 << 20);
}

// What programs compiled with this header rely on. Never change a line; a new field gets a line of its own.
TEST(CInterface, structs_are_laid_out_as_in_abi_version_1) {
  static_assert(FORESIGHT_ABI_VERSION == 1);
  if (sizeof(void*) != 8) GTEST_SKIP() << "the numbers are those of 64-bit machines";
  EXPECT_EQ(sizeof(foresight_object), 72U);
  EXPECT_EQ(offsetof(foresight_object, name), 8U);
  EXPECT_EQ(offsetof(foresight_object, diameter), 64U);
  EXPECT_EQ(sizeof(foresight_options), 32U);
  EXPECT_EQ(offsetof(foresight_options, reserved_memory), 24U);
  EXPECT_EQ(offsetof(foresight_options, most_verifications), 16U);
  EXPECT_EQ(sizeof(foresight_image), 24U);
  EXPECT_EQ(offsetof(foresight_image, xyz), 16U);
  EXPECT_EQ(sizeof(foresight_detection), 576U);
  EXPECT_EQ(offsetof(foresight_detection, pose), 16U);
  EXPECT_EQ(offsetof(foresight_detection, covariance), 176U);
  EXPECT_EQ(offsetof(foresight_detection, score), 464U);
  EXPECT_EQ(offsetof(foresight_detection, faces), 544U);
  EXPECT_EQ(offsetof(foresight_detection, alternative_count), 568U);
  EXPECT_EQ(sizeof(foresight_alternative), 152U);
  EXPECT_EQ(offsetof(foresight_alternative, score), 144U);
  EXPECT_EQ(sizeof(foresight_statistics), 80U);
  EXPECT_EQ(offsetof(foresight_statistics, pool_bytes), 72U);
  EXPECT_EQ(offsetof(foresight_statistics, pose_checks), 64U);
  EXPECT_EQ(sizeof(foresight_times), 56U);
  EXPECT_EQ(offsetof(foresight_times, total), 48U);
}

TEST(CInterface, versions_agree_with_the_project) {
  const std::string project = std::to_string(FORESIGHT_API_VERSION_MAJOR) + "." +
                              std::to_string(FORESIGHT_API_VERSION_MINOR) + "." +
                              std::to_string(FORESIGHT_API_VERSION_PATCH);
  EXPECT_EQ(foresight_version(), project);
  EXPECT_EQ(version(), project);
  EXPECT_EQ(foresight_abi_version(), std::uint32_t{FORESIGHT_ABI_VERSION});
  EXPECT_EQ(FORESIGHT_API_VERSION,
            10000 * FORESIGHT_API_VERSION_MAJOR + 100 * FORESIGHT_API_VERSION_MINOR + FORESIGHT_API_VERSION_PATCH);
}

TEST(CInterface, errors_belong_to_their_thread) {
  expect_refused(foresight_result_create(nullptr), FORESIGHT_USAGE, "result");
  std::thread([] { EXPECT_STREQ(foresight_last_error(), ""); }).join();
  EXPECT_STRNE(foresight_last_error(), "");
}

}  // namespace
}  // namespace foresight
