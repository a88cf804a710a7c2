#include "runtime/foresight_c.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <type_traits>

#include "common/errors.h"
#include "runtime/database.h"
#include "runtime/foresight.h"
#include "runtime/recognize.h"

static_assert(std::is_same_v<int, std::int32_t>);  // lists of faces and regions are handed out as they are
static_assert(FORESIGHT_DONE == foresight::kExitDone && FORESIGHT_NOTHING_FOUND == foresight::kExitNothingFound &&
              FORESIGHT_USAGE == foresight::kExitUsage && FORESIGHT_BAD_INPUT == foresight::kExitBadInput &&
              FORESIGHT_BAD_DATABASE == foresight::kExitBadDatabase && FORESIGHT_DEADLINE == foresight::kExitDeadline &&
              FORESIGHT_INTERNAL == foresight::kExitInternal);

struct foresight_database {
  std::shared_ptr<const foresight::Database> content;
};
struct foresight_recognizer {
  foresight::Recognizer recognizer;
};
struct foresight_result {
  foresight::RecognitionResult content;
};

namespace {

using foresight::UsageError;

// Where a message is kept must not fail: no allocation.
thread_local std::array<char, 1024> last_error{};

foresight_status fail(foresight_status status, const char* message) noexcept {
  std::snprintf(last_error.data(), last_error.size(), "%s", message);
  return status;
}

// Runs what may throw.
template <typename Body>
foresight_status guarded(const Body& body) noexcept {
  try {
    return body();
  } catch (const foresight::Error& error) {
    return fail(error.exit_code(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(FORESIGHT_INTERNAL, "memory: not enough for this input; use a smaller scan, or a larger machine");
  } catch (const std::exception& error) {
    return fail(FORESIGHT_INTERNAL, error.what());
  } catch (...) {
    return fail(FORESIGHT_INTERNAL, "internal error: unknown; please report it");
  }
}

template <typename Pointer>
void require(Pointer pointer, const char* name) {
  if (pointer == nullptr) throw UsageError(name, "is NULL", "give what the header asks for");
}

// Size of a struct in the first version of this interface: none is smaller. When a struct grows, it gets a
// specialization here with the size that it had.
template <typename Struct>
constexpr std::size_t kFirstSize = sizeof(Struct);
template <>
constexpr std::size_t kFirstSize<foresight_options> = offsetof(foresight_options, reserved_memory);
template <>
constexpr std::size_t kFirstSize<foresight_statistics> = offsetof(foresight_statistics, pool_bytes);

template <typename Struct>
void check_size(std::uint32_t size, const char* name) {
  constexpr std::uint32_t kLargest = 4096;  // of any later version; beyond, the size was not set
  if (size < kFirstSize<Struct> || size > kLargest)
    throw UsageError(name, "its size is " + std::to_string(size), "set size to sizeof the struct before the call");
}

// Copies a struct out, as far as the caller knows it; 0 beyond what this library knows.
template <typename Struct>
void give(const Struct& ours, Struct* theirs, const char* name) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  require(theirs, name);
  const std::uint32_t size = theirs->size;
  check_size<Struct>(size, name);
  std::memcpy(theirs, &ours, std::min<std::size_t>(size, sizeof(Struct)));
  if (size > sizeof(Struct)) std::memset(reinterpret_cast<char*>(theirs) + sizeof(Struct), 0, size - sizeof(Struct));
  theirs->size = size;
}

// Copies a struct in: what the caller does not know is 0, what this library does not know must be.
template <typename Struct>
Struct take(const Struct* theirs, const char* name) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  require(theirs, name);
  check_size<Struct>(theirs->size, name);
  Struct ours{};
  std::memcpy(&ours, theirs, std::min<std::size_t>(theirs->size, sizeof(Struct)));
  const char* const bytes = reinterpret_cast<const char*>(theirs);
  const char* const end = bytes + std::max<std::size_t>(theirs->size, sizeof(Struct));
  if (std::any_of(bytes + sizeof(Struct), end, [](char byte) { return byte != 0; }))
    throw UsageError(name, "it has fields that this library is too old for", "use a library as new as the header");
  return ours;
}

template <typename List>
const typename List::value_type& at(const List& list, std::uint32_t index, const char* name) {
  if (index < list.size()) return list[index];
  throw UsageError(name, "there is no index " + std::to_string(index), "give one below " + std::to_string(list.size()));
}

void refuse_reserved(std::int64_t value, const char* name) {
  if (value != 0) throw UsageError(name, "a reserved field is not 0", "set it to 0");
}

foresight::RecognizeOptions options_of(const foresight_options* given) {
  foresight::RecognizeOptions options;
  if (given == nullptr) return options;
  const auto taken = take(given, "options");
  refuse_reserved(taken.reserved, "options");
  if (taken.method < FORESIGHT_METHOD_TWO_WAY || taken.method > FORESIGHT_METHOD_PAPER)
    throw UsageError("method", "is unknown", "give one of FORESIGHT_METHOD_...");
  if (taken.loss < FORESIGHT_LOSS_LORENTZIAN || taken.loss > FORESIGHT_LOSS_GAUSSIAN)
    throw UsageError("loss", "is unknown", "give one of FORESIGHT_LOSS_...");
  constexpr std::array kLosses = {foresight::Loss::lorentzian, foresight::Loss::tukey, foresight::Loss::huber,
                                  foresight::Loss::gaussian};
  options.method = taken.method == FORESIGHT_METHOD_PAPER ? foresight::Method::paper : foresight::Method::two_way;
  options.loss = kLosses[static_cast<std::size_t>(taken.loss)];
  options.most_detections = taken.most_detections;
  options.most_verifications = taken.most_verifications;
  options.reserved_memory = static_cast<std::size_t>(taken.reserved_memory);
  return options;
}

std::uint32_t count_of(std::size_t size) { return static_cast<std::uint32_t>(size); }

foresight_detection detection_of(const foresight::Detection& found) {
  foresight_detection detection{};
  detection.rank = found.rank;
  detection.object = found.object.c_str();
  std::copy(found.T_sensor_model.begin(), found.T_sensor_model.end(), detection.pose);
  std::copy(found.quaternion.begin(), found.quaternion.end(), detection.quaternion);
  std::copy(found.covariance.begin(), found.covariance.end(), detection.covariance);
  detection.score = found.score;
  detection.matched = found.matched;
  detection.coherent = found.coherent;
  detection.occluding = found.occluding;
  std::copy(found.box_centre.begin(), found.box_centre.end(), detection.box_centre);
  std::copy(found.box_size.begin(), found.box_size.end(), detection.box_size);
  detection.faces = found.faces.data();
  detection.regions = found.regions.data();
  detection.face_count = count_of(found.faces.size());
  detection.region_count = count_of(found.regions.size());
  detection.alternative_count = count_of(found.ambiguous_with.size());
  return detection;
}

}  // namespace

