// Extraction alone on real scans with hand-labelled planes (SegComp ABW), by the measures of Hoover et al., "An
// Experimental Comparison of Range Image Segmentation Algorithms", IEEE PAMI 18(7), 1996.
#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <iostream>
#include <map>
#include <memory>

#include "benchmarks/commands.h"
#include "benchmarks/hoover.h"
#include "benchmarks/intervals.h"
#include "benchmarks/overlay.h"
#include "benchmarks/plot.h"
#include "benchmarks/real_scans.h"
#include "common/errors.h"
#include "common/region_attributes.h"
#ifdef FORESIGHT_RIVALS
#include "benchmarks/rivals/pcl_planes.h"
#endif

namespace foresight {
namespace {

constexpr std::array<double, 8> kTolerances = {0.51, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95};
constexpr std::size_t kShownTolerance = 4;   // of the rows per scan and the pictures: 0.8, which the paper's tables use
constexpr int kFirstHandLabelledPlane = 10;  // lower hand labels are no data, noise and edges

using LabelImage = std::vector<int>;  // by cell, 0 = no region

struct Segmenter {
  std::string name;
  std::function<LabelImage(const RangeImage&)> labels;
};

// What is compared. Our own is all that `foresight segment` and recognition do: regions and their attributes.
std::vector<Segmenter> segmenters_for(const SensorModel& sensor, const PinholeCamera& camera) {
  std::vector<Segmenter> segmenters;
  segmenters.push_back({"foresight", [camera, options = segmentation_options_for(sensor)](const RangeImage& image) {
                          PoolVector<Region> regions;
                          for (DescribedRegion& described : extract_regions(image, camera, options))
                            regions.push_back(std::move(described.region));
                          const PoolVector<int> labels = label_image(regions, image.size());
                          return LabelImage(labels.begin(), labels.end());
                        }});
#ifdef FORESIGHT_RIVALS
  segmenters.push_back({"pcl", [](const RangeImage& image) { return pcl_planes(image); }});
#endif
  return segmenters;
}

// One scan, one segmenter.
struct SegmentedScan {
  std::string method;
  std::string scan;
  std::array<HooverCounts, kTolerances.size()> counts;
  double milliseconds = 0.0;
};

LabelImage read_hand_labels(const std::string& file, const RangeImage& image) {
  int rows = 0, columns = 0;
  LabelImage labels = read_grey_png(file, rows, columns);
  if (rows != image.rows || columns != image.columns)
    throw InputError(file, "it has another size than its scan", "give the labels that belong to the scan");
  for (int& label : labels) label = label < kFirstHandLabelledPlane ? 0 : label;
  return labels;
}

Colour colour_of(HooverKind kind) {
  switch (kind) {
    case HooverKind::correct:
      return {0, 158, 115};  // green
    case HooverKind::over_segmented:
      return {230, 159, 0};  // orange
    case HooverKind::under_segmented:
      return {0, 114, 178};  // blue
    default:
      return {213, 0, 50};  // red: missed, noise
  }
}

// Paints the regions of a label image over the shaded scan, `column` columns from the left: the kind's colour, dark
// where two regions meet.
void paint_regions(const Picture& shaded, const LabelImage& labels, const std::map<int, HooverKind>& kinds, int column,
                   Picture& picture) {
  const auto label_at = [&](int r, int c) { return labels[static_cast<std::size_t>(r * shaded.columns + c)]; };
  for (int r = 0; r < shaded.rows; ++r) {
    for (int c = 0; c < shaded.columns; ++c) {
      const auto from = 3 * static_cast<std::size_t>(r * shaded.columns + c);
      Colour colour = {shaded.rgb[from], shaded.rgb[from + 1], shaded.rgb[from + 2]};
      const int label = label_at(r, c);
      const bool border = (r > 0 && label_at(r - 1, c) != label) || (c > 0 && label_at(r, c - 1) != label);
      if (border && label > 0) {
        colour = {0, 0, 0};
      } else if (label > 0) {
        const Colour over = colour_of(kinds.at(label));
        for (std::size_t k = 0; k < 3; ++k) colour[k] = static_cast<unsigned char>((colour[k] + over[k]) / 2);
      }
      picture.paint(r, column + c, colour);
    }
  }
}

// Left the hand labels, right the found regions.
Picture draw_regions(const RangeImage& image, const LabelImage& truth, const LabelImage& found,
                     const std::vector<HooverInstance>& instances) {
  std::map<int, HooverKind> of_truth, of_found;
  for (const HooverInstance& instance : instances) {
    for (const int label : instance.truth) of_truth[label] = instance.kind;
    for (const int label : instance.found) of_found[label] = instance.kind;
  }
  const Picture shaded = shade(image);
  Picture picture{image.rows, 2 * image.columns, {}};
  picture.rgb.resize(2 * shaded.rgb.size());
  paint_regions(shaded, truth, of_truth, 0, picture);
  paint_regions(shaded, found, of_found, image.columns, picture);
  return picture;
}

SegmentedScan segment_and_score(const Segmenter& segmenter, const Scan& scan, const std::string& name,
                                const LabelImage& truth, const std::string& output) {
  SegmentedScan result{segmenter.name, name, {}, 0.0};
  const auto before = std::chrono::steady_clock::now();
  const LabelImage found = segmenter.labels(scan.image);
  result.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before).count();
  for (std::size_t t = 0; t < kTolerances.size(); ++t)
    result.counts[t] = count_instances(classify_regions(truth, found, kTolerances[t]));
  write_picture(output + "/segmentation_" + segmenter.name + "_" + name + ".png",
                draw_regions(scan.image, truth, found, classify_regions(truth, found, kTolerances[kShownTolerance])));
  return result;
}

// The measures in the order of all tables.
constexpr std::array<const char*, 5> kMeasures = {"correct", "over-segmented", "under-segmented", "missed", "noise"};
std::array<long, 5> measures_of(const HooverCounts& counts) {
  return {counts.correct, counts.over_segmented, counts.under_segmented, counts.missed, counts.noise};
}

// One method at one tolerance, over all scans.
struct SegmentationSummary {
  std::string method;
  double tolerance = 0.0;
  long scans = 0;
  HooverCounts sum;
  double milliseconds = 0.0;  // mean

