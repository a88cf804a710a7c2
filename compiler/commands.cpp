#include "compiler/commands.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <set>
#include <thread>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/program.h"
#include "common/scan_file.h"
#include "compiler/database_writer.h"
#include "compiler/digest.h"
#include "compiler/report.h"
#include "compiler/scene_generator.h"
#include "compiler/sensor_file.h"
#include "runtime/database.h"

namespace foresight {
namespace {

double unit_in_mm(const std::string& unit) {
  if (unit == "cm") return 10.0;
  if (unit == "m") return 1000.0;
  if (unit == "in") return 25.4;
  return 1.0;
}

SensorModel sensor_of(const std::string& file) { return file.empty() ? paper_sensor() : read_sensor_file(file); }

tbb::global_control limit_threads(int jobs) {
  const auto threads = jobs > 0 ? static_cast<std::size_t>(jobs) : std::max<std::size_t>(1, std::thread::hardware_concurrency());
  return {tbb::global_control::max_allowed_parallelism, threads};
}

// Reads a CAD file, tells the user what was repaired, and refuses sizes that the sensor cannot see.
CadModel read_checked(const std::string& file, const std::string& unit, const SensorModel& sensor) {
  CadReadOptions options;
  options.unit_mm = unit_in_mm(unit);
  CadModel model = read_cad_model(file, options);
  for (const std::string& repair : model.repairs) std::cerr << "foresightc: " << file << ": repaired: " << repair << "\n";
  check_size(model, file, options.unit_mm, sensor.field_of_view());
  return model;
}

// What the runtime takes for a name, see runtime/database_check.cpp.
void check_name(const std::string& name) {
  const bool plain = std::none_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
  if (plain && !name.empty() && name.size() <= 1000) return;
  throw UsageError("--name", "an object's name is empty, longer than 1000 bytes or has control characters", "name the object in plain text");
}

std::vector<CadModel> read_all(const std::vector<std::string>& files, const std::vector<std::string>& names,
                               const std::string& unit, const SensorModel& sensor) {
  if (!names.empty() && names.size() != files.size()) {
    throw UsageError("--name", std::to_string(names.size()) + " names for " + std::to_string(files.size()) + " CAD files", "give one name a file");
  }
  std::vector<CadModel> models;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < files.size(); ++i) {
    models.push_back(read_checked(files[i], unit, sensor));
    if (!names.empty()) models.back().name = names[i];
    check_name(models.back().name);
    if (!seen.insert(models.back().name).second) {
      throw UsageError(files[i], "two objects are named " + models.back().name, "tell them apart with --name");
    }
  }
  return models;
}

// As Make and Ninja read names, and as gcc -MD writes them: backslashes mean themselves but before a blank.
std::string make_escaped(const std::string& path) {
  std::string escaped;
  for (const char c : path) {
    if (c == ' ' || c == '\t') {
      const std::size_t last = escaped.find_last_not_of('\\') + 1;
      escaped.append(escaped.size() - last, '\\');
    }
    if (c == ' ' || c == '\t' || c == '#' || c == ':') escaped += '\\';
    if (c == '$') escaped += '$';
    escaped += c;
  }
  return escaped;
}

void write_depfile(const CompileCommand& command) {
  std::string text = make_escaped(command.depfile_target.empty() ? command.output : command.depfile_target) + ":";
  for (const std::string& file : command.cad_files) text += " " + make_escaped(file);
  if (!command.sensor_file.empty()) text += " " + make_escaped(command.sensor_file);
  write_file_atomically(command.depfile, text + "\n");
}

// "3" or "3-6".
SceneOptions scene_options(const SimulateCommand& command, std::size_t models) {
  SceneOptions options;
  const char* begin = command.objects.data();
  const char* end = begin + command.objects.size();
  auto parsed = std::from_chars(begin, end, options.fewest_objects);
  options.most_objects = options.fewest_objects;
  if (parsed.ec == std::errc() && parsed.ptr != end && *parsed.ptr == '-') {
    parsed = std::from_chars(parsed.ptr + 1, end, options.most_objects);
  }
  if (parsed.ec != std::errc() || parsed.ptr != end) {
    throw UsageError("--objects", "\"" + command.objects + "\" is not a number or a range", "give for instance 1 or 3-6");
  }
  options.background = command.background;
  check(options, models);
  return options;
}

std::string scan_name(int index, const std::string& format) {
  std::string digits = std::to_string(index);
  digits.insert(0, digits.size() < 4 ? 4 - digits.size() : 0, '0');
  return "scan_" + digits + "." + format;
}

double png_depth_scale(const SensorModel& sensor) {
  // Depths of up to twice the working range in 16 bits, on the sensor's own grid where that is fine enough.
  const double finest = 2.0 * sensor.farthest_distance / 65535.0;
  const double step = sensor.depth_quantization;
  return step >= finest ? step : std::max(finest, step);
}

}  // namespace

