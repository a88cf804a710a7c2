// experiments: the paper's experiments and this project's own, as subcommands that write CSV.
#include "benchmarks/commands.h"
#include "common/program.h"

int main(int argc, char** argv) {
  CLI::App app("Runs the experiments of the paper and of this project; results as CSV.", "experiments");
  app.require_subcommand(1);
  const std::vector<foresight::Experiment> experiments = {foresight::add_synthetic(app),       //
                                                          foresight::add_scanner(app),         //
                                                          foresight::add_clutter(app),         //
                                                          foresight::add_covariance(app),      //
                                                          foresight::add_localization(app),    //
                                                          foresight::add_single_surface(app),  //
                                                          foresight::add_twins(app),           //
                                                          foresight::add_unknown(app),         //
                                                          foresight::add_real(app),            //
                                                          foresight::add_boxes(app),           //
                                                          foresight::add_search(app),          //
                                                          foresight::add_segmentation(app),    //
                                                          foresight::add_constraints(app),     //
                                                          foresight::add_potentials(app),      //
                                                          foresight::add_scale(app),           //
                                                          foresight::add_deadlines(app),       //
                                                          foresight::add_sensor_effect(app),   //
                                                          foresight::add_compile_cost(app)};
  return foresight::run_program("experiments", app, argc, argv, [&] {
    for (const foresight::Experiment& experiment : experiments) {
      if (experiment.command->parsed()) return experiment.run();
    }
    return 0;
  });
}