  [[nodiscard]] double mean(long count) const { return static_cast<double>(count) / static_cast<double>(scans); }
};

SegmentationSummary summarize(const std::vector<SegmentedScan>& results, const std::string& method, std::size_t t) {
  SegmentationSummary summary{method, kTolerances[t], 0, {}, 0.0};
  for (const SegmentedScan& result : results) {
    if (result.method != method) continue;
    const HooverCounts& counts = result.counts[t];
    ++summary.scans;
    summary.sum.truth += counts.truth;
    summary.sum.found += counts.found;
    summary.sum.correct += counts.correct;
    summary.sum.over_segmented += counts.over_segmented;
    summary.sum.under_segmented += counts.under_segmented;
    summary.sum.missed += counts.missed;
    summary.sum.noise += counts.noise;
    summary.milliseconds += result.milliseconds;
  }
  summary.milliseconds /= static_cast<double>(summary.scans);
  return summary;
}

Table summary_table(const std::vector<SegmentationSummary>& summaries) {
  Table table;
  table.header = {"method", "tolerance", "scans", "true regions", "found regions"};
  table.header.insert(table.header.end(), kMeasures.begin(), kMeasures.end());
  table.header.insert(table.header.end(), {"correct %", "correct low", "correct high", "ms"});
  for (const SegmentationSummary& s : summaries) {
    std::vector<std::string> row = {s.method, decimal(s.tolerance, 2), std::to_string(s.scans),
                                    decimal(s.mean(s.sum.truth), 2), decimal(s.mean(s.sum.found), 2)};
    for (const long count : measures_of(s.sum)) row.push_back(decimal(s.mean(count), 2));
    const Interval interval = wilson_interval(s.sum.correct, s.sum.truth);
    const double share = static_cast<double>(s.sum.correct) / static_cast<double>(s.sum.truth);
    for (const double value : {share, interval.low, interval.high}) row.push_back(decimal(100.0 * value, 1));
    row.push_back(decimal(s.milliseconds, 1));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table scan_table(const std::vector<SegmentedScan>& results) {
  Table table;
  table.header = {"method", "scan", "tolerance", "true regions", "found regions"};
  table.header.insert(table.header.end(), kMeasures.begin(), kMeasures.end());
  table.header.emplace_back("ms");
  for (const SegmentedScan& result : results) {
    const HooverCounts& counts = result.counts[kShownTolerance];
    std::vector<std::string> row = {result.method, result.scan, decimal(kTolerances[kShownTolerance], 2),
                                    std::to_string(counts.truth), std::to_string(counts.found)};
    for (const long count : measures_of(counts)) row.push_back(std::to_string(count));
    row.push_back(decimal(result.milliseconds, 1));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<Plot> measure_plots(const std::vector<SegmentationSummary>& summaries) {
  std::vector<Plot> plots;
  for (std::size_t m = 0; m < kMeasures.size(); ++m) {
    Plot& plot = plots.emplace_back();
    plot.title = kMeasures[m];
    plot.x_label = "tolerance";
    plot.y_label = "regions a scan (mean)";
    for (const SegmentationSummary& s : summaries) {
      if (plot.curves.empty() || plot.curves.back().label != s.method) {
        plot.curves.emplace_back().label = s.method;
        plot.curves.back().style = Curve::Style::line_and_points;
      }
      plot.curves.back().x.push_back(s.tolerance);
      plot.curves.back().y.push_back(s.mean(measures_of(s.sum)[m]));
    }
  }
  return plots;
}

void run_segmentation(const ExperimentOptions& options, const std::string& abw) {
  const SensorModel sensor =
      sensor_of(options.sensor_file.empty() ? project_path("models/sensors/abw.textproto") : options.sensor_file);
  const std::vector<ScanTruth> scans = read_truth_file(abw + "/truth.json");
  const std::vector<Segmenter> methods = segmenters_for(sensor, sensor.camera);
  make_folder(options.output);

  std::vector<SegmentedScan> results(scans.size() * methods.size());
  run_in_parallel(options, "segmentation", static_cast<int>(scans.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const Scan scan = read_abw_scan(abw, scans[index]);
    const std::vector<Segmenter> segmenters = segmenters_for(sensor, *scan.camera);
    const LabelImage truth = read_hand_labels(abw + "/labels/" + scans[index].scan + ".png", scan.image);
    for (std::size_t m = 0; m < segmenters.size(); ++m)
      results[m * scans.size() + index] =
          segment_and_score(segmenters[m], scan, scans[index].scan, truth, options.output);
  });

  std::vector<SegmentationSummary> summaries;
  for (const Segmenter& method : methods) {
    for (std::size_t t = 0; t < kTolerances.size(); ++t) summaries.push_back(summarize(results, method.name, t));
  }
  const Table table = summary_table(summaries);
  write_csv(options, "segmentation", table);
  write_csv(options, "segmentation_scans", scan_table(results));
  write_plots(options.output + "/segmentation.svg", measure_plots(summaries), 3);
  std::cout << "segmentation, means a scan\n" << to_text(table);
  if (options.jobs > 1)
    std::cout << "ms: of " << options.jobs << " scans at once; use --jobs 1 for times that mean something\n";
}

}  // namespace

Experiment add_segmentation(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  const auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("segmentation",
                                         "Extracted regions of real scans against hand-labelled planes, by Hoover's "
                                         "measures, with a picture of each (skipped without the data)");
  add_common_options(*command, *options, 0);
  add_data_option(*command, *folder);
  command->add_option("--sensor", options->sensor_file,
                      "Sensor file that extraction follows; models/sensors/abw.textproto when not given");
  return {command, [options, folder] {
            if (has_abw_scans(*folder, "segmentation")) run_segmentation(*options, *folder + "/abw");
            return static_cast<int>(kExitDone);
          }};
}

}  // namespace foresight
