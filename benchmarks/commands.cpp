#include "benchmarks/commands.h"

#include "common/program.h"

namespace foresight {

void add_common_options(CLI::App& command, ExperimentOptions& options, int n) {
  if (n > 0) {
    options.n = n;
    command.add_option("--n", options.n, "Scenes")->check(CLI::Range(1, 1000000))->capture_default_str();
  }
  command.add_option("--seed", options.seed, "Seed of the scenes")->capture_default_str();
  command.add_option("--jobs", options.jobs, "Threads; times mean something with 1 only")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command.add_option("-o,--output", options.output, "Folder to write results into, made when missing")
      ->capture_default_str();
  add_progress_option(command, options.progress);
}

void add_object_options(CLI::App& command, ExperimentOptions& options) {
  command.add_option("--cad", options.cad_files, "CAD files, one object each; the eight of models/ when not given");
  command.add_option("--unit", options.unit, "Unit of the CAD files")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}))
      ->capture_default_str();
  command.add_option("--sensor", options.sensor_file, "Sensor file of the scans; the experiment's own when not given");
  command.add_option("--compile-sensor", options.compile_sensor_file,
                     "Sensor file of the database; that of the scans when not given");
  command.add_option("--database", options.database_file,
                     "Database of these CAD files; compiled in this process when not given");
}

void add_series_options(CLI::App& command, ExperimentOptions& options, std::vector<int>& models) {
  command.add_option("--cad", options.cad_files, "CAD files, one object each; the eight of models/ when not given");
  command.add_option("--unit", options.unit, "Unit of the CAD files")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}))
      ->capture_default_str();
  command.add_option("--sensor", options.sensor_file, "Sensor file; the paper's sensor when not given");
  command.add_option("--models", models, "Models in the database: the objects, then random solids; 1: the object alone")
      ->delimiter(',')
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
}

void add_method_options(CLI::App& command, ExperimentOptions& options) {
  RecognizeOptions& method = options.method;
  std::string known;
  for (const std::string& name : method_names()) known.append(known.empty() ? "" : ", ").append(name);
  command.add_option("--methods", options.methods, "Whose rows the tables show, separated by commas: " + known)
      ->delimiter(',')
      ->check(CLI::IsMember(method_names()).description(""))
      ->capture_default_str();
  static const std::map<std::string, PriorSign> signs = {{"minus-log", PriorSign::minus_log},
                                                         {"as-printed", PriorSign::plus_log_as_printed}};
  static const std::map<std::string, Pruning> prunings = {{"hcf", Pruning::highest_confidence_first},
                                                          {"none", Pruning::none}};
  static const std::map<std::string, Loss> losses = {
      {"lorentzian", Loss::lorentzian}, {"tukey", Loss::tukey}, {"huber", Loss::huber}, {"gaussian", Loss::gaussian}};
  command.add_option("--pruning", method.pruning, "hcf (highest confidence first; two-way: by rating) or none")
      ->transform(CLI::CheckedTransformer(prunings, CLI::ignore_case).description(""));
  command.add_option("--prior-sign", method.potentials.prior_sign, "1-clique potential: minus-log, or as-printed in the paper")
      ->transform(CLI::CheckedTransformer(signs, CLI::ignore_case).description(""));
  command.add_option("--loss", method.loss, "Error distribution of localization: lorentzian, tukey, huber, gaussian")
      ->transform(CLI::CheckedTransformer(losses, CLI::ignore_case).description(""));
  command
      .add_option("--max-verifications", method.most_verifications,
                  "Stop after this many verifications a scan, 0 = no limit")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

}  // namespace foresight
