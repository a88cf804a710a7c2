// The command lines of both programs: help and version everywhere, and one clear line for what is wrong.
#include <gtest/gtest.h>

#include <filesystem>

#include "runtime/foresight.h"
#include "tests/programs/workshop.h"

namespace foresight::test {
namespace {

using Arguments = std::vector<std::string>;

const Arguments kCompilerCommands = {"compile", "link", "inspect", "simulate"};
const Arguments kRuntimeCommands = {"recognize", "localize", "segment", "selftest"};

void expect_help(const Outcome& outcome, const std::string& words) {
  expect_code(outcome, 0);
  EXPECT_TRUE(contains(outcome.out, "Usage: ")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, words)) << outcome.out;
}

TEST(CommandLine, help_on_every_level) {
  for (const std::string& command : kCompilerCommands) {
    expect_help(foresightc({"--help"}), command);
    expect_help(foresightc({command, "--help"}), command);
  }
  for (const std::string& command : kRuntimeCommands) {
    expect_help(foresight({"--help"}), command);
    expect_help(foresight({command, "--help"}), command);
  }
}

TEST(CommandLine, version_on_every_level) {
  const std::string number = std::string(version()) + "\n";
  expect_code(foresightc({"--version"}), 0);
  EXPECT_EQ(foresightc({"--version"}).out, "foresightc " + number);
  EXPECT_EQ(foresight({"--version"}).out, "foresight " + number);
  for (const std::string& command : kCompilerCommands) {
    expect_code(foresightc({command, "--version"}), 0);
    EXPECT_EQ(foresightc({command, "--version"}).out, "foresightc " + number);
  }
  for (const std::string& command : kRuntimeCommands) {
    expect_code(foresight({command, "--version"}), 0);
    EXPECT_EQ(foresight({command, "--version"}).out, "foresight " + number);
  }
}

// The part before the cause is "command line" or the name of the option.
void expect_usage_error(const Outcome& outcome, const std::string& program, const std::string& words) {
  const std::size_t start = program.size() + 2;
  const std::string file =
      outcome.err.size() > start ? outcome.err.substr(start, outcome.err.find(": ", start) - start) : "?";
  expect_refused(outcome, 2, program, file, words);
  EXPECT_TRUE(file == "command line" || file.starts_with("--")) << outcome.err;
  EXPECT_LT(outcome.err.size(), 300U) << outcome.err;
}

TEST(CommandLine, refuses_what_foresight_does_not_know) {
  const std::string db = "a.db", scan = "a.pcd";
  const std::vector<std::pair<Arguments, std::string>> wrong = {
      {{}, "subcommand"},
      {{"--bogus"}, ""},
      {{"bogus"}, ""},
      {{"recognize"}, "DB"},
      {{"selftest"}, "DB"},
      {{"selftest", db, "--format", "bop-csv"}, "bop-csv"},
      {{"recognize", db}, "SCAN"},
      {{"recognize", db, scan, "--bogus"}, "--bogus"},
      {{"recognize", db, scan, "--format"}, "--format"},
      {{"recognize", db, scan, "--format", "xml"}, "xml"},
      {{"recognize", db, scan, "--scan-unit", "cm"}, "cm"},
      {{"recognize", db, scan, "--deadline-ms", "0"}, "--deadline-ms"},
      {{"recognize", db, scan, "--deadline-ms", "-5"}, "--deadline-ms"},
      {{"recognize", db, scan, "--deadline-ms", "soon"}, "--deadline-ms"},
      {{"recognize", db, scan, "--deadline-ms", "99999999999"}, "--deadline-ms"},
      {{"recognize", db, scan, "--top", "-1"}, "--top"},
      {{"recognize", db, scan, "--max-verifications", "-1"}, "--max-verifications"},
      {{"recognize", db, scan, "--method", "guess"}, "--method"},
      {{"recognize", db, scan, "--loss", "absolute"}, "--loss"},
      {{"recognize", db, scan, "--prior-sign", "plus"}, "--prior-sign"},
      {{"recognize", db, scan, "--pruning", "some"}, "--pruning"},
      {{"recognize", db, scan, "--min-matched", "2"}, "--min-matched"},
      {{"recognize", db, scan, "--min-coherent", "nan"}, "--min-coherent"},
      {{"recognize", db, scan, "--max-occluding", "-0.1"}, "--max-occluding"},
      {{"recognize", db, scan, "--progress", "loud"}, "loud"},
      {{"localize", db, scan}, "required"},
      {{"localize", db, scan, "--object", "a"}, "--pose"},
      {{"localize", db, scan, "more", "--object", "a", "--pose", "p"}, "more"},
      {{"segment", scan}, "--output"},
  };
  for (const auto& [arguments, words] : wrong) expect_usage_error(foresight(arguments), "foresight", words);
}

TEST(CommandLine, refuses_what_foresightc_does_not_know) {
  const std::string db = workshop().file("wrong.db"), folder = workshop().file("wrong");
  const auto compile = [&](const Arguments& more) {
    Arguments arguments = {"compile", stick(), "-o", db, "--views", "20"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const auto simulate = [&](const Arguments& more) {
    Arguments arguments = {"simulate", castle(), stick(), "-o", folder, "--scenes", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const std::vector<std::pair<Arguments, std::string>> wrong = {
      {{}, "subcommand"},
      {{"bogus"}, ""},
      {{"compile"}, "CAD"},
      {{"compile", stick()}, "--output"},
      {{"link", "-o", db}, "DB"},
      {{"link", one_object()}, "--output"},
      {{"inspect"}, "DB"},
      {{"inspect", "a.db", "b.db"}, "b.db"},
      {{"simulate", stick()}, "--output"},
      {{"compile", stick(), "-o", db, "--views", "81"}, "81 is not 20 * 4^k"},
      {{"compile", stick(), "-o", db, "--views", "0"}, "20 * 4^k"},
      {{"compile", stick(), "-o", db, "--views", "-20"}, "20 * 4^k"},
      {{"compile", stick(), "-o", db, "--views", "1e3"}, "--views"},
      {compile({"--unit", "ft"}), "--unit"},
      {compile({"--jobs", "-1"}), "--jobs"},
      {compile({"--bins", "1"}), "--bins"},
      {compile({"--bins", "1001"}), "--bins"},
      {compile({"--kernel", "-1"}), "--kernel"},
      {compile({"--kernel", "nan"}), "--kernel"},
      {compile({"--spacing", "0"}), "--spacing"},
      {compile({"--spacing", "nan"}), "--spacing: nan is not a number from 0.1 to 1000"},
      {compile({"--name", "a", "--name", "b"}), "2 names for 1 CAD files"},
      {compile({"--name", ""}), "--name"},
      {compile({"--name", "two\nlines"}), "control characters"},
      {compile({"--name", std::string(1001, 'x')}), "longer than 1000 bytes"},
      {compile({"--progress", "loud"}), "loud"},
      {simulate({"--objects", "9-3"}), "from 9 to 3 objects a scene is no range"},
      {simulate({"--objects", "0"}), "from 0 to 0 objects a scene is no range"},
      {simulate({"--objects", ""}), "not a number or a range"},
      {simulate({"--objects", "1-"}), "not a number or a range"},
      {simulate({"--objects", "many"}), "not a number or a range"},
      {simulate({"--objects", "99999999999"}), "not a number or a range"},
      {simulate({"--objects", "3"}), "give more CAD files"},
      {simulate({"--objects", "1-3"}), "give more CAD files"},
      {simulate({"--scenes", "0"}), "--scenes"},
      {simulate({"--noise", "-1"}), "--noise"},
      {simulate({"--noise", "nan"}), "--noise"},
      {simulate({"--noise", "inf"}), "--noise"},
      {simulate({"--format", "ply"}), "--format"},
  };
  for (const auto& [arguments, words] : wrong) expect_usage_error(foresightc(arguments), "foresightc", words);
  EXPECT_FALSE(std::filesystem::exists(db));
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(CommandLine, refuses_two_objects_of_one_name) {
  const std::string db = workshop().file("twins.db");
  expect_refused(foresightc({"compile", stick(), stick(), "-o", db}), 2, "foresightc", stick(),
                 "two objects are named stick");
  EXPECT_FALSE(std::filesystem::exists(db));
}

TEST(CommandLine, names_the_objects_it_knows) {
  const Outcome outcome =
      foresight({"localize", two_objects(), stick_scene().scan, "--object", "hammer", "--pose", "p.json"});
  expect_refused(outcome, 2, "foresight", "--object", "no object named hammer in " + two_objects());
  EXPECT_TRUE(contains(outcome.err, "give one of: castle, stick")) << outcome.err;
}

}  // namespace
}  // namespace foresight::test
