// Depalletizing: real frames of a depth camera in which cartons mostly show one face, with instance masks and no poses.
// The paper's features need pairs of regions (Section VI.C.1 calls single faces its failure).
#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>

#include "benchmarks/box_scoring.h"
#include "benchmarks/commands.h"
#include "benchmarks/intervals.h"
#include "benchmarks/plot.h"
#include "benchmarks/real_scans.h"
#include "benchmarks/scene_picture.h"
#include "benchmarks/series.h"
#include "common/errors.h"

namespace foresight {
namespace {

constexpr double kLeastVisible = 0.6;  // of a box top: masks with less are not asked for

// One frame by one method.
struct FrameResult {
  const BoxFrame* frame = nullptr;
  SceneRecord record;
  BoxVerdicts verdicts;
};

// A row: one frame of one method, or all of them.
struct BoxRow {
  std::string method, set;
  long frames = 0, masks = 0, found = 0, reported = 0, duplicates = 0, unmasked = 0, invented = 0;
  double regions = 0.0, matches = 0.0, hypotheses = 0.0, verifications = 0.0, milliseconds = 0.0;  // means a frame
};

BoxRow row_of(const std::string& set, const std::vector<FrameResult>& results) {
  BoxRow row{results.front().record.method, set};
  row.frames = static_cast<long>(results.size());
  const auto frames = static_cast<double>(results.size());
  for (const FrameResult& result : results) {
    const auto verdicts = [&](BoxVerdict verdict) {
      return std::count(result.verdicts.reported.begin(), result.verdicts.reported.end(), verdict);
    };
    for (std::size_t m = 0; m < result.frame->masks.size(); ++m) {
      if (result.frame->masks[m].visible < kLeastVisible) continue;
      ++row.masks;
      row.found += result.verdicts.report_of_mask[m] >= 0 ? 1 : 0;
    }
    row.reported += static_cast<long>(result.verdicts.reported.size());
    row.duplicates += verdicts(BoxVerdict::duplicate);
    row.unmasked += verdicts(BoxVerdict::unmasked);
    row.invented += verdicts(BoxVerdict::invented);
    const Statistics& statistics = result.record.statistics;
    row.regions += statistics.regions / frames;
    row.matches += static_cast<double>(statistics.threshold_matches) / frames;
    row.hypotheses += static_cast<double>(statistics.hypotheses) / frames;
    row.verifications += static_cast<double>(statistics.verifications) / frames;
    row.milliseconds += result.record.milliseconds.total / frames;
  }
  return row;
}

double percent_found(const BoxRow& row) {
  return row.masks == 0 ? std::numeric_limits<double>::quiet_NaN()
                        : 100.0 * static_cast<double>(row.found) / static_cast<double>(row.masks);
}

// Times last: they alone differ between runs.
Table table_of(const std::vector<BoxRow>& rows) {
  Table table;
  table.header = {"method",  "set",     "frames",     "masks",         "found",      "found %",
                  "low",     "high",    "reported",   "duplicates",    "on no mask", "invented",
                  "regions", "matches", "hypotheses", "verifications", "ms"};
  for (const BoxRow& row : rows) {
    const Interval interval = wilson_interval(row.found, row.masks);
    table.rows.push_back({row.method, row.set, std::to_string(row.frames), std::to_string(row.masks),
                          std::to_string(row.found), decimal(percent_found(row), 1), decimal(100.0 * interval.low, 1),
                          decimal(100.0 * interval.high, 1), std::to_string(row.reported),
                          std::to_string(row.duplicates), std::to_string(row.unmasked), std::to_string(row.invented),
                          decimal(row.regions, 1), decimal(row.matches, 1), decimal(row.hypotheses, 1),
                          decimal(row.verifications, 1), decimal(row.milliseconds, 1)});
  }
  return table;
}

std::string name_of(BoxVerdict verdict) {
  switch (verdict) {
    case BoxVerdict::found:
      return "found";
    case BoxVerdict::duplicate:
      return "duplicate";
    case BoxVerdict::unmasked:
      return "on no mask";
    default:
      return "invented";
  }
}

// One row a mask and one a report, numbered as they were accepted.
Table detail_table(const std::vector<std::vector<FrameResult>>& results, const SeriesSetup& setup,
                   const std::vector<CompiledModel>& compiled) {
  Table table;
  table.header = {"method", "frame", "kind", "name", "verdict", "visible", "covered", "residual mm", "score"};
  for (const auto& of_method : results) {
    for (const FrameResult& result : of_method) {
      const std::vector<ReportedObject>& reported = result.record.reported;
      for (std::size_t m = 0; m < result.frame->masks.size(); ++m) {
        const BoxMask& mask = result.frame->masks[m];
        const int by = result.verdicts.report_of_mask[m];
        DrawnOnCells drawn{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
        if (by >= 0) {
          drawn = drawn_on(compiled[static_cast<std::size_t>(mask.object)],
                           reported[static_cast<std::size_t>(by)].T_sensor_model, result.frame->image,
                           setup.sensor.camera, mask.cells);
        }
        table.rows.push_back({result.record.method, result.frame->name, "mask", mask.name,
                              by >= 0 ? "found by " + std::to_string(by + 1) : "missed", decimal(mask.visible, 2),
                              decimal(drawn.share, 2), decimal(drawn.residual, 1), "-"});
      }
      for (std::size_t r = 0; r < reported.size(); ++r) {
        table.rows.push_back(
            {result.record.method, result.frame->name, "report",
             setup.models[static_cast<std::size_t>(reported[r].object)].name + " " + std::to_string(r + 1),
             name_of(result.verdicts.reported[r]), "-", "-", "-", decimal(result.record.scores[r], 3)});
      }
    }
  }
  return table;
}

void paint_borders(Picture& picture, const std::vector<BoxMask>& masks, const Colour& colour) {
  for (const BoxMask& mask : masks) {
    const auto inside = [&](int cell) { return std::binary_search(mask.cells.begin(), mask.cells.end(), cell); };
    for (const int cell : mask.cells) {
      const int columns = picture.columns;
      if (inside(cell - 1) && inside(cell + 1) && inside(cell - columns) && inside(cell + columns)) continue;
      picture.paint(cell / columns, cell % columns, colour);
    }
  }
}

// Reports as wireframes; borders of masks white, of those of the other frames yellow.
Picture draw_frame(const FrameResult& result, const std::vector<BoxMask>& elsewhere, const SeriesSetup& setup) {
  Picture picture = draw_scene(result.frame->image, setup.sensor.camera, setup.models, {}, result.record.reported);
  paint_borders(picture, elsewhere, {200, 180, 60});
  paint_borders(picture, result.frame->masks, {255, 255, 255});
  return picture;
}

// Found boxes in percent with their intervals, a curve a method.
Plot plot_of(const std::vector<BoxRow>& rows) {
  Plot plot;
  plot.title = "boxes";
  plot.y_label = "box tops found, %";
  plot.percent_y = true;
  for (const BoxRow& row : rows) {
    if (plot.curves.empty() || plot.curves.back().label != row.method) {
      plot.curves.emplace_back().label = row.method;
      plot.curves.back().style = Curve::Style::points;
    }
    Curve& curve = plot.curves.back();
    if (plot.curves.size() == 1) plot.x_names.push_back(row.set);
    const Interval interval = wilson_interval(row.found, row.masks);
    const double aside = 0.1 * static_cast<double>(plot.curves.size() - 1);
    curve.x.push_back(static_cast<double>(curve.x.size()) + aside);
    curve.y.push_back(percent_found(row));
    curve.low.push_back(100.0 * interval.low);
    curve.high.push_back(100.0 * interval.high);
  }
  return plot;
}

// The masks of the other frames: they show the same pallet, with nothing moved.
std::vector<BoxMask> masks_elsewhere(const std::vector<BoxFrame>& frames, std::size_t here) {
  std::vector<BoxMask> masks;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (f != here) masks.insert(masks.end(), frames[f].masks.begin(), frames[f].masks.end());
  }
  return masks;
}

// The database's models in the order of the CAD files, which reports and masks index.
std::vector<CompiledModel> compiled_in_order(const SeriesSetup& setup) {
  std::vector<CompiledModel> ordered(setup.models.size());
  for (const CompiledModel& compiled : setup.database->models()) {
    const auto same = std::find_if(setup.models.begin(), setup.models.end(),
                                   [&](const CadModel& model) { return model.name == compiled.name; });
    ordered[static_cast<std::size_t>(same - setup.models.begin())] = compiled;
  }
  return ordered;
}

void run_boxes(ExperimentOptions options, const std::string& folder) {
  if (options.cad_files.empty()) options.cad_files = cad_files_in(folder + "/models");
  const SeriesSetup setup = set_up_series(options, project_path("models/sensors/depth_camera.textproto"));
  const std::vector<BoxFrame> frames = read_box_frames(folder, setup.models, setup.sensor.camera);
  const std::vector<CompiledModel> compiled = compiled_in_order(setup);
  make_folder(options.output);

  // Without truth: the records' own verdicts say nothing here.
  const auto records = recognize_series(options, "boxes", setup, static_cast<int>(frames.size()), [&](int i) {
    const BoxFrame& frame = frames[static_cast<std::size_t>(i)];
    return TrueScan{frame.name, frame.image, setup.sensor.camera, {}};
  });
  std::vector<std::vector<FrameResult>> results;
  std::vector<BoxRow> rows;
  for (const auto& of_method : records) {
    std::vector<FrameResult>& scored = results.emplace_back();
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const std::vector<BoxMask> elsewhere = masks_elsewhere(frames, f);
      const BoxScene scene{frames[f].image, setup.sensor.camera, compiled, frames[f].masks, elsewhere};
      scored.push_back({&frames[f], of_method[f], score_boxes(scene, of_method[f].reported)});
      rows.push_back(row_of(frames[f].name, {scored.back()}));
      write_picture(options.output + "/boxes_" + of_method[f].method + "_" + frames[f].name + ".png",
                    draw_frame(scored.back(), elsewhere, setup));
    }
    rows.push_back(row_of("all", scored));
  }
  write_csv(options, "boxes", table_of(rows));
  write_csv(options, "boxes_details", detail_table(results, setup, compiled));
  write_plots(options.output + "/boxes.svg", {plot_of(rows)});
  std::cout << "boxes, tops at least " << decimal(100.0 * kLeastVisible, 0) << " % visible\n"
            << to_text(table_of(rows));
  if (options.jobs > 1)
    std::cout << "ms: of " << options.jobs << " frames at once; use --jobs 1 for times that mean something\n";
}

}  // namespace

Experiment add_boxes(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  const auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "boxes",
      "Real depth-camera frames of cartons with instance masks, with a picture of each (skipped without the data)");
  add_common_options(*command, *options, 0);
  add_data_option(*command, *folder);
  add_object_options(*command, *options);
  add_method_options(*command, *options);
  return {command, [options, folder] {
            if (has_box_frames(*folder, "boxes")) run_boxes(*options, *folder + "/boxes");
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
