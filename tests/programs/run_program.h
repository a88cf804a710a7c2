// Runs the two binaries as a user does, and says what they did.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support.h"

namespace foresight::test {

struct Outcome {
  int code = -1;  // exit code; 128 + signal when it was killed, as a shell says it
  std::string out;
  std::string err;
};

inline std::string file_content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_content(const std::string& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

// One word for the shell, whatever is in it.
inline std::string shell_word(const std::string& text) {
  std::string word(1, '\'');
  for (const char c : text) {
    if (c == '\'') {
      word.append("'\\''");
    } else {
      word.push_back(c);
    }
  }
  return word.append(1, '\'');
}

// stdin is empty, stdout and stderr are files, so that no terminal changes what is printed.
inline Outcome run(const std::string& program, const std::vector<std::string>& arguments) {
  const TemporaryFolder streams;
  std::string command = shell_word(program);
  for (const std::string& argument : arguments) command += " " + shell_word(argument);
  command += " </dev/null >" + shell_word(streams.file("out")) + " 2>" + shell_word(streams.file("err"));
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, file_content(streams.file("out")), file_content(streams.file("err"))};
}

inline Outcome foresightc(const std::vector<std::string>& arguments) { return run(FORESIGHTC_PROGRAM, arguments); }
inline Outcome foresight(const std::vector<std::string>& arguments) { return run(FORESIGHT_PROGRAM, arguments); }

inline bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

// It ended with the code and had nothing to complain about.
inline void expect_code(const Outcome& outcome, int code) {
  EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "");
}

// One line on stderr, `PROGRAM: FILE: cause; what to do`, with the words in it; nothing on stdout.
inline void expect_refused(const Outcome& outcome, int code, const std::string& program, const std::string& file,
                           const std::string& words) {
  EXPECT_EQ(outcome.code, code) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const std::string start = program + ": " + file + ": ";
  EXPECT_TRUE(outcome.err.starts_with(start)) << "expected: " << start << "\ngot: " << outcome.err;
  EXPECT_TRUE(contains(outcome.err, words)) << "expected: " << words << "\ngot: " << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "; ")) << "no word on what to do: " << outcome.err;
  EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  EXPECT_TRUE(outcome.err.ends_with("\n")) << outcome.err;
}

}  // namespace foresight::test