int run_compile(const CompileCommand& command) {
  check(command.options.density);
  const auto threads = limit_threads(command.jobs);
  const SensorModel sensor = sensor_of(command.sensor_file);
  CompileOptions options = command.options;
  options.surface.neighbour_radius = 2.0 * options.surface.spacing;
  const std::vector<CadModel> cads = read_all(command.cad_files, command.names, command.unit, sensor);

  CompiledDatabase database = new_database(sensor, options);
  database.models.resize(cads.size());
  Progress progress(command.progress, "compile", static_cast<int>(cads.size()) * options.samples.views);
  tbb::parallel_for(std::size_t{0}, cads.size(), [&](std::size_t i) {
    CompiledModel& model = database.models[i];
    model = compile_model(cads[i], sensor, options, [&](int) { progress.advance(); });
    model.cad_file = std::filesystem::path(command.cad_files[i]).filename().string();
    model.cad_sha256 = sha256_hex(read_whole_file(command.cad_files[i]));
    model.cad_unit = command.unit;
  });
  for (std::size_t i = 0; i < cads.size(); ++i) {
    const auto& faces = database.models[i].faces;
    if (std::all_of(faces.begin(), faces.end(), [](const ModelFace& face) { return face.views_found == 0; })) {
      throw InputError(command.cad_files[i], "no face of it is found in any simulated view by this sensor",
                       "check the unit, or describe a sensor that resolves the object's faces; curved surfaces have none to find");
    }
    const auto found = std::count_if(faces.begin(), faces.end(), [](const ModelFace& face) { return face.views_found > 0; });
    if (static_cast<std::size_t>(found) < options.most_faces) continue;
    std::cerr << "foresightc: " << command.cad_files[i] << ": warning: statistics are kept of the " << found
              << " faces found in most views only; a curved surface cut into facets is not recognized by them\n";
  }
  for (std::size_t i = 0; i < cads.size(); ++i) {
    if (database.models[i].golden_scan) continue;
    std::cerr << "foresightc: " << command.cad_files[i]
              << ": warning: not recognized in any simulated view of it alone; without a golden scan, foresight selftest cannot test it\n";
  }
  const std::string bytes = encode_database(database);
  if (!command.depfile.empty()) write_depfile(command);  // first, so that no database stands without it
  write_file_atomically(command.output, bytes);
  return kExitDone;
}

int run_link(const LinkCommand& command) {
  std::vector<NamedDatabase> parts;
  for (const std::string& file : command.databases) parts.push_back({file, decode_database(read_whole_file(file), file)});
  write_file_atomically(command.output, encode_database(link_databases(std::move(parts))));
  return kExitDone;
}

int run_inspect(const InspectCommand& command) {
  const std::string bytes = read_whole_file(command.database);
  const CompiledDatabase database = decode_database(bytes, command.database);
  std::cout << (command.json ? report_json(database, bytes.size()) : report_text(database, bytes.size()));
  return kExitDone;
}

int run_simulate(const SimulateCommand& command) {
  const auto threads = limit_threads(command.jobs);
  SensorModel sensor = sensor_of(command.sensor_file);
  if (command.noise) sensor.depth_noise = *command.noise;
  const std::vector<CadModel> models = read_all(command.cad_files, {}, command.unit, sensor);
  const SceneOptions options = scene_options(command, models.size());
  std::error_code failed;
  std::filesystem::create_directories(command.output, failed);
  if (failed) throw InputError(command.output, "the folder cannot be made: " + failed.message(), "give another folder");

  std::vector<Scene> scenes(static_cast<std::size_t>(command.scenes));
  std::vector<std::string> names;
  for (int i = 0; i < command.scenes; ++i) names.push_back(scan_name(i, command.format));
  Progress progress(command.progress, "simulate", command.scenes);
  tbb::parallel_for(0, command.scenes, [&](int i) {
    Scene& scene = scenes[static_cast<std::size_t>(i)];
    scene = generate_scene(models, sensor, options, command.seed, static_cast<std::uint64_t>(i));
    const std::string file = command.output + "/" + names[static_cast<std::size_t>(i)];
    if (command.format == "png") {
      write_depth_png(file, scene.scan.image, png_depth_scale(sensor));
    } else {
      write_pcd(file, scene.scan.image);
    }
    scene.scan = {};  // the truth does not need it, and a thousand of them would fill the memory
    progress.advance();
  });
  if (command.format == "png") write_camera_json(command.output + "/camera.json", sensor.camera, png_depth_scale(sensor));
  write_file_atomically(command.output + "/truth.json", truth_json(scenes, models, names, sensor, command.seed));
  return kExitDone;
}

}  // namespace foresight
