// What foresightc does with files it cannot use: one line that names the file, the documented code, and no output.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>

#include "tests/programs/workshop.h"

namespace foresight::test {
namespace {

namespace fs = std::filesystem;

std::string made(const std::string& name, const std::string& content) {
  const std::string file = workshop().file(name);
  write_content(file, content);
  return file;
}

std::string folder(const std::string& name) {
  fs::create_directories(workshop().file(name));
  return workshop().file(name);
}

// Refused, and neither is an output made nor one touched that was there.
void expect_compile_refused(const std::vector<std::string>& arguments, const std::string& file,
                            const std::string& words) {
  const std::string fresh = workshop().file("fresh.db");
  const std::string kept = made("kept.db", "another file");
  for (const std::string& output : {fresh, kept}) {
    std::vector<std::string> all = {"compile", "-o", output, "--views", "20"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    expect_refused(foresightc(all), 3, "foresightc", file, words);
  }
  EXPECT_FALSE(fs::exists(fresh));
  EXPECT_EQ(file_content(kept), "another file");
}

void expect_cad_refused(const std::string& cad, const std::string& words) {
  expect_compile_refused({cad}, cad, words);
  expect_compile_refused({castle(), cad}, cad, words);  // one bad file among good ones
  const std::string scenes = workshop().file("scenes");
  expect_refused(foresightc({"simulate", cad, "-o", scenes, "--scenes", "1"}), 3, "foresightc", cad, words);
  EXPECT_FALSE(fs::exists(scenes));
}

// The stick's OFF lines; [1] is the header of numbers.
std::vector<std::string> off_lines() { return lines_of(file_content(stick())); }

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// The vertices of the stick with another scale.
std::string scaled_off(double scale) {
  std::vector<std::string> lines = off_lines();
  const std::size_t vertices = std::stoul(lines[1]);
  for (std::size_t i = 2; i < 2 + vertices; ++i) {
    std::istringstream in(lines[i]);
    double x = 0.0, y = 0.0, z = 0.0;
    in >> x >> y >> z;
    std::ostringstream out;
    out << x * scale << " " << y * scale << " " << z * scale;
    lines[i] = out.str();
  }
  return joined(lines);
}

TEST(CompilerRefusals, cad_file_that_is_not_there_or_no_cad_file) {
  expect_cad_refused(workshop().file("missing.off"), "no such file");
  expect_cad_refused(folder("folder.off"), "is a folder");
  expect_cad_refused(made("empty.off", ""), "is empty");
  expect_cad_refused(one_object(), "not a kind of CAD file known here");
  for (const char* kind : {"off", "obj", "stl", "ply"}) {
    expect_cad_refused(made(std::string("text.") + kind, "These are not the triangles you are looking for.\n"), "");
  }
  expect_cad_refused(made("database.ply", file_content(one_object())), "damaged");
}

TEST(CompilerRefusals, cad_file_cut_short) {
  const std::string whole = file_content(stick());
  expect_cad_refused(made("half.off", whole.substr(0, whole.size() / 2)), "cut short");
  expect_cad_refused(made("header.off", whole.substr(0, 12)), "");
}

TEST(CompilerRefusals, open_mesh) {
  std::vector<std::string> lines = off_lines();
  std::istringstream header(lines[1]);
  std::size_t vertices = 0, triangles = 0;
  header >> vertices >> triangles;
  lines[1] = std::to_string(vertices) + " " + std::to_string(triangles - 1) + " 0";
  lines.pop_back();
  expect_cad_refused(made("open.off", joined(lines)), "not closed: 3 open edges");
}

TEST(CompilerRefusals, coordinates_that_are_no_numbers) {
  std::vector<std::string> lines = off_lines();
  lines[2] = "nan 0 0";
  expect_cad_refused(made("nan.off", joined(lines)), "");
  lines[2] = "1e999 0 0";
  expect_cad_refused(made("huge.off", joined(lines)), "");
}

TEST(CompilerRefusals, wrong_unit_with_the_likely_one) {
  expect_cad_refused(made("metres.off", scaled_off(1e-3)), "if the file is in metres, pass --unit m");
  expect_cad_refused(made("large.off", scaled_off(1e6)), "of the field of view");
  const std::string mm = made("in_mm.off", scaled_off(1.0));
  expect_compile_refused({mm, "--unit", "m"}, mm, "pass --unit mm");
}

TEST(CompilerRefusals, sensor_files) {
  const std::string scanner = file_content(project_file("models/sensors/scanner.textproto"));
  const auto expect_sensor_refused = [](const std::string& sensor, const std::string& words) {
    expect_compile_refused({stick(), "--sensor", sensor}, sensor, words);
    const std::string scenes = workshop().file("scenes");
    expect_refused(foresightc({"simulate", stick(), "-o", scenes, "--sensor", sensor}), 3, "foresightc", sensor, words);
    EXPECT_FALSE(fs::exists(scenes));
  };
  expect_sensor_refused(workshop().file("missing.textproto"), "does not exist");
  expect_sensor_refused(folder("folder.textproto"), "is a folder");
  expect_sensor_refused(made("empty.textproto", ""), "name is missing");
  expect_sensor_refused(made("half.textproto", scanner.substr(0, scanner.find("fx"))), "");
  expect_sensor_refused(made("typing.textproto", scanner + "zoom: 3\n"), "zoom");
  expect_sensor_refused(made("negative.textproto", scanner + "depth_noise_mm: -1\n"), "");
  expect_sensor_refused(stick(), "");
  expect_sensor_refused(one_object(), "");
}

TEST(CompilerRefusals, databases_that_are_none) {
  const auto expect_both_refuse = [](int code, const std::string& database, const std::string& words) {
    expect_refused(foresightc({"inspect", database}), code, "foresightc", database, words);
    expect_refused(foresightc({"inspect", database, "--json"}), code, "foresightc", database, words);
    const std::string fresh = workshop().file("linked.db"), kept = made("kept.db", "another file");
    for (const std::string& output : {fresh, kept}) {
      expect_refused(foresightc({"link", one_object(), database, "-o", output}), code, "foresightc", database, words);
    }
    EXPECT_FALSE(fs::exists(fresh));
    EXPECT_EQ(file_content(kept), "another file");
  };
  const std::string whole = file_content(one_object());
  expect_both_refuse(3, workshop().file("missing.db"), "does not exist");
  expect_both_refuse(3, folder("folder.db"), "is a folder");
  expect_both_refuse(4, made("empty.db", ""), "the file is empty");
  expect_both_refuse(4, made("half.db", whole.substr(0, whole.size() / 2)), "ends after");
  expect_both_refuse(4, made("text.db", "a text\n"), "this is a text file");
  std::string flipped = whole;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 4);
  expect_both_refuse(4, made("flipped.db", flipped), "checksum does not hold");
}

// Found out before anything is written; root may write everywhere, so the places are ones where nobody can.
TEST(CompilerRefusals, outputs_that_cannot_be_written) {
  const std::string nowhere = workshop().file("nowhere/out.db");
  expect_refused(foresightc({"compile", stick(), "-o", nowhere, "--views", "20"}), 3, "foresightc", nowhere,
                 "its folder does not exist");
  expect_refused(foresightc({"link", one_object(), "-o", nowhere}), 3, "foresightc", nowhere,
                 "its folder does not exist");
  const std::string under_file = one_object() + "/out.db";
  expect_refused(foresightc({"link", one_object(), "-o", under_file}), 3, "foresightc", under_file,
                 "cannot be written");
  expect_refused(foresightc({"link", one_object(), "-o", folder("out.db")}), 3, "foresightc", workshop().file("out.db"),
                 "is a folder");
  const std::string scenes = one_object() + "/scenes";
  expect_refused(foresightc({"simulate", stick(), "-o", scenes}), 3, "foresightc", scenes, "cannot be made");
  const std::string depfile = workshop().file("nowhere/out.d"), database = workshop().file("with_depfile.db");
  expect_refused(foresightc({"compile", stick(), "-o", database, "--views", "20", "--depfile", depfile}), 3,
                 "foresightc", depfile, "its folder does not exist");
  EXPECT_FALSE(fs::exists(database)) << "a database without its dependencies";
}

TEST(CompilerRefusals, folder_without_permission) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const std::string locked = folder("locked");
  fs::permissions(locked, fs::perms::owner_read | fs::perms::owner_exec);
  const std::string output = locked + "/out.db";
  expect_refused(foresightc({"link", one_object(), "-o", output}), 3, "foresightc", output, "cannot be written");
  fs::permissions(locked, fs::perms::owner_all);
}

}  // namespace
}  // namespace foresight::test
