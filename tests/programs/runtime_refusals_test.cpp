// What foresight does with files it cannot use: one line that names the file, the documented code, and no output.
#include <gtest/gtest.h>

#include <filesystem>

#include "common/scan_file.h"
#include "compiler/database_writer.h"
#include "runtime/database.h"
#include "schema/container.h"
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

std::string number(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text.push_back(static_cast<char>((value >> (8 * i)) & 0xFF));
  return text;
}

std::string true_pose() { return made("pose.json", Json({{"pose", stick_scene().objects[0].T_sensor_model}}).dump()); }

void expect_database_refused(int code, const std::string& database, const std::string& words) {
  const std::string scan = stick_scene().scan;
  for (const char* format : {"text", "json", "bop-csv"}) {
    expect_refused(foresight({"recognize", database, scan, "--format", format}), code, "foresight", database, words);
  }
  expect_refused(foresight({"localize", database, scan, "--object", "stick", "--pose", true_pose()}), code, "foresight",
                 database, words);
  expect_refused(foresight({"selftest", database}), code, "foresight", database, words);
  const std::string labels = workshop().file("labels.png");
  expect_refused(foresight({"segment", scan, "--database", database, "-o", labels}), code, "foresight", database,
                 words);
  EXPECT_FALSE(fs::exists(labels));
}

void expect_scan_refused(const std::string& scan, const std::string& words,
                         const std::vector<std::string>& options = {}, std::string named = "") {
  if (named.empty()) named = scan;
  const auto with_options = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), options.begin(), options.end());
    return foresight(arguments);
  };
  for (const char* format : {"text", "json", "bop-csv"}) {
    expect_refused(with_options({"recognize", one_object(), scan, "--format", format}), 3, "foresight", named, words);
  }
  expect_refused(with_options({"localize", one_object(), scan, "--object", "stick", "--pose", true_pose()}), 3,
                 "foresight", named, words);
  const std::string fresh = workshop().file("fresh.png"), kept = made("kept.png", "another file");
  for (const std::string& output : {fresh, kept}) {
    expect_refused(with_options({"segment", scan, "-o", output}), 3, "foresight", named, words);
  }
  EXPECT_FALSE(fs::exists(fresh));
  EXPECT_EQ(file_content(kept), "another file");
}

TEST(RuntimeRefusals, databases_that_are_none) {
  expect_database_refused(3, workshop().file("missing.db"), "does not exist");
  expect_database_refused(3, folder("folder.db"), "is a folder");
  expect_database_refused(4, made("empty.db", ""), "the file is empty");
  expect_database_refused(4, project_file("models/sheet.png"), "this is a PNG image, not a Foresight database");
  expect_database_refused(4, stick_scene().scan, "this is a PCD file, not a Foresight database");
  expect_database_refused(4, stick(), "this is a text file, not a Foresight database");
}

TEST(RuntimeRefusals, damaged_databases) {
  const std::string whole = file_content(one_object());
  expect_database_refused(4, made("half.db", whole.substr(0, whole.size() / 2)), "ends after");
  expect_database_refused(4, made("start.db", whole.substr(0, 20)), "ends after 20 bytes");
  expect_database_refused(4, made("longer.db", whole + "x"), "1 bytes follow after the end");
  for (const std::size_t at : {std::size_t{20}, std::size_t{50}, whole.size() / 2, whole.size() - 1}) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    expect_database_refused(4, made("flipped.db", flipped), "checksum does not hold");
  }
}

// schema/README.md: a container version beyond ours is read while its oldest reader allows it, and refused otherwise.
TEST(RuntimeRefusals, databases_of_newer_versions) {
  const auto with_versions = [](std::uint32_t written, std::uint32_t oldest_reader) {
    std::string bytes = file_content(one_object());
    bytes.replace(8, 8, number(written, 4) + number(oldest_reader, 4));
    return bytes.replace(32, 8, number(checksum(std::string_view(bytes).substr(0, 32)), 8));
  };
  expect_database_refused(4, made("newer.db", with_versions(2, 2)), "asks for a reader of 2 or newer");
  const Outcome readable =
      foresight({"recognize", made("readable.db", with_versions(2, 1)), stick_scene().scan, "--format", "json"});
  const Outcome original = foresight({"recognize", one_object(), stick_scene().scan, "--format", "json"});
  EXPECT_EQ(readable.code, original.code) << readable.err;
  EXPECT_EQ(Json::parse(readable.out)["detections"], Json::parse(original.out)["detections"]);
}

