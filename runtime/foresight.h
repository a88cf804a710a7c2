// Foresight's public interface: load a compiled database once, recognize its objects in range images.
//
// Needs nothing but the C++ standard library to include. Link foresight_runtime.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// The version of this interface, the project's own; runtime/README.md has the rules.
#define FORESIGHT_API_VERSION_MAJOR 0
#define FORESIGHT_API_VERSION_MINOR 1
#define FORESIGHT_API_VERSION_PATCH 0
#define FORESIGHT_API_VERSION \
  (FORESIGHT_API_VERSION_MAJOR * 10000 + FORESIGHT_API_VERSION_MINOR * 100 + FORESIGHT_API_VERSION_PATCH)

namespace foresight {

class Database;

// A range image in the caller's memory. Sensor frame: x right, y down, z forward. Unit: mm.
struct RangeImageView {
  int rows = 0;                // Limit: 32 to 4096.
  int columns = 0;             // Limit: 32 to 4096.
  const float* xyz = nullptr;  // rows*columns*3 values, row by row; an invalid cell has NaN in all three
};

// Another explanation of what a detection explains.
struct Alternative {
  std::string object;                       // name of the compiled model
  std::array<double, 16> T_sensor_model{};  // as in Detection
  double score = 0.0;                       // as in Detection
};

// One recognized object.
struct Detection {
  std::string object;                       // name of the compiled model
  std::array<double, 16> T_sensor_model{};  // row-major; takes model points (mm) into the sensor frame (mm)
  double score = 0.0;      // 0 to 1: how probably the pose is right; the paper's method: the matched fraction
  double matched = 0.0;    // alpha, Section V.C
  double coherent = 0.0;   // beta
  double occluding = 0.0;  // gamma
  int rank = 0;  // place of its start pose (of its hypothesis: the paper's method) in the order of trying, from 1
  std::vector<int> faces;                   // faces in sight at this pose (of the hypothesis: the paper's method), and
  std::vector<int> regions;                 // the regions that show them
  std::vector<Alternative> ambiguous_with;  // other poses or objects that this view fits equally well; mostly none
  std::array<double, 4> quaternion{1.0, 0.0, 0.0, 0.0};  // the pose's rotation as w, x, y, z: unit, w >= 0
  // Mean square error of the pose, 6 x 6, row-major, positive definite. The error d = x, y, z (mm), w = rotation vector
  // (rad), both along the sensor's axes: the true pose is exp(w) R, t + d, so that the rotation is about the model's
  // origin (as in ROS's PoseWithCovariance). Of the sensor's noise alone: runtime/pose_covariance.h.
  std::array<double, 36> covariance{};
  std::array<double, 3> box_centre{};  // of the CAD model's bounding box, along the model's axes. Model frame, mm.
  std::array<double, 3> box_size{};    // Unit: mm.
};

// Columns of the paper's Fig. 9, and the count of eq. (9) evaluations (Table I's cost).
struct Statistics {
  int regions = 0;
  long possible_matches = 0;
  long threshold_matches = 0;
  long active_matches = 0;
  long hypotheses = 0;
  long verifications = 0;
  long energy_evaluations = 0;
  long pose_checks = 0;  // poses looked at before localization; 0 with the paper's method
  long pool_bytes = 0;   // of the recognizer's memory that were used; 0 where it was not a Recognizer's
};

// Time of each stage. Unit: ms.
struct StageTimes {
  double extract = 0.0;
  double field = 0.0;  // likelihoods, field and highest confidence first
  double hypotheses = 0.0;
  double localize = 0.0;
  double verify = 0.0;
  double total = 0.0;
};

struct RecognitionResult {
  bool complete = true;               // false: the deadline came first, detections are those found until then
  std::vector<Detection> detections;  // in the order found
  Statistics statistics;
  StageTimes milliseconds;
};

enum class Loss { lorentzian, tukey, huber, gaussian };  // rho of Section V.B
enum class PriorSign {
  minus_log,
  plus_log_as_printed
};  // 1-clique potential; the paper prints +log P(M), eq. (3) wants -log
enum class Pruning {
  highest_confidence_first,
  none
};  // none: every match above zero stays active; with Method::two_way, hypotheses are looked at however badly rated

// Clique potentials of Section IV.A, for the paper's method; lower is better. The potentials of pairs count once for
// each unordered pair. Limit: -10000 to 10000 each.
struct Potentials {
  double support_on_on = -60.0;
  double support_off_off = 40.0;
  double contradiction_on_on = 60.0;
  double contradiction_on_off = -10.0;
  PriorSign prior_sign = PriorSign::minus_log;
};

// How hypotheses are judged: by alpha, beta and gamma, the first acceptable one first (Section V.C); or by evidence for
// and against them, as a calibrated probability, the best one first (runtime/two_way_search.h).
enum class Method { two_way, paper };

struct RecognizeOptions {
  Method method = Method::two_way;
  Potentials potentials;
  Pruning pruning = Pruning::highest_confidence_first;
  Loss loss = Loss::lorentzian;
  double smallest_matched =
      0.5;  // alpha, Section V.C; decides with Method::paper only, as the next two. Limit: 0 to 1.
  double smallest_coherent = 0.4;    // beta, Section V.C. Limit: 0 to 1.
  double largest_occluding = 0.175;  // gamma, Section V.C. Limit: 0 to 1.
  int most_detections = 0;           // stop after this many, 0 = no limit. Limit: >= 0.
  int most_verifications = 0;        // stop after this many, 0 = no limit. Limit: >= 0.
  // What a Recognizer takes from the heap when it is made. Scans that need more take it then, and the recognizer keeps
  // it: Statistics::pool_bytes says how much one needed. Unit: bytes.
  std::size_t reserved_memory = 0;
};

// The bytes of a database file, wherever they come from: for programs without a file system.
struct DatabaseBytes {
  const void* data = nullptr;
  std::size_t size = 0;
};

// A database for several recognizers: immutable, and shared by as many threads as want it. Throws DatabaseError or
// InputError (common/errors.h) when it cannot be used. The bytes may go once it returns; errors name them `(memory)`.
[[nodiscard]] std::shared_ptr<const Database> load_shared_database(const std::string& file);
[[nodiscard]] std::shared_ptr<const Database> load_shared_database(const DatabaseBytes& database);

// Recognizes the objects of one database. Have one for each thread, all of a shared database: a recognizer keeps the
// memory that a scan needed for the next one. Const methods may be called from several threads; what finds the memory
// in use takes its own from the heap.
class Recognizer {
 public:
  // Throws DatabaseError or InputError (common/errors.h) when the file cannot be used, UsageError for options outside
  // their limits.
  explicit Recognizer(const std::string& database_file, const RecognizeOptions& options = {});
  // Likewise; the bytes may go once it returns. Errors name the database `(memory)`.
  explicit Recognizer(const DatabaseBytes& database, const RecognizeOptions& options = {});
  // Throws DatabaseError when the database lacks what the method of the options needs, UsageError for options outside
  // their limits. REQUIRES: database is not null.
  explicit Recognizer(std::shared_ptr<const Database> database, const RecognizeOptions& options = {});
  ~Recognizer();
  Recognizer(Recognizer&&) noexcept;
  Recognizer& operator=(Recognizer&&) noexcept;

