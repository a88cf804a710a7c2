#include "runtime/commands.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <span>
#include <thread>

#include "common/bop_scene.h"
#include "common/errors.h"
#include "common/program.h"
#include "common/scan_file.h"
#include "runtime/database.h"
#include "runtime/pose_file.h"
#include "runtime/recognize.h"
#include "runtime/result_writer.h"
#include "runtime/selftest_writer.h"

namespace foresight {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// A scan with the camera of its file, or else the one its grid shows.
struct ReadyScan {
  RangeImage image;
  PinholeCamera camera;
  double read_milliseconds = 0.0;
};

ReadyScan read_ready_scan(const std::string& file, const ScanReadOptions& options) {
  const Clock::time_point start = Clock::now();
  Scan scan = read_scan(file, options);
  const std::optional<PinholeCamera> camera = scan.camera ? scan.camera : fit_camera(scan.image);
  if (!camera) {
    throw InputError(file, "its grid is not that of a pinhole camera, or hardly any cell is valid",
                     "give points in the sensor frame (x right, y down, z forward), origin at the camera centre");
  }
  return {std::move(scan.image), *camera, milliseconds_since(start)};
}

ScanReadOptions read_options(const ScanSource& source) {
  return {source.camera_file, source.unit == "m" ? 1000.0 : 1.0, {}};
}

// A scan on disk and how to read it.
struct ListedScan {
  std::string file;
  ScanReadOptions options;
};

// A folder stands for all images of a BOP scene.
std::vector<ListedScan> list_scans(const RecognizeCommand& command) {
  std::vector<ListedScan> listed;
  for (const std::string& scan : command.scans) {
    std::error_code error;
    if (!std::filesystem::is_directory(scan, error)) {
      listed.push_back({scan, read_options(command.source)});
      continue;
    }
    std::vector<SceneImage> images = read_bop_scene(scan);
    if (!command.source.camera_file.empty()) {
      throw UsageError("--camera", "a camera file was given for the scene folder " + scan,
                       "leave it out; scene_camera.json in the folder has the cameras");
    }
    for (SceneImage& image : images) listed.push_back({image.file, {image.camera_file, 1.0, image.camera}});
  }
  return listed;
}

void print(const RecognizeCommand& command, const std::string& scan, const RecognitionResult& result,
           const std::vector<std::string>& names, double read_milliseconds) {
  if (command.format == "json") {
    std::cout << result_json(scan, result, read_milliseconds) << "\n";
  } else if (command.format == "bop-csv") {
    std::cout << bop_csv_rows(scan, result, names, read_milliseconds);
  } else {
    std::cout << result_text(scan, result, read_milliseconds);
  }
  std::cout.flush();  // a line a scan, for whoever reads along
}

std::vector<std::string> names_of(const Database& database) {
  std::vector<std::string> names;
  for (const CompiledModel& model : database.models()) names.push_back(model.name);
  return names;
}

const CompiledModel& find_model(const Database& database, const std::string& name, const std::string& file) {
  const auto& models = database.models();
  const auto found =
      std::find_if(models.begin(), models.end(), [&](const CompiledModel& model) { return model.name == name; });
  if (found != models.end()) return *found;
  std::string known;
  for (const CompiledModel& model : models) known += (known.empty() ? "" : ", ") + model.name;
  throw UsageError("--object", "no object named " + name + " in " + file, "give one of: " + known);
}

// Hues by the golden angle: neighbouring labels look different.
std::vector<unsigned char> color_labels(std::span<const int> labels) {
  std::vector<unsigned char> rgb(labels.size() * 3, 0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == 0) continue;
    const double hue = std::fmod(labels[i] * 0.61803398875, 1.0) * 6.0;
    const double shade = labels[i] % 3 == 0 ? 0.6 : 0.95;
    for (std::size_t k = 0; k < 3; ++k) {
      const double distance = std::abs(std::fmod(hue + 6.0 - 2.0 * static_cast<double>(k), 6.0) - 3.0);
      rgb[3 * i + k] = static_cast<unsigned char>(255.0 * shade * std::clamp(distance - 1.0, 0.15, 1.0));
    }
  }
  return rgb;
}

// Without a database there is no sensor: the noise is that of the paper's sensor on this scan's grid.
SegmentationOptions default_segmentation(const ReadyScan& scan) {
  std::vector<float> depths;
  for (const Eigen::Vector3f& point : scan.image.points) {
    if (!std::isnan(point.z())) depths.push_back(point.z());
  }
  std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2), depths.end());
  SensorModel sensor;
  sensor.camera = scan.camera;
  sensor.nearest_distance = sensor.farthest_distance = static_cast<double>(depths[depths.size() / 2]);
  return segmentation_options_for(sensor);
}

