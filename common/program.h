// What the two programs have in common outside their work: error reporting, exit codes, the progress bar.
#pragma once

#include <functional>
#include <mutex>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace foresight {

// Parses the command line and runs the chosen command. Help and version exit with 0, a wrong command line with 2; what the
// command throws is printed as `NAME: FILE: cause; what to do` and turned into its documented exit code.
int run_program(const std::string& name, CLI::App& app, int argc, char** argv, const std::function<int()>& command);

// Progress on stderr: a bar that redraws itself, or a plain line per tenth, or nothing. Thread-safe.
class Progress {
 public:
  // style: none, plain, bar, or auto (bar on a terminal, else none).
  Progress(const std::string& style, std::string title, int total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(int steps = 1);
  void note(const std::string& text);  // a word behind the bar, such as the object at hand

 private:
  enum class Style { none, plain, bar };
  void draw();

  Style style_;
  std::string title_;
  std::string note_;
  int total_;
  int done_ = 0;
  int drawn_ = -1;
  std::mutex mutex_;
};

// Accepts numbers from `least` to `most`. NaN, which CLI::Range lets through, is none of them.
CLI::Validator number_between(double least, double most);

// The --progress option, for every command that takes a while.
void add_progress_option(CLI::App& command, std::string& style);

}  // namespace foresight
