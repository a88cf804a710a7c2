// foresight: recognizes the objects of a compiled database in range images.
#include <limits>

#include "common/program.h"
#include "runtime/commands.h"

namespace foresight {
namespace {

void add_scan_options(CLI::App& command, ScanSource& source) {
  command.add_option("--camera", source.camera_file,
                     "Camera JSON of depth PNGs (BOP camera.json or scene_camera.json)");
  command.add_option("--scan-unit", source.unit, "Unit of PCD and PLY scans")
      ->check(CLI::IsMember({"mm", "m"}))
      ->capture_default_str();
}

void add_method_options(CLI::App& command, RecognizeOptions& options) {
  static const std::map<std::string, Loss> losses = {
      {"lorentzian", Loss::lorentzian}, {"tukey", Loss::tukey}, {"huber", Loss::huber}, {"gaussian", Loss::gaussian}};
  command.add_option("--loss", options.loss, "Error distribution of localization: lorentzian, tukey, huber, gaussian")
      ->transform(CLI::CheckedTransformer(losses, CLI::ignore_case).description(""));
  command
      .add_option("--min-matched", options.smallest_matched,
                  "With --method paper and in localize: accept from this matched fraction (alpha)")
      ->check(number_between(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--min-coherent", options.smallest_coherent,
                  "With --method paper and in localize: accept from this coherent fraction (beta)")
      ->check(number_between(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--max-occluding", options.largest_occluding,
                  "With --method paper and in localize: accept up to this occluding fraction (gamma)")
      ->check(number_between(0.0, 1.0))
      ->capture_default_str();
}

CLI::App* add_recognize(CLI::App& app, RecognizeCommand& c) {
  static const std::map<std::string, PriorSign> signs = {{"minus-log", PriorSign::minus_log},
                                                         {"as-printed", PriorSign::plus_log_as_printed}};
  static const std::map<std::string, Pruning> prunings = {{"hcf", Pruning::highest_confidence_first},
                                                          {"none", Pruning::none}};
  CLI::App* command = app.add_subcommand("recognize", "Recognize the objects of a database in scans");
  command->add_option("DB", c.database, "Database made by foresightc")->required();
  command
      ->add_option("SCAN", c.scans,
                   "Scans: organized PCD, PLY with a grid, 16-bit depth PNG, or BOP scene folders (scene_camera.json, "
                   "depth/*.png)")
      ->required();
  command->add_option("--format", c.format, "text, json (one object a line and scan) or bop-csv")
      ->check(CLI::IsMember({"text", "json", "bop-csv"}))
      ->capture_default_str();
  add_scan_options(*command, c.source);
  command->add_option("--deadline-ms", c.deadline_ms, "Print what was found when this time is over, per scan")
      ->check(CLI::Range(1, std::numeric_limits<int>::max()));
  command->add_option("--top", c.options.most_detections, "Stop after this many detections a scan, 0 = no limit")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()))
      ->capture_default_str();
  command
      ->add_option("--max-verifications", c.options.most_verifications,
                   "Stop after this many verifications a scan, 0 = no limit")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()))
      ->capture_default_str();
  command
      ->add_option("--prior-sign", c.options.potentials.prior_sign,
                   "1-clique potential: minus-log, or as-printed in the paper")
      ->transform(CLI::CheckedTransformer(signs, CLI::ignore_case).description(""));
  command->add_option("--pruning", c.options.pruning, "hcf (highest confidence first; two-way: by rating) or none")
      ->transform(CLI::CheckedTransformer(prunings, CLI::ignore_case).description(""));
  static const std::map<std::string, Method> methods = {{"two-way", Method::two_way}, {"paper", Method::paper}};
  command
      ->add_option("--method", c.options.method,
                   "Judge poses by evidence for and against (two-way, the default), or by alpha, beta, gamma (paper)")
      ->transform(CLI::CheckedTransformer(methods, CLI::ignore_case).description(""));
  add_method_options(*command, c.options);
  add_progress_option(*command, c.progress);
  return command;
}

CLI::App* add_localize(CLI::App& app, LocalizeCommand& c) {
  CLI::App* command = app.add_subcommand("localize", "Refine and verify one given pose");
  command->add_option("DB", c.database, "Database made by foresightc")->required();
  command->add_option("SCAN", c.scan, "Scan")->required();
  command->add_option("--object", c.object, "Name of the object")->required();
  command->add_option("--pose", c.pose_file, "JSON: {\"pose\": 4x4 row-major, mm}")->required();
  add_scan_options(*command, c.source);
  add_method_options(*command, c.options);
  return command;
}

CLI::App* add_segment(CLI::App& app, SegmentCommand& c) {
  CLI::App* command = app.add_subcommand("segment", "Only extract the planar regions");
  command->add_option("SCAN", c.scan, "Scan")->required();
  command->add_option("-o,--output", c.output, "Label image (PNG) to write: 0 = no region")->required();
  command->add_option("--database", c.database, "Use the extraction settings of this database");
  command->add_flag("--color", c.color, "A picture for eyes instead of labels");
  add_scan_options(*command, c.source);
  return command;
}

CLI::App* add_selftest(CLI::App& app, SelftestCommand& c) {
  CLI::App* command = app.add_subcommand(
      "selftest", "Recognize each object of a database in the scan that the compiler recognized it in");
  command->add_option("DB", c.database, "Database made by foresightc")->required();
  command->add_option("--format", c.format, "text or json")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  return command;
}

int run(int argc, char** argv) {
  CLI::App app("Recognizes and localizes known rigid objects in range images.", "foresight");
  app.set_version_flag("--version", std::string("foresight ") + version());
  app.require_subcommand(1);
  RecognizeCommand recognize;
  LocalizeCommand localize;
  SegmentCommand segment;
  SelftestCommand selftest;
  const CLI::App* recognize_app = add_recognize(app, recognize);
  const CLI::App* localize_app = add_localize(app, localize);
  const CLI::App* segment_app = add_segment(app, segment);
  add_selftest(app, selftest);
  return run_program("foresight", app, argc, argv, [&] {
    if (recognize_app->parsed()) return run_recognize(recognize);
    if (localize_app->parsed()) return run_localize(localize);
    if (segment_app->parsed()) return run_segment(segment);
    return run_selftest(selftest);
  });
}

}  // namespace
}  // namespace foresight

int main(int argc, char** argv) { return foresight::run(argc, argv); }
