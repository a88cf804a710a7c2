#include "common/program.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <new>
#include <sstream>

#include "common/errors.h"

namespace foresight {

int run_program(const std::string& name, CLI::App& app, int argc, char** argv, const std::function<int()>& command) {
  try {
    for (CLI::App* subcommand : app.get_subcommands([](const CLI::App*) { return true; })) {
      subcommand->set_version_flag("--version", app.version());
    }
    app.parse(argc, argv);
    const int code = command();
    std::cout.flush();
    if (!std::cout) throw InputError("stdout", "the output could not be written", "check the disk or the program reading it");
    return code;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::cerr << name << ": command line: " << error.what() << "; see " << name << " --help\n";
    return kExitUsage;
  } catch (const Error& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return error.exit_code();
  } catch (const std::bad_alloc&) {
    std::cerr << name << ": memory: not enough for this input; use a smaller model or scan, or a larger machine\n";
    return kExitInternal;
  } catch (const std::exception& error) {
    std::cerr << name << ": internal error: " << error.what() << "; please report it with the command and its input\n";
    return kExitInternal;
  }
}

Progress::Progress(const std::string& style, std::string title, int total)
    : style_(style == "plain" ? Style::plain : style == "bar" ? Style::bar : Style::none), title_(std::move(title)), total_(std::max(1, total)) {
  if (style == "auto" && isatty(STDERR_FILENO) != 0) style_ = Style::bar;
  draw();
}

Progress::~Progress() {
  if (style_ == Style::bar) std::fputs("\r\033[K", stderr);
}

void Progress::advance(int steps) {
  const std::lock_guard lock(mutex_);
  done_ = std::min(total_, done_ + steps);
  draw();
}

void Progress::note(const std::string& text) {
  const std::lock_guard lock(mutex_);
  note_ = text;
  draw();
}

void Progress::draw() {
  if (style_ == Style::none) return;
  const int percent = static_cast<int>(100.0 * done_ / total_);
  if (style_ == Style::plain) {
    if (percent / 10 == drawn_) return;
    drawn_ = percent / 10;
    std::fprintf(stderr, "%s %d %%\n", title_.c_str(), percent);
    return;
  }
  constexpr int kWidth = 30;
  const std::string filled(static_cast<std::size_t>(kWidth * done_ / total_), '#');
  std::fprintf(stderr, "\r\033[K%s [%-*s] %3d %% %s", title_.c_str(), kWidth, filled.c_str(), percent, note_.c_str());
  std::fflush(stderr);
}

CLI::Validator number_between(double least, double most) {
  std::ostringstream limits;
  limits << least << " to " << most;
  const auto fault_of = [=, limits = limits.str()](const std::string& text) {
    double value = 0.0;
    const bool accepted = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
    return accepted ? std::string() : text + " is not a number from " + limits;
  };
  return {fault_of, limits.str()};
}

void add_progress_option(CLI::App& command, std::string& style) {
  command.add_option("--progress", style, "Progress on stderr: none, plain, bar, or auto (a bar on a terminal)")
      ->check(CLI::IsMember({"none", "plain", "bar", "auto"}))
      ->capture_default_str();
}

}  // namespace foresight
