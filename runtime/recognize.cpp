#include "runtime/recognize.h"

#include <algorithm>

#include "common/errors.h"
#include "runtime/highest_confidence_first.h"
#include "runtime/hypothesis_cliques.h"
#include "runtime/nearest_data_cell.h"
#include "runtime/nearest_data_point.h"
#include "runtime/pose_evidence.h"
#include "runtime/scan_context.h"
#include "runtime/two_way_search.h"
#include "runtime/verify_in_order.h"

namespace foresight {
namespace {

PoolVector<Label> prune(const HypothesisField& field, Pruning pruning) {
  if (pruning == Pruning::none) return PoolVector<Label>(field.matches.size(), kOn);
  return highest_confidence_first(field);
}

}  // namespace

LocalizationOptions localization_options(const RecognizeOptions& options) {
  LocalizationOptions localization;
  localization.loss = options.loss;
  return localization;
}

VerificationOptions verification_options(const RecognizeOptions& options) {
  VerificationOptions verification;
  verification.smallest_matched = options.smallest_matched;
  verification.smallest_coherent = options.smallest_coherent;
  verification.largest_occluding = options.largest_occluding;
  return verification;
}

void check(const RecognizeOptions& options) {
  const auto fraction = [](double value, const char* name) {
    if (!(value >= 0.0 && value <= 1.0)) throw UsageError(name, "outside its limits", "give a fraction from 0 to 1");
  };
  fraction(options.smallest_matched, "smallest_matched");
  fraction(options.smallest_coherent, "smallest_coherent");
  fraction(options.largest_occluding, "largest_occluding");
  const auto potential = [](double value, const char* name) {
    if (!(value >= -1e4 && value <= 1e4))
      throw UsageError(name, "outside its limits", "give a potential from -10000 to 10000");
  };
  potential(options.potentials.support_on_on, "support_on_on");
  potential(options.potentials.support_off_off, "support_off_off");
  potential(options.potentials.contradiction_on_on, "contradiction_on_on");
  potential(options.potentials.contradiction_on_off, "contradiction_on_off");
  if (options.most_detections < 0) throw UsageError("most_detections", "negative", "give 0 for no limit, or a count");
  if (options.most_verifications < 0)
    throw UsageError("most_verifications", "negative", "give 0 for no limit, or a count");
}

void check_method(const RecognizeOptions& options, const Database& database, const std::string& file) {
  if (options.method == Method::paper) return;
  for (const CompiledModel& model : database.models()) {
    if (model.acceptance.samples > 0 && !model.triangle_faces.empty()) continue;
    throw DatabaseError(DatabaseFault::incompatible, file,
                        "object " + model.name + " lacks what the two-way method needs",
                        "compile it again with this version of foresightc, or use --method paper");
  }
}

namespace {

// Sections III to V.
void recognize_as_published(const ScanContext& scan, const RecognizeOptions& options, const Deadline& deadline,
                            Recognition& result) {
  Stopwatch watch;
  const Database& database = scan.database;
  const BackgroundOptions background = background_for(database.content().density);
  const auto matches = match_likelihoods(scan.regions, database, background);  // eqs. (4), (5)
  const auto field =
      build_hypothesis_field(scan.regions, matches, database, background, options.potentials);  // eqs. (1)-(3)
  const auto labels = prune(field, options.pruning);
  watch.lap(result.milliseconds.field);
  const auto hypotheses = hypothesis_cliques(field, database, labels);  // least energy first
  watch.lap(result.milliseconds.hypotheses);
  result.statistics.threshold_matches = static_cast<long>(matches.size());
  result.statistics.active_matches = static_cast<long>(std::count(labels.begin(), labels.end(), kOn));
  result.statistics.hypotheses = static_cast<long>(hypotheses.size());
  verify_in_order(scan, field, hypotheses, options, deadline, result);  // Section V
}

}  // namespace

void recognize(const RangeImage& image, const PinholeCamera& camera, const Database& database,
               const RecognizeOptions& options, const Deadline& deadline, RecognitionResult& result,
               SpareDetections& spare) {
  Stopwatch total;
  Stopwatch watch;
  Recognition found;
  const auto late = [&deadline] { return deadline && std::chrono::steady_clock::now() >= *deadline; };
  const auto regions = extract_regions(image, camera, database.content().segmentation, late);
  if (regions.empty() && late()) found.complete = false;
  watch.lap(found.milliseconds.extract);
  found.statistics.regions = static_cast<int>(regions.size());
  found.statistics.possible_matches = static_cast<long>(regions.size()) * static_cast<long>(database.faces().size());
  if (!regions.empty()) {
    // The paper searches for data as far as there are any, the two-way method within a short reach.
    if (options.method == Method::paper) {
      const NearestDataPoint data(image);
      watch.lap(found.milliseconds.localize);  // which the k-d tree serves
      recognize_as_published({image, camera, database, regions, data}, options, deadline, found);
    } else {
      const NearestDataCell data(image, camera, judging_options(database.content().sensor).stride);
      watch.lap(found.milliseconds.localize);
      search_two_way({image, camera, database, regions, data}, options, deadline, found);
    }
    double timed = 0.0;  // by the searches
    watch.lap(timed);
  }
  report(found, database, result, spare);
  total.lap(result.milliseconds.total);
}

RecognitionResult recognize(const RangeImage& image, const PinholeCamera& camera, const Database& database,
                            const RecognizeOptions& options, const Deadline& deadline) {
  RecognitionResult result;
  SpareDetections none;
  recognize(image, camera, database, options, deadline, result, none);
  return result;
}

RefinedPose refine_and_verify(const RangeImage& image, const PinholeCamera& camera, const CompiledModel& model,
                              const Pose& T_sensor_model, const RecognizeOptions& options) {
  const NearestDataPoint data(image);
  const ViewingSphere sphere(kAspectCells);
  RefinedPose refined;
  refined.localization = localize(model, sphere, T_sensor_model, data, localization_options(options));
  refined.verification =
      verify(model, sphere, refined.localization.T_sensor_model, image, camera, data, verification_options(options));
  return refined;
}

}  // namespace foresight
