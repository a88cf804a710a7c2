// foresightc: compiles CAD models into databases of statistics.
#include "common/program.h"
#include "compiler/commands.h"

namespace foresight {
namespace {

void add_unit_option(CLI::App& command, std::string& unit) {
  command.add_option("--unit", unit, "Unit of the CAD files")->check(CLI::IsMember({"mm", "cm", "m", "in"}))->capture_default_str();
}

void add_sensor_option(CLI::App& command, std::string& sensor) {
  command.add_option("--sensor", sensor, "Sensor file (protobuf text); the paper's sensor when not given");
}

CLI::App* add_compile(CLI::App& app, CompileCommand& c) {
  CLI::App* command = app.add_subcommand("compile", "Compile CAD files (OBJ, STL, PLY, OFF) into one database");
  command->add_option("CAD", c.cad_files, "CAD files, one object each")->required();
  command->add_option("-o,--output", c.output, "Database to write")->required();
  add_sensor_option(*command, c.sensor_file);
  add_unit_option(*command, c.unit);
  command->add_option("--name", c.names, "Object names, as many as CAD files; the file stems when not given");
  command->add_option("--jobs", c.jobs, "Threads, 0 = all cores")->check(CLI::Range(0, 4096))->capture_default_str();
  command->add_option("--views", c.options.samples.views, "Sample views: 20, 80, 320, 1280, ...")->capture_default_str();
  command->add_option("--seed", c.options.samples.seed, "Seed of noise, distance and turn of the sample views")->capture_default_str();
  command->add_option("--bins", c.options.density.bins, "Bins of the densities")->check(CLI::Range(2, 1000))->capture_default_str();
  command->add_option("--kernel", c.options.density.kernel, "Kernel of the densities in bins, 0 = raw histograms")->check(number_between(0.0, 10.0))->capture_default_str();
  command->add_option("--spacing", c.options.surface.spacing, "Spacing of the surface template, mm")->check(number_between(0.1, 1000.0))->capture_default_str();
  CLI::Option* depfile = command->add_option("--depfile", c.depfile, "Write a Make dependency file");
  command->add_option("--depfile-target", c.depfile_target, "What the dependency file says is made; the output when not given")->needs(depfile);
  add_progress_option(*command, c.progress);
  return command;
}

CLI::App* add_link(CLI::App& app, LinkCommand& c) {
  CLI::App* command = app.add_subcommand("link", "Join databases compiled apart");
  command->add_option("DB", c.databases, "Databases of one sensor and one set of options")->required();
  command->add_option("-o,--output", c.output, "Database to write")->required();
  return command;
}

CLI::App* add_inspect(CLI::App& app, InspectCommand& c) {
  CLI::App* command = app.add_subcommand("inspect", "Show what is inside a database");
  command->add_option("DB", c.database, "Database")->required();
  command->add_flag("--json", c.json, "As JSON");
  return command;
}

CLI::App* add_simulate(CLI::App& app, SimulateCommand& c) {
  CLI::App* command = app.add_subcommand("simulate", "Make synthetic scans (PCD) with ground truth (truth.json)");
  command->add_option("CAD", c.cad_files, "CAD files, one object each")->required();
  command->add_option("-o,--output", c.output, "Folder to write into, made when missing")->required();
  add_sensor_option(*command, c.sensor_file);
  add_unit_option(*command, c.unit);
  command->add_option("--scenes", c.scenes, "Number of scans")->check(CLI::Range(1, 1000000))->capture_default_str();
  command->add_option("--objects", c.objects, "Objects a scene: a number, or a range such as 3-6")->capture_default_str();
  command->add_flag("--background", c.background, "Objects rest on a table instead of floating before nothing");
  command->add_option("--noise", c.noise, "Standard deviation of the depth, mm; the sensor file's when not given")->check(number_between(0.0, 1000.0));
  command->add_option("--seed", c.seed, "Seed of the scenes")->capture_default_str();
  command->add_option("--format", c.format, "pcd or png (16-bit depth and a camera.json)")->check(CLI::IsMember({"pcd", "png"}))->capture_default_str();
  command->add_option("--jobs", c.jobs, "Threads, 0 = all cores")->check(CLI::Range(0, 4096))->capture_default_str();
  add_progress_option(*command, c.progress);
  return command;
}

int run(int argc, char** argv) {
  CLI::App app("Compiles CAD models into databases of statistics for `foresight`, which recognizes them in range images.", "foresightc");
  app.set_version_flag("--version", "foresightc " FORESIGHT_VERSION);
  app.require_subcommand(1);
  CompileCommand compile;
  LinkCommand link;
  InspectCommand inspect;
  SimulateCommand simulate;
  const CLI::App* compile_app = add_compile(app, compile);
  const CLI::App* link_app = add_link(app, link);
  const CLI::App* inspect_app = add_inspect(app, inspect);
  add_simulate(app, simulate);
  return run_program("foresightc", app, argc, argv, [&] {
    if (compile_app->parsed()) return run_compile(compile);
    if (link_app->parsed()) return run_link(link);
    if (inspect_app->parsed()) return run_inspect(inspect);
    return run_simulate(simulate);
  });
}

}  // namespace
}  // namespace foresight

int main(int argc, char** argv) { return foresight::run(argc, argv); }
