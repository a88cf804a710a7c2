// A robot's program waits no longer than it said: how late is an answer after its deadline, and how often is it whole?
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/intervals.h"
#include "benchmarks/series.h"
#include "benchmarks/table.h"
#include "common/errors.h"
#include "runtime/recognize.h"

namespace foresight {
namespace {

constexpr double kShortest = 1.0;  // deadlines, evenly spread over the logarithm. Unit: ms.
constexpr double kLongest = 500.0;

struct Answer {
  double deadline = 0.0;  // Unit: ms.
  double late = 0.0;      // by so much; 0: in time. Unit: ms.
  bool complete = false;
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// One at a time: deadlines of scans that share a core say nothing.
std::vector<Answer> answers_of(const ExperimentOptions& options, const SeriesSetup& setup) {
  std::vector<Answer> answers;
  const int several = std::min(6, static_cast<int>(setup.models.size()));
  for (int i = 0; i < options.n; ++i) {
    Random random(options.seed, static_cast<std::uint64_t>(i));
    // Many deadlines a scene: drawing one takes longer than recognizing it.
    const Scene scene = generate_scene(setup.models, setup.sensor, {1, several, setup.sensor.background}, options.seed,
                                       static_cast<std::uint64_t>(i / 10));
    Answer answer;
    answer.deadline = kShortest * std::pow(kLongest / kShortest, random.uniform());
    using std::chrono::steady_clock;
    const std::chrono::duration<double, std::milli> allowed(answer.deadline);
    const Deadline deadline = steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(allowed);
    answer.complete =
        recognize(scene.scan.image, setup.sensor.camera, *setup.database, options.method, deadline).complete;
    const std::chrono::duration<double, std::milli> late = steady_clock::now() - *deadline;
    answer.late = std::max(0.0, late.count());
    answers.push_back(answer);
  }
  return answers;
}

void run_deadlines(const ExperimentOptions& options) {
  const SeriesSetup setup = set_up_series(options);
  const std::vector<Answer> answers = answers_of(options, setup);
  Table table;
  table.header = {"deadline ms", "n",           "seed",          "complete %",
                  "late p50 ms", "late p99 ms", "late p99.9 ms", "late most ms"};
  const auto add_row = [&](const std::string& label, double from, double below) {
    std::vector<double> late;
    long complete = 0;
    for (const Answer& answer : answers) {
      if (answer.deadline < from || answer.deadline >= below) continue;
      late.push_back(answer.late);
      complete += answer.complete ? 1 : 0;
    }
    if (late.empty()) return;
    const auto n = static_cast<double>(late.size());
    table.rows.push_back({label, std::to_string(late.size()), std::to_string(options.seed),
                          decimal(100.0 * static_cast<double>(complete) / n, 1), decimal(quantile(late, 0.5), 2),
                          decimal(quantile(late, 0.99), 2), decimal(quantile(late, 0.999), 2),
                          decimal(quantile(late, 1.0), 2)});
  };
  add_row("1-5", 0.0, 5.0);
  add_row("5-20", 5.0, 20.0);
  add_row("20-100", 20.0, 100.0);
  add_row("100-500", 100.0, 1e9);
  add_row("all", 0.0, 1e9);
  write_csv(options, "deadlines", table);
  std::cout << "deadlines, seed " << options.seed << ", one thread\n" << to_text(table);
}

}  // namespace

Experiment add_deadlines(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand("deadlines", "How late answers are after deadlines from 1 to 500 ms");
  add_common_options(*command, *options, 1000);
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options] {
            run_deadlines(*options);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
