#include "common/program.h"

#include <gtest/gtest.h>

#include <iostream>
#include <new>
#include <stdexcept>

#include "common/errors.h"

namespace foresight {
namespace {

using testing::internal::CaptureStderr;
using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStderr;
using testing::internal::GetCapturedStdout;

struct Outcome {
  int code = 0;
  std::string out, err;
};

// Runs a small program, `tool [--count N] [--progress STYLE]`, with these arguments.
Outcome run(
    std::vector<std::string> arguments, const std::function<int()>& command = [] { return kExitDone; }) {
  CLI::App app("A tool.", "tool");
  app.set_version_flag("--version", "tool 1.2");
  int count = 0;
  std::string progress = "auto";
  app.add_option("--count", count, "A count");
  add_progress_option(app, progress);
  arguments.insert(arguments.begin(), "tool");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  CaptureStdout();
  CaptureStderr();
  Outcome result;
  result.code = run_program("tool", app, static_cast<int>(argv.size()), argv.data(), command);
  result.out = GetCapturedStdout();
  result.err = GetCapturedStderr();
  return result;
}

template <typename Exception>
Outcome run_that_throws(const Exception& exception) {
  return run({}, [&]() -> int { throw exception; });
}

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

TEST(RunProgram, returns_what_the_command_returns) {
  for (const int code : {kExitDone, kExitNothingFound, kExitDeadline}) {
    const Outcome done = run({"--count", "3"}, [code] { return code; });
    EXPECT_EQ(done.code, code);
    EXPECT_EQ(done.err, "");
  }
}

TEST(RunProgram, answers_help_and_version_without_running) {
  for (const char* flag : {"--help", "--version"}) {
    const Outcome done = run({flag}, []() -> int { throw std::logic_error("it ran"); });
    EXPECT_EQ(done.code, kExitDone) << flag;
    EXPECT_TRUE(has(done.out, flag == std::string("--help") ? "--count" : "tool 1.2")) << done.out;
    EXPECT_EQ(done.err, "");
  }
}

TEST(RunProgram, refuses_a_wrong_command_line_with_2) {
  const std::vector<std::vector<std::string>> wrong = {
      {"--unknown"}, {"stray"}, {"--count"}, {"--count", "three"}, {"--progress", "loud"}};
  for (const auto& arguments : wrong) {
    const Outcome done = run(arguments, []() -> int { throw std::logic_error("it ran"); });
    EXPECT_EQ(done.code, kExitUsage) << arguments.front();
    EXPECT_TRUE(has(done.err, "tool: command line: ")) << done.err;
    EXPECT_TRUE(has(done.err, "tool --help")) << done.err;
    EXPECT_EQ(done.out, "");
  }
}

TEST(RunProgram, gives_each_error_its_documented_exit_code) {
  EXPECT_EQ(run_that_throws(UsageError("--top", "negative", "give a count")).code, 2);
  EXPECT_EQ(run_that_throws(InputError("a.pcd", "empty", "give another")).code, 3);
  for (const DatabaseFault fault : {DatabaseFault::wrong_kind, DatabaseFault::newer_version, DatabaseFault::truncated,
                                    DatabaseFault::corrupt, DatabaseFault::inconsistent, DatabaseFault::incompatible}) {
    EXPECT_EQ(run_that_throws(DatabaseError(fault, "a.db", "bad", "compile it again")).code, 4);
  }
}

TEST(RunProgram, prints_file_cause_and_mend_on_one_line) {
  const Outcome done = run_that_throws(InputError("a.pcd", "no cell is valid", "give another scan"));
  EXPECT_EQ(done.err, "tool: a.pcd: no cell is valid; give another scan\n");
  EXPECT_EQ(done.out, "");
}

TEST(RunProgram, calls_everything_else_an_internal_error) {
  const Outcome unknown = run_that_throws(std::logic_error("a wrong turn"));
  EXPECT_EQ(unknown.code, kExitInternal);
  EXPECT_TRUE(has(unknown.err, "internal error: a wrong turn")) << unknown.err;
  const Outcome memory = run_that_throws(std::bad_alloc());
  EXPECT_EQ(memory.code, kExitInternal);
  EXPECT_TRUE(has(memory.err, "memory")) << memory.err;
}

TEST(RunProgram, notices_output_that_could_not_be_written) {
  const Outcome done = run({}, [] {
    std::cout.setstate(std::ios::badbit);
    return kExitDone;
  });
  std::cout.clear();
  EXPECT_EQ(done.code, kExitBadInput);
  EXPECT_TRUE(has(done.err, "stdout")) << done.err;
}

std::string shown(const std::string& style, int total, int steps) {
  CaptureStderr();
  {
    Progress progress(style, "work", total);
    for (int i = 0; i < steps; ++i) progress.advance();
    progress.note("castle");
  }
  return GetCapturedStderr();
}

TEST(Progress, prints_a_plain_line_a_tenth) {
  std::string expected;
  for (int percent = 0; percent <= 100; percent += 10) expected += "work " + std::to_string(percent) + " %\n";
  EXPECT_EQ(shown("plain", 1000, 1000), expected);
}

TEST(Progress, ends_at_100_percent_however_many_steps_come) {
  const std::string text = shown("plain", 3, 8);
  EXPECT_TRUE(has(text, "work 100 %\n")) << text;
  EXPECT_EQ(text.find("work 100 %"), text.rfind("work 100 %"));
}

TEST(Progress, says_nothing_when_asked_for_none_or_away_from_a_terminal) {
  EXPECT_EQ(shown("none", 10, 10), "");
  EXPECT_EQ(shown("auto", 10, 10), "");
}

TEST(Progress, draws_a_bar_with_its_note_and_wipes_it) {
  const std::string text = shown("bar", 10, 5);
  EXPECT_TRUE(has(text, "50 %")) << text;
  EXPECT_TRUE(has(text, "castle")) << text;
  EXPECT_TRUE(text.ends_with("\r\033[K"));
}

TEST(Progress, of_no_work_at_all_is_no_trouble) { EXPECT_EQ(shown("plain", 0, 0), "work 0 %\n"); }

}  // namespace
}  // namespace foresight
