// What compiling costs: processor time against that of casting the rays of the sample views alone, stage by stage, and
// time and memory of solids cut into ever more triangles.
#include <sys/resource.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <cmath>
#include <ctime>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/fine_solids.h"
#include "benchmarks/table.h"
#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/viewing_sphere.h"
#include "compiler/compile.h"
#include "compiler/database_writer.h"
#include "compiler/sensor_simulator.h"

namespace foresight {
namespace {

struct CostOptions {
  ExperimentOptions common;
  std::vector<int> triangles = {1000, 10000, 100000};
  bool million = false;
};

// Of all threads of this process, user and system. Unit: s.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Each ray of each sample view, its first hit and nothing else; scenes are built as the compiler builds them. How many.
long cast_rays_alone(const CadModel& cad, const SensorModel& sensor, const FaceSampleOptions& options) {
  const ViewingSphere sphere(options.views);
  std::vector<long> rays(static_cast<std::size_t>(sphere.size()), 0);
  tbb::parallel_for(0, sphere.size(), [&](int view) {
    Random random(options.seed, static_cast<std::uint64_t>(view));
    const PlacedObject object{&cad, sampled_pose(cad, sphere.centre(view), sensor, random)};
    const SimulatedScene scene(std::span(&object, 1));
    double sum = 0.0;  // asked for, so that no ray is left out
    for (int row = 0; row < sensor.camera.rows; ++row) {
      for (int column = 0; column < sensor.camera.columns; ++column)
        sum += scene.cast(Eigen::Vector3d::Zero(), sensor.camera.ray(row, column)).distance;
    }
    if (std::isfinite(sum)) rays[static_cast<std::size_t>(view)] = sensor.camera.rows * sensor.camera.columns;
  });
  long all = 0;
  for (const long count : rays) all += count;
  return all;
}

struct ObjectCost {
  std::string name;
  long rays = 0;
  double rays_seconds = 0.0;
  std::map<std::string, double> stages;
  double compile_seconds = 0.0;
};

const std::vector<std::string>& stages() {
  static const std::vector<std::string> names = {"views",      "statistics", "template",
                                                 "symmetries", "acceptance", "golden scan"};
  return names;
}

ObjectCost cost_of(const CadModel& cad, const SensorModel& sensor) {
  const CompileOptions options;
  ObjectCost cost;
  cost.name = cad.name;
  const double begin = processor_seconds();
  cost.rays = cast_rays_alone(cad, sensor, options.samples);
  const double begin_compile = processor_seconds();
  cost.rays_seconds = begin_compile - begin;
  double last = begin_compile;
  const CompiledModel model = compile_model(cad, sensor, options, {}, [&](const char* stage) {
    const double now = processor_seconds();
    cost.stages[stage] = now - last;
    last = now;
  });
  CompiledDatabase database = new_database(sensor, options);
  database.models.push_back(model);
  (void)encode_database(database);
  cost.compile_seconds = processor_seconds() - begin_compile;
  return cost;
}

ObjectCost sum_of(const std::vector<ObjectCost>& costs) {
  ObjectCost sum;
  sum.name = "all";
  for (const ObjectCost& cost : costs) {
    sum.rays += cost.rays;
    sum.rays_seconds += cost.rays_seconds;
    sum.compile_seconds += cost.compile_seconds;
    for (const auto& [stage, seconds] : cost.stages) sum.stages[stage] += seconds;
  }
  return sum;
}

Table object_table(std::vector<ObjectCost> costs) {
  costs.push_back(sum_of(costs));
  Table table;
  table.header = {"object", "rays", "rays alone s", "compile s", "ratio"};
  for (const std::string& stage : stages()) table.header.push_back(stage + " s");
  for (const ObjectCost& cost : costs) {
    std::vector<std::string> row = {cost.name, std::to_string(cost.rays), decimal(cost.rays_seconds, 3),
                                    decimal(cost.compile_seconds, 3),
                                    decimal(cost.compile_seconds / cost.rays_seconds, 1)};
    for (const std::string& stage : stages()) {
      const auto found = cost.stages.find(stage);
      row.push_back(decimal(found == cost.stages.end() ? 0.0 : found->second, 3));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

// What a process of its own used, and whether it ended well.
struct ProcessCost {
  bool done = false;
  double seconds = 0.0;  // user and system
  double peak = 0.0;     // of resident memory. Unit: MiB.
};

// REQUIRES: this process has no other thread yet; only the one that forks goes on in the child.
ProcessCost run_apart(const std::function<void()>& work) {
  std::cout.flush();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no further process can be started");
  if (child == 0) {
    int code = 0;
    try {
      work();
    } catch (const std::exception& fault) {
      std::cerr << "experiments: " << fault.what() << "\n";
      code = 1;
    }
    _exit(code);
  }
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, seconds(used.ru_utime) + seconds(used.ru_stime),
          static_cast<double>(used.ru_maxrss) / 1024.0};
}

void compile_file(const std::string& file, const std::string& database_file, const SensorModel& sensor, int jobs) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(jobs));
  const CompileOptions options;
  const CadModel cad = read_cad_model(file);
  CompiledDatabase database = new_database(sensor, options);
  database.models.push_back(compile_model(cad, sensor, options));
  write_file_atomically(database_file, encode_database(database));
}

Table size_table(const CostOptions& options, const SensorModel& sensor) {
  struct Kind {
    const char* name;
    TriangleMesh (*make)(int);
  };
  Table table;
  table.header = {"solid", "triangles", "processor s", "peak MiB", "database KiB"};
  std::vector<int> sizes = options.triangles;
  if (options.million) sizes.push_back(1000000);
  for (const Kind& kind : {Kind{"box", fine_box}, Kind{"cylinder", fine_cylinder}}) {
    for (const int size : sizes) {
      const std::string stem = options.common.output + "/fine_" + kind.name;
      // The mesh is written by a process of its own, too: a child begins with the memory of its parent.
      run_apart([&] { write_file_atomically(stem + ".off", off_text(kind.make(size))); });
      const ProcessCost cost =
          run_apart([&] { compile_file(stem + ".off", stem + ".fdb", sensor, options.common.jobs); });
      const double kib =
          cost.done ? static_cast<double>(std::filesystem::file_size(stem + ".fdb")) / 1024.0 : std::nan("");
      table.rows.push_back({kind.name, std::to_string(size), decimal(cost.done ? cost.seconds : std::nan(""), 1),
                            decimal(cost.peak, 0), decimal(kib, 0)});
      std::filesystem::remove(stem + ".off");
      std::filesystem::remove(stem + ".fdb");
    }
  }
  return table;
}

void run_compile_cost(const CostOptions& options) {
  const ExperimentOptions& common = options.common;
  const SensorModel sensor = sensor_of(common.sensor_file);
  make_folder(common.output);
  const Table sizes = size_table(options, sensor);  // first: before there are threads
  write_csv(common, "compile_cost_by_size", sizes);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(common.jobs));
  std::vector<ObjectCost> costs;
  for (const CadModel& cad : read_objects(common, sensor)) costs.push_back(cost_of(cad, sensor));
  const Table objects = object_table(std::move(costs));
  write_csv(common, "compile_cost", objects);
  std::cout << "compile-cost, processor time of " << common.jobs << " threads, user and system\n"
            << to_text(objects) << to_text(sizes);
}

}  // namespace

Experiment add_compile_cost(CLI::App& app) {
  const auto options = std::make_shared<CostOptions>();
  CLI::App* command =
      app.add_subcommand("compile-cost", "What compiling costs, against rays alone and by number of triangles");
  add_common_options(*command, options->common, 0);
  command->add_option("--cad", options->common.cad_files,
                      "CAD files, one object each; the eight of models/ when not given");
  command->add_option("--unit", options->common.unit, "Unit of the CAD files")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}))
      ->capture_default_str();
  command->add_option("--sensor", options->common.sensor_file, "Sensor file; the paper's sensor when not given");
  command->add_option("--triangles", options->triangles, "Of a box and a cylinder that are cut into so many")
      ->delimiter(',')
      ->check(CLI::Range(100, 10000000))
      ->capture_default_str();
  command->add_flag("--million", options->million, "A million triangles, too");
  return {command, [options] {
            run_compile_cost(*options);
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