RecognitionResult recognize_in(MemoryPool& pool, const ReadyScan& scan, const Database& database,
                               const RecognizeOptions& options, const Deadline& deadline) {
  const PoolScope scope(pool);
  return recognize(scan.image, scan.camera, database, options, deadline);
}

}  // namespace

int run_recognize(const RecognizeCommand& command) {
  check(command.options);
  const Database database = load_database(command.database);
  check_method(command.options, database, command.database);
  const std::vector<std::string> names = names_of(database);
  bool any_found = false;
  bool all_complete = true;
  const std::vector<ListedScan> scans = list_scans(command);
  // The bar would fight with results printed to the same terminal, so it shows only where they go elsewhere.
  MemoryPool pool;
  Progress progress(scans.size() > 1 ? command.progress : "none", "recognize", static_cast<int>(scans.size()));
  for (const auto& [file, options] : scans) {
    const ReadyScan scan = read_ready_scan(file, options);
    const Deadline deadline = command.deadline_ms > 0
                                  ? Deadline(Clock::now() + std::chrono::milliseconds(command.deadline_ms))
                                  : std::nullopt;
    const RecognitionResult result = recognize_in(pool, scan, database, command.options, deadline);
    // Not before the first result: a refused scan leaves stdout empty.
    if (command.format == "bop-csv" && &file == &scans.front().file) std::cout << bop_csv_header();
    print(command, file, result, names, scan.read_milliseconds);
    any_found = any_found || !result.detections.empty();
    all_complete = all_complete && result.complete;
    progress.advance();
  }
  if (!all_complete) return kExitDeadline;
  return any_found ? kExitDone : kExitNothingFound;
}

int run_localize(const LocalizeCommand& command) {
  check(command.options);
  const Database database = load_database(command.database);
  const CompiledModel& model = find_model(database, command.object, command.database);
  const Pose start = read_pose_file(command.pose_file);
  const ReadyScan scan = read_ready_scan(command.scan, read_options(command.source));
  const Clock::time_point begin = Clock::now();
  const RefinedPose refined = refine_and_verify(scan.image, scan.camera, model, start, command.options);
  RecognitionResult result;
  result.milliseconds.localize = result.milliseconds.total = milliseconds_since(begin);
  result.statistics.verifications = 1;
  result.statistics.energy_evaluations = refined.localization.energy_evaluations;
  result.detections.push_back(to_detection(model, refined));
  result.detections.back().covariance =
      covariance_at(model, refined.localization.T_sensor_model, scan.image, scan.camera, database.content().sensor);
  std::cout << result_json(command.scan, result, scan.read_milliseconds) << "\n";
  return refined.verification.accepted ? kExitDone : kExitNothingFound;
}

int run_segment(const SegmentCommand& command) {
  const ReadyScan scan = read_ready_scan(command.scan, read_options(command.source));
  const SegmentationOptions options =
      command.database.empty() ? default_segmentation(scan) : load_database(command.database).content().segmentation;
  const PoolVector<Region> regions = segment(scan.image, options);
  const PoolVector<int> labels = label_image(regions, scan.image.size());
  if (command.color) {
    write_rgb_png(command.output, scan.image.rows, scan.image.columns, color_labels(labels));
  } else {
    write_label_png(command.output, scan.image.rows, scan.image.columns, labels);
  }
  std::cout << command.scan << ": " << regions.size() << " regions\n";
  return regions.empty() ? kExitNothingFound : kExitDone;
}

int run_selftest(const SelftestCommand& command) {
  const Database database = load_database(command.database);
  const CompiledDatabase& content = database.content();
  const bool as_text = command.format == "text";
  std::vector<ObjectSelftest> results;
  for (const CompiledModel& model : database.models()) {
    results.push_back(selftest_object(model, content));
    if (as_text) std::cout << selftest_line(results.back()) << std::flush;  // it takes a while with many objects
  }
  const SelftestCounts counts = count_verdicts(results);
  if (as_text) {
    std::cout << selftest_summary(counts, content.tool_version);
  } else {
    std::cout << selftest_json(command.database, content.tool_version, results) << "\n";
  }
  return counts.all_right() ? kExitDone : kExitNothingFound;
}

}  // namespace foresight