TEST(RuntimeRefusals, database_of_a_newer_schema) {
  const std::string bytes = file_content(one_object());
  std::vector<Section> sections;
  for (const SectionView& section : decode_container(bytes, "")) {
    sections.push_back({std::string(section.name), std::string(section.content)});
  }
  // Field 1 of the Header, a varint: schema_version.
  ASSERT_EQ(sections[0].content.substr(0, 2), std::string("\x08") + static_cast<char>(kSchemaVersion));
  sections[0].content[1] = static_cast<char>(kSchemaVersion + 1);
  expect_database_refused(4, made("schema.db", encode_container(sections)),
                          "schema version " + std::to_string(kSchemaVersion + 1));
}

// As foresightc wrote them before there was the two-way method, which recognition uses unless told otherwise.
TEST(RuntimeRefusals, databases_without_acceptance_models) {
  CompiledDatabase content = decode_database(file_content(one_object()), one_object());
  content.models[0].acceptance = {};
  const std::string old = made("old.db", encode_database(content));
  const std::string scan = stick_scene().scan;
  expect_refused(foresight({"recognize", old, scan}), 4, "foresight", old, "--method paper");
  EXPECT_EQ(foresight({"recognize", old, scan, "--method", "paper"}).err, "");
}

TEST(RuntimeRefusals, scans_that_are_none) {
  expect_scan_refused(workshop().file("missing.pcd"), "does not exist");
  expect_scan_refused(folder("folder.pcd"), "is a folder");
  expect_scan_refused(made("empty.pcd", ""), "is empty");
  expect_scan_refused(one_object(), "is neither a PCD, a PLY nor a PNG file");
  expect_scan_refused(stick(), "is neither a PCD, a PLY nor a PNG file");
  expect_scan_refused(project_file("models/sheet.png"), "--camera");
}

TEST(RuntimeRefusals, damaged_scans) {
  const std::string whole = file_content(stick_scene().scan);
  expect_scan_refused(made("half.pcd", whole.substr(0, whole.size() / 2)), "cut short");
  expect_scan_refused(made("header.pcd", whole.substr(0, 60)), "");
  std::string unorganized = whole;
  unorganized.replace(unorganized.find("WIDTH 256"), 9, "WIDTH 61440");
  unorganized.replace(unorganized.find("HEIGHT 240"), 10, "HEIGHT 1");
  expect_scan_refused(made("unorganized.pcd", unorganized), "");
}

TEST(RuntimeRefusals, scan_without_a_valid_point) {
  const std::string scan = workshop().file("nan.pcd");
  write_pcd(scan, RangeImage(64, 64));
  expect_scan_refused(scan, "no cell holds a valid point");
}

TEST(RuntimeRefusals, scan_in_another_unit) {
  expect_scan_refused(stick_scene().scan, "--scan-unit", {"--scan-unit", "m"});
  RangeImage metres = read_scan(stick_scene().scan).image;
  for (Eigen::Vector3f& point : metres.points) point /= 1000.0F;
  const std::string scan = workshop().file("metres.pcd");
  write_pcd(scan, metres);
  expect_scan_refused(scan, "--scan-unit");
}

TEST(RuntimeRefusals, scan_whose_grid_is_no_camera) {
  RangeImage image(64, 64);
  for (int cell = 0; cell < image.size(); ++cell) {
    image[cell] = {static_cast<float>((cell * 7919) % 500), static_cast<float>((cell * 104729) % 500), 900.0F};
  }
  const std::string scan = workshop().file("shuffled.pcd");
  write_pcd(scan, image);
  expect_scan_refused(scan, "not that of a pinhole camera");
}