const char* foresight_version(void) { return foresight::version(); }
std::uint32_t foresight_abi_version(void) { return FORESIGHT_ABI_VERSION; }
const char* foresight_last_error(void) { return last_error.data(); }

foresight_status foresight_database_load(const char* file, foresight_database** database) {
  return guarded([&] {
    require(file, "file");
    require(database, "database");
    *database = new foresight_database{foresight::load_shared_database(file)};
    return FORESIGHT_DONE;
  });
}

foresight_status foresight_database_load_bytes(const void* data, std::uint64_t byte_count,
                                               foresight_database** database) {
  return guarded([&] {
    require(data, "data");
    require(database, "database");
    const foresight::DatabaseBytes bytes{data, static_cast<std::size_t>(byte_count)};
    *database = new foresight_database{foresight::load_shared_database(bytes)};
    return FORESIGHT_DONE;
  });
}

void foresight_database_release(foresight_database* database) { delete database; }

std::uint32_t foresight_database_object_count(const foresight_database* database) {
  return database == nullptr ? 0 : count_of(database->content->models().size());
}

foresight_status foresight_database_object(const foresight_database* database, std::uint32_t index,
                                           foresight_object* object) {
  return guarded([&] {
    require(database, "database");
    const foresight::CompiledModel& model = at(database->content->models(), index, "index");
    const foresight::BoundingBox box = foresight::bounding_box(model);
    foresight_object given{};
    given.name = model.name.c_str();
    std::copy(box.centre.begin(), box.centre.end(), given.box_centre);
    std::copy(box.size.begin(), box.size.end(), given.box_size);
    given.diameter = model.diameter;
    give(given, object, "object");
    return FORESIGHT_DONE;
  });
}

foresight_status foresight_database_selftest(const foresight_database* database, std::uint32_t* failed, char* text,
                                             std::uint64_t capacity) {
  return guarded([&]() -> foresight_status {
    require(database, "database");
    if (capacity > 0) require(text, "text");
    const foresight::SelftestReport report = foresight::selftest(*database->content);
    if (failed != nullptr) *failed = static_cast<std::uint32_t>(report.failed);
    if (capacity > 0) text[report.text.copy(text, capacity - 1)] = '\0';
    return report.all_right ? FORESIGHT_DONE : FORESIGHT_NOTHING_FOUND;
  });
}

