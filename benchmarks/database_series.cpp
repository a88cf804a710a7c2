#include "benchmarks/database_series.h"

#include <cassert>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "benchmarks/random_solids.h"
#include "common/atomic_file.h"
#include "common/errors.h"
#include "compiler/database_writer.h"
#include "compiler/digest.h"

namespace foresight {
namespace {

// Everything a compiled model depends on but the compiler's code.
std::string key_of(const CadModel& cad, const std::string& encoded_settings, const CompileOptions& compile) {
  std::ostringstream text;
  text << std::hexfloat << encoded_settings << cad.name << " " << compile.samples.views << " " << compile.samples.seed
       << " " << compile.surface.spacing << " " << compile.surface.neighbour_radius << " "
       << compile.surface.edge_tolerance << " " << compile.surface.visible_share;
  for (const Eigen::Vector3d& v : cad.vertices) text << " " << v.x() << " " << v.y() << " " << v.z();
  for (const auto& t : cad.triangles) text << " " << t[0] << " " << t[1] << " " << t[2];
  return sha256_hex(text.str()).substr(0, 16);
}

// Written and read back even when just compiled: a database file rounds, and a second run must not differ.
CompiledModel compiled_or_kept(const CadModel& cad, const CompiledDatabase& settings, const CompileOptions& compile,
                               const std::string& file) {
  if (!std::filesystem::exists(file)) {
    CompiledDatabase database = settings;
    database.models.push_back(compile_model(cad, settings.sensor, compile));
    write_file_atomically(file, encode_database(database));
  }
  return load_database(file).models().front();
}

}  // namespace

ModelSeries compile_series(const ExperimentOptions& options, const SensorModel& sensor, int count,
                           const CompileOptions& compile) {
  ModelSeries series;
  series.settings = new_database(sensor, compile);
  series.cads = read_objects(options, sensor);
  series.objects = static_cast<int>(series.cads.size());
  for (int i = series.objects; i < count; ++i) series.cads.push_back(random_solid(options.seed, i - series.objects));

  const std::string folder = options.output + "/databases";
  make_folder(folder);
  const std::string encoded_settings = encode_database(series.settings);
  series.models.resize(series.cads.size());
  run_in_parallel(options, "compile", static_cast<int>(series.cads.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const CadModel& cad = series.cads[index];
    const std::string file = folder + "/" + cad.name + "_" + key_of(cad, encoded_settings, compile) + ".fdb";
    series.models[index] = compiled_or_kept(cad, series.settings, compile, file);
  });
  return series;
}

Database first_models(const ModelSeries& series, int count) {
  assert(count >= 1 && count <= static_cast<int>(series.models.size()));
  CompiledDatabase content = series.settings;
  content.models.assign(series.models.begin(), series.models.begin() + count);
  return Database(std::move(content));
}

void check_database_sizes(const std::vector<int>& sizes, int objects) {
  for (const int size : sizes) {
    if (size == 1 || size >= objects) continue;
    throw UsageError(
        "--models",
        std::to_string(size) + " is neither 1 nor at least the " + std::to_string(objects) + " objects shown",
        "give 1 for the object alone, or all objects and more");
  }
}

Database only_model(const ModelSeries& series, int model) {
  CompiledDatabase content = series.settings;
  content.models = {series.models[static_cast<std::size_t>(model)]};
  return Database(std::move(content));
}

}  // namespace foresight