  // Throws InputError when the view is outside its limits, has no valid cell or is not a pinhole grid; nothing else.
  [[nodiscard]] RecognitionResult recognize(const RangeImageView& image,
                                            std::optional<std::chrono::milliseconds> deadline = {}) const;
  // The same, in place of what the result holds; when it throws, that is nothing. For programs that run on time: by the
  // two-way method, with a recognizer and a result that have seen such scans before or with enough reserved_memory, it
  // neither allocates nor frees, takes no lock, throws nothing and makes no system call (runtime/README.md).
  void recognize(const RangeImageView& image, std::optional<std::chrono::milliseconds> deadline,
                 RecognitionResult& result) const;

  [[nodiscard]] std::vector<std::string> object_names() const;
  [[nodiscard]] const Database& database() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// What a selftest came to.
struct SelftestReport {
  bool all_right = false;  // at least one object was tested, and none failed
  int failed = 0;          // objects not recognized, or at wrong poses only
  int untested = 0;        // objects without a golden scan, as of databases of earlier compilers
  std::string text;        // for eyes: a line for each object, and a last one of all
};

// Whether this program on this machine still recognizes each object of the database in its golden scan: the simulated
// scan in which the compiler recognized it. Takes as long as a scan for each object.
[[nodiscard]] SelftestReport selftest(const Database& database);

// "0.1.0"
[[nodiscard]] const char* version();

}  // namespace foresight
