#include "runtime/foresight.h"

#include <atomic>
#include <cassert>
#include <cmath>
#include <string_view>

#include "common/errors.h"
#include "common/memory_pool.h"
#include "runtime/database.h"
#include "runtime/detection.h"
#include "runtime/recognize.h"
#include "runtime/selftest.h"

namespace foresight {
namespace {

bool side_in_limits(int cells) { return cells >= kSmallestImageSide && cells <= kLargestImageSide; }

RangeImage copy_image(const RangeImageView& view) {
  if (view.xyz == nullptr || !side_in_limits(view.rows) || !side_in_limits(view.columns)) {
    throw InputError("range image", "no data, or not between 32 x 32 and 4096 x 4096 cells",
                     "give a whole organized range image");
  }
  RangeImage image(view.rows, view.columns);
  for (int cell = 0; cell < image.size(); ++cell) {
    const float* xyz = view.xyz + 3 * static_cast<std::ptrdiff_t>(cell);
    if (std::isfinite(xyz[0]) && std::isfinite(xyz[1]) && std::isfinite(xyz[2]) && xyz[2] > 0.0F) {
      image[cell] = {xyz[0], xyz[1], xyz[2]};
    }
  }
  return image;
}

constexpr const char* kMemory = "(memory)";  // what errors call a database that has no file

}  // namespace

std::shared_ptr<const Database> load_shared_database(const std::string& file) {
  return std::make_shared<const Database>(load_database(file));
}

std::shared_ptr<const Database> load_shared_database(const DatabaseBytes& database) {
  const std::string_view bytes(static_cast<const char*>(database.data), database.data == nullptr ? 0 : database.size);
  return std::make_shared<const Database>(decode_database(bytes, kMemory));
}

// What one recognition at a time works with.
struct Workplace {
  MemoryPool pool;
  SpareDetections spare;

  Workplace(const Database& database, std::size_t reserve) : pool(reserve), spare(spare_detections(database)) {}
};

struct Recognizer::Impl {
  std::shared_ptr<const Database> database;
  RecognizeOptions options;
  Workplace workplace;
  std::atomic_flag in_use;  // the workplace

  Impl(std::shared_ptr<const Database> shared, const RecognizeOptions& given)
      : database(std::move(shared)), options(given), workplace(*database, given.reserved_memory) {}

  void recognize(const RangeImageView& view, std::optional<std::chrono::milliseconds> deadline, Workplace& at,
                 RecognitionResult& result) const;
};

Recognizer::Recognizer(const std::string& database_file, const RecognizeOptions& options) {
  check(options);
  impl_ = std::make_unique<Impl>(load_shared_database(database_file), options);
  check_method(options, *impl_->database, database_file);
}

Recognizer::Recognizer(std::shared_ptr<const Database> database, const RecognizeOptions& options) {
  assert(database != nullptr);
  check(options);
  check_method(options, *database, "shared database");
  impl_ = std::make_unique<Impl>(std::move(database), options);
}

Recognizer::Recognizer(const DatabaseBytes& database, const RecognizeOptions& options) {
  check(options);
  impl_ = std::make_unique<Impl>(load_shared_database(database), options);
  check_method(options, *impl_->database, kMemory);
}

Recognizer::~Recognizer() = default;
Recognizer::Recognizer(Recognizer&&) noexcept = default;
Recognizer& Recognizer::operator=(Recognizer&&) noexcept = default;

void Recognizer::Impl::recognize(const RangeImageView& view, std::optional<std::chrono::milliseconds> deadline,
                                 Workplace& at, RecognitionResult& result) const {
  const auto start = std::chrono::steady_clock::now();
  empty(result, at.spare);
  const PoolScope scope(at.pool);
  const RangeImage image = copy_image(view);
  const std::optional<PinholeCamera> camera = fit_camera(image);
  if (!camera) {
    throw InputError("range image", "its grid is not that of a pinhole camera, or hardly any cell is valid",
                     "give x, y, z in the sensor frame (x right, y down, z forward, mm), origin at the camera centre");
  }
  const Deadline until = deadline ? Deadline(start + *deadline) : std::nullopt;
  foresight::recognize(image, *camera, *database, options, until, result, at.spare);
  result.statistics.pool_bytes = static_cast<long>(at.pool.used());
}

void Recognizer::recognize(const RangeImageView& view, std::optional<std::chrono::milliseconds> deadline,
                           RecognitionResult& result) const {
  if (impl_->in_use.test_and_set(std::memory_order_acquire)) {
    Workplace own(*impl_->database, 0);
    impl_->recognize(view, deadline, own, result);
    return;
  }
  struct Leave {
    std::atomic_flag& in_use;
    ~Leave() { in_use.clear(std::memory_order_release); }
  } const leave{impl_->in_use};
  impl_->recognize(view, deadline, impl_->workplace, result);
}

RecognitionResult Recognizer::recognize(const RangeImageView& view,
                                        std::optional<std::chrono::milliseconds> deadline) const {
  RecognitionResult result;
  recognize(view, deadline, result);
  return result;
}

std::vector<std::string> Recognizer::object_names() const {
  std::vector<std::string> names;
  for (const CompiledModel& model : impl_->database->models()) names.push_back(model.name);
  return names;
}

const Database& Recognizer::database() const { return *impl_->database; }

SelftestReport selftest(const Database& database) {
  SelftestReport report;
  std::vector<ObjectSelftest> results;
  for (const CompiledModel& model : database.models()) {
    results.push_back(selftest_object(model, database.content()));
    report.text += selftest_line(results.back());
  }
  const SelftestCounts counts = count_verdicts(results);
  report.all_right = counts.all_right();
  report.failed = counts.failed;
  report.untested = counts.untested;
  report.text += selftest_summary(counts, database.content().tool_version);
  return report;
}

const char* version() { return FORESIGHT_VERSION; }

}  // namespace foresight
