// controller_habits: whether recognition, once warm, does what a robot's control loop must not do, and whether its
// answers are the same every time.
//
// Scans are drawn in one process and recognized in children of it, which are allowed no system call: what they would
// have asked of the kernel is counted, as are allocations, frees, locks and exceptions.
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "benchmarks/commands.h"
#include "benchmarks/habits/call_counter.h"
#include "benchmarks/series.h"
#include "common/errors.h"
#include "common/program.h"
#include "runtime/detection.h"

namespace foresight {
namespace {

constexpr int kBatch = 100;        // scans drawn at once
constexpr int kRepeatedScans = 4;  // taken by turns, so that a scan finds the memory as another one left it
constexpr int kWarmUp = 4;         // scans recognized before anything is counted

struct HabitsOptions {
  ExperimentOptions experiment;
  int repeats = 1000;
  int reserved_mib = 16;
};

// What a child leaves in memory that it shares with its parent.
struct Account {
  CallCounts counts;
  SystemCalls calls;
  long scans = 0;
  long detections = 0;
  long pool_bytes = 0;  // most of any scan
  long changed = 0;     // repeats that gave other bits
  bool traps = false;   // whether the kernel let system calls be counted
  int died = 0;         // of this signal
};

class SharedAccount {
 public:
  SharedAccount()
      : account_(static_cast<Account*>(
            mmap(nullptr, sizeof(Account), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    if (account_ == MAP_FAILED) throw std::bad_alloc();
    *account_ = {};
  }
  ~SharedAccount() { munmap(account_, sizeof(Account)); }
  SharedAccount(const SharedAccount&) = delete;
  SharedAccount& operator=(const SharedAccount&) = delete;
  Account& operator*() { return *account_; }

 private:
  Account* account_;
};

RangeImageView view_of(const RangeImage& image) { return {image.rows, image.columns, image.points.front().data()}; }

// Runs body in a child process that may call the system no more.
template <typename Body>
Account in_child(const Body& body) {
  SharedAccount shared;
  std::cout.flush();
  const pid_t child = fork();
  if (child < 0) throw UsageError("fork", "the system makes no more processes", "free some memory and processes");
  if (child == 0) {
    Account& account = *shared;
    account.traps = count_system_calls(account.calls);
    start_counting();
    body(account);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) (*shared).died = WTERMSIG(status);
  return *shared;
}

bool same_bits(const Detection& a, const Detection& b) {
  const auto same_alternative = [](const Alternative& x, const Alternative& y) {
    return x.object == y.object && x.T_sensor_model == y.T_sensor_model && x.score == y.score;
  };
  return a.object == b.object && a.T_sensor_model == b.T_sensor_model && a.score == b.score && a.matched == b.matched &&
         a.coherent == b.coherent && a.occluding == b.occluding && a.rank == b.rank && a.faces == b.faces &&
         a.regions == b.regions && a.covariance == b.covariance &&
         std::equal(a.ambiguous_with.begin(), a.ambiguous_with.end(), b.ambiguous_with.begin(), b.ambiguous_with.end(),
                    same_alternative);
}

bool same_bits(const RecognitionResult& a, const RecognitionResult& b) {
  const auto same = [](const Detection& x, const Detection& y) { return same_bits(x, y); };
  return a.complete == b.complete && a.statistics.hypotheses == b.statistics.hypotheses &&
         a.statistics.verifications == b.statistics.verifications &&
         a.statistics.energy_evaluations == b.statistics.energy_evaluations &&
         a.statistics.pose_checks == b.statistics.pose_checks &&
         std::equal(a.detections.begin(), a.detections.end(), b.detections.begin(), b.detections.end(), same);
}

std::vector<RangeImage> draw(const HabitsOptions& options, const SeriesSetup& setup, int first, int count) {
  std::vector<RangeImage> images(static_cast<std::size_t>(count));
  const int several = std::min(6, static_cast<int>(setup.models.size()));
  run_in_parallel(options.experiment, "scans " + std::to_string(first), count, [&](int i) {
    const SceneOptions scene{1, several, setup.sensor.background};
    images[static_cast<std::size_t>(i)] = generate_scene(setup.models, setup.sensor, scene, options.experiment.seed,
                                                         static_cast<std::uint64_t>(first + i))
                                              .scan.image;
  });
  return images;
}

void add(const Account& part, Account& all) {
  all.counts.allocations += part.counts.allocations;
  all.counts.frees += part.counts.frees;
  all.counts.locks += part.counts.locks;
  all.counts.exceptions += part.counts.exceptions;
  all.calls.count = all.calls.count + part.calls.count;
  if (all.calls.first < 0) all.calls.first = part.calls.first;
  if (all.died == 0) all.died = part.died;
  all.scans += part.scans;
  all.detections += part.detections;
  all.pool_bytes = std::max(all.pool_bytes, part.pool_bytes);
  all.changed += part.changed;
  all.traps = part.traps;
}

void recognize_into(const Recognizer& recognizer, const RangeImage& image, RecognitionResult& result,
                    Account& account) {
  recognizer.recognize(view_of(image), std::nullopt, result);
  ++account.scans;
  account.detections += static_cast<long>(result.detections.size());
  account.pool_bytes = std::max(account.pool_bytes, result.statistics.pool_bytes);
  account.counts = counted();
}

void print(const char* title, const Account& account) {
  std::cout << title << ": " << account.scans << " scans, " << account.detections << " detections; "
            << account.counts.allocations << " allocations, " << account.counts.frees << " frees, "
            << account.counts.locks << " locks, " << account.counts.exceptions << " exceptions, ";
  if (account.traps) {
    std::cout << account.calls.count << " system calls";
    if (account.calls.count > 0) std::cout << " (the first: number " << account.calls.first << ")";
  } else {
    std::cout << "system calls not counted (no seccomp here)";
  }
  std::cout << "; at most " << (account.pool_bytes + 1023) / 1024 << " KiB of memory in use\n";
  if (account.died != 0)
    std::cout << "  it died of signal " << account.died
              << ", as a program does that is denied what it asks of the system\n";
}

bool clean(const Account& account) {
  const CallCounts& counts = account.counts;
  return counts.allocations + counts.frees + counts.locks + counts.exceptions + account.calls.count == 0 &&
         account.changed == 0 && account.died == 0;
}

int run(const HabitsOptions& options) {
  const SeriesSetup setup = set_up_series(options.experiment);
  RecognizeOptions method = options.experiment.method;
  method.reserved_memory = static_cast<std::size_t>(options.reserved_mib) << 20;
  const Recognizer recognizer(std::shared_ptr<const Database>(setup.database.get(), [](const Database*) {}), method);
  RecognitionResult result;
  Account all;
  for (int first = 0; first < options.experiment.n; first += kBatch) {
    const auto images = draw(options, setup, first, std::min(kBatch, options.experiment.n - first));
    if (first == 0) {
      Account ignored;
      for (int i = 0; i < std::min(kWarmUp, static_cast<int>(images.size())); ++i) {
        recognize_into(recognizer, images[static_cast<std::size_t>(i)], result, ignored);
      }
    }
    add(in_child([&](Account& account) {
          for (const RangeImage& image : images) recognize_into(recognizer, image, result, account);
        }),
        all);
  }
  print("different scans", all);

  const auto images = draw(options, setup, 0, kRepeatedScans);
  std::vector<RecognitionResult> expected(images.size());
  Account ignored;
  for (std::size_t i = 0; i < images.size(); ++i) recognize_into(recognizer, images[i], expected[i], ignored);
  const Account repeated = in_child([&](Account& account) {
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
      for (std::size_t i = 0; i < images.size(); ++i) {
        recognize_into(recognizer, images[i], result, account);
        account.changed += same_bits(result, expected[i]) ? 0 : 1;
      }
    }
  });
  print("the same scans", repeated);
  std::cout << kRepeatedScans << " scans recognized " << options.repeats << " times: " << repeated.changed
            << " answers had other bits\n";
  return clean(all) && clean(repeated) ? 0 : 1;
}

}  // namespace
}  // namespace foresight

int main(int argc, char** argv) {
  using namespace foresight;
  CLI::App app(
      "Whether recognition allocates, locks, throws or calls the system, and always answers alike. 0: none of it.",
      "controller_habits");
  HabitsOptions options;
  add_common_options(app, options.experiment, 10000);
  add_object_options(app, options.experiment);
  add_method_options(app, options.experiment);
  app.add_option("--repeats", options.repeats, "of each of four scans")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--reserved", options.reserved_mib, "memory the recognizer takes beforehand, MiB")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  return run_program("controller_habits", app, argc, argv, [&] { return run(options); });
}