TEST(RuntimeRefusals, cameras) {
  const std::string png = workshop().file("depth");
  must_succeed(foresightc({"simulate", stick(), "-o", png, "--scenes", "1", "--format", "png"}));
  const std::string scan = png + "/scan_0000.png";
  const std::string good = png + "/camera.json";
  const std::string text = file_content(good);
  const auto expect_camera_refused = [&](const std::string& camera, const std::string& words) {
    expect_scan_refused(scan, words, {"--camera", camera}, camera);
  };
  expect_scan_refused(scan, "--camera");
  expect_camera_refused(workshop().file("missing.json"), "does not exist");
  expect_camera_refused(folder("folder.json"), "is a folder");
  expect_camera_refused(made("empty.json", ""), "");
  expect_camera_refused(made("half.json", text.substr(0, text.size() / 2)), "");
  expect_camera_refused(made("no_fx.json", R"({"fy": 770, "cx": 127, "cy": 119, "depth_scale": 0.1})"), "fx");
  expect_camera_refused(
      made("other.json",
           R"({"fx": 770, "fy": 770, "cx": 127, "cy": 119, "depth_scale": 0.1, "width": 640, "height": 480})"),
      "640x480");
  expect_scan_refused(stick_scene().scan, "belongs to depth PNGs only", {"--camera", good});
  const std::string cut = made("cut.png", file_content(scan).substr(0, 2000));
  expect_scan_refused(cut, "", {"--camera", good});
}

TEST(RuntimeRefusals, poses) {
  const auto expect_pose_refused = [](const std::string& pose, const std::string& words) {
    expect_refused(foresight({"localize", one_object(), stick_scene().scan, "--object", "stick", "--pose", pose}), 3,
                   "foresight", pose, words);
  };
  expect_pose_refused(workshop().file("missing.json"), "does not exist");
  expect_pose_refused(folder("pose folder"), "is a folder");
  expect_pose_refused(made("empty.json", ""), "is not JSON");
  const std::string whole = file_content(true_pose());
  expect_pose_refused(made("half.json", whole.substr(0, whole.size() / 2)), "is not JSON");
  expect_pose_refused(made("none.json", "{}"), "neither pose nor T_sensor_model");
  expect_pose_refused(made("3x4.json", R"({"pose": [[1,0,0,0],[0,1,0,0],[0,0,1,900]]})"), "not 4x4");
  expect_pose_refused(made("scaled.json", R"({"pose": [[2,0,0,0],[0,2,0,0],[0,0,2,900],[0,0,0,1]]})"),
                      "its rotation R is none");
  expect_pose_refused(made("mirror.json", R"({"pose": [[-1,0,0,0],[0,1,0,0],[0,0,1,900],[0,0,0,1]]})"), "mirrors");
  expect_pose_refused(made("words.json", R"({"pose": [["a",0,0,0],[0,1,0,0],[0,0,1,900],[0,0,0,1]]})"), "no number");
  const Outcome result = foresight({"recognize", two_objects(), stick_scene().scan, "--format", "json"});
  expect_pose_refused(made("result.json", result.out), "whole result");
}

TEST(RuntimeRefusals, outputs_that_cannot_be_written) {
  for (const auto& [output, words] :
       {std::pair(workshop().file("nowhere/out.png"), "its folder does not exist"),
        std::pair(one_object() + "/out.png", "cannot be written"), std::pair(folder("out.png"), "is a folder")}) {
    expect_refused(foresight({"segment", stick_scene().scan, "-o", output}), 3, "foresight", output, words);
    expect_refused(foresight({"segment", stick_scene().scan, "-o", output, "--color"}), 3, "foresight", output, words);
  }
}

// What was found in the scans before stands; the code is that of the error.
TEST(RuntimeRefusals, a_bad_scan_among_good_ones_ends_the_run) {
  const std::string missing = workshop().file("missing.pcd");
  const Outcome outcome =
      foresight({"recognize", two_objects(), stick_scene().scan, missing, stick_scene().scan, "--format", "json"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(lines_of(outcome.out).size(), 1U);
  EXPECT_TRUE(Json::accept(outcome.out));
  EXPECT_TRUE(outcome.err.starts_with("foresight: " + missing + ": ")) << outcome.err;
}

}  // namespace
}  // namespace foresight::test