foresight_status foresight_recognizer_create(const foresight_database* database, const foresight_options* options,
                                             foresight_recognizer** recognizer) {
  return guarded([&] {
    require(database, "database");
    require(recognizer, "recognizer");
    *recognizer = new foresight_recognizer{foresight::Recognizer(database->content, options_of(options))};
    return FORESIGHT_DONE;
  });
}

void foresight_recognizer_release(foresight_recognizer* recognizer) { delete recognizer; }

foresight_status foresight_result_create(foresight_result** result) {
  return guarded([&] {
    require(result, "result");
    *result = new foresight_result{};
    return FORESIGHT_DONE;
  });
}

void foresight_result_release(foresight_result* result) { delete result; }

foresight_status foresight_recognize(const foresight_recognizer* recognizer, const foresight_image* image,
                                     std::int32_t deadline_ms, foresight_result* result) {
  const foresight_status status = guarded([&]() -> foresight_status {
    require(result, "result");
    require(recognizer, "recognizer");
    const auto view = take(image, "image");
    refuse_reserved(view.reserved, "image");
    if (deadline_ms < FORESIGHT_NO_DEADLINE)
      throw UsageError("deadline_ms", "is negative", "give milliseconds, or FORESIGHT_NO_DEADLINE");
    std::optional<std::chrono::milliseconds> deadline;
    if (deadline_ms != FORESIGHT_NO_DEADLINE) deadline = std::chrono::milliseconds(deadline_ms);
    recognizer->recognizer.recognize({view.rows, view.columns, view.xyz}, deadline, result->content);
    if (!result->content.complete) return FORESIGHT_DEADLINE;
    return result->content.detections.empty() ? FORESIGHT_NOTHING_FOUND : FORESIGHT_DONE;
  });
  const bool filled = status == FORESIGHT_DONE || status == FORESIGHT_NOTHING_FOUND || status == FORESIGHT_DEADLINE;
  if (!filled && result != nullptr) result->content = {};
  return status;
}

std::uint32_t foresight_result_detection_count(const foresight_result* result) {
  return result == nullptr ? 0 : count_of(result->content.detections.size());
}

foresight_status foresight_result_detection(const foresight_result* result, std::uint32_t index,
                                            foresight_detection* detection) {
  return guarded([&] {
    require(result, "result");
    give(detection_of(at(result->content.detections, index, "index")), detection, "detection");
    return FORESIGHT_DONE;
  });
}

foresight_status foresight_result_alternative(const foresight_result* result, std::uint32_t detection,
                                              std::uint32_t index, foresight_alternative* alternative) {
  return guarded([&] {
    require(result, "result");
    const auto& found = at(result->content.detections, detection, "detection");
    const foresight::Alternative& other = at(found.ambiguous_with, index, "index");
    foresight_alternative given{};
    given.object = other.object.c_str();
    std::copy(other.T_sensor_model.begin(), other.T_sensor_model.end(), given.pose);
    given.score = other.score;
    give(given, alternative, "alternative");
    return FORESIGHT_DONE;
  });
}

foresight_status foresight_result_statistics(const foresight_result* result, foresight_statistics* statistics) {
  return guarded([&] {
    require(result, "result");
    const foresight::Statistics& counts = result->content.statistics;
    const foresight_statistics given{sizeof(foresight_statistics),
                                     result->content.complete ? 1 : 0,
                                     counts.regions,
                                     counts.possible_matches,
                                     counts.threshold_matches,
                                     counts.active_matches,
                                     counts.hypotheses,
                                     counts.verifications,
                                     counts.energy_evaluations,
                                     counts.pose_checks,
                                     counts.pool_bytes};
    give(given, statistics, "statistics");
    return FORESIGHT_DONE;
  });
}

foresight_status foresight_result_times(const foresight_result* result, foresight_times* times) {
  return guarded([&] {
    require(result, "result");
    const foresight::StageTimes& spent = result->content.milliseconds;
    const foresight_times given{sizeof(foresight_times),
                                0,
                                spent.extract,
                                spent.field,
                                spent.hypotheses,
                                spent.localize,
                                spent.verify,
                                spent.total};
    give(given, times, "times");
    return FORESIGHT_DONE;
  });
}
