#include "runtime/start_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "runtime/pose_from_matches.h"

namespace foresight {
namespace {

constexpr int kRefits = 2;
constexpr int kAtOnce = 16;  // hypotheses between two questions whether to stop
constexpr double kAnyRating = -1e9;
constexpr double kHalfAsWell = 0.5;

// std::stable_sort would ask the heap for memory.
PoolVector<RatedMatch> best_rated(PoolVector<RatedMatch> matches) {
  const auto place = [](const RatedMatch& m) { return std::tuple(-m.rating, m.region, m.model, m.face); };
  std::sort(matches.begin(), matches.end(),
            [&](const RatedMatch& a, const RatedMatch& b) { return place(a) < place(b); });
  return matches;
}

StartSearchOptions unpruned(StartSearchOptions options) {
  options.most_pairs = options.most_singles = std::numeric_limits<int>::max();
  options.least_rating = kAnyRating;
  return options;
}

}  // namespace

StartSearch::StartSearch(const Database& database, const LabelledScan& scan, const StartSearchOptions& options,
                         StartSearchCounts& counts, const Stop& stop)
    : database_(database),
      scan_(scan),
      options_(options.pruned ? options : unpruned(options)),
      counts_(counts),
      regions_(frame_regions(scan.regions)),
      shapes_(database),
      rater_(database, {.least_rating = options.pruned ? RatingOptions{}.least_rating : kAnyRating}),
      matches_(rater_.rate(scan.regions, stop)),
      relations_(scan.regions),
      checker_(database, scan),
      queue_(matches_, regions_.regions, database_, rater_, relations_, options_.least_rating, options_.most_pairs),
      of_model_(database.models().size()) {
  for (const RegionMatches& matches : matches_) singles_.insert(singles_.end(), matches.begin(), matches.end());
  counts_.matches += static_cast<long>(singles_.size());
  singles_ = best_rated(std::move(singles_));
  singles_.resize(std::min(singles_.size(), static_cast<std::size_t>(options_.most_singles)));
}

bool StartSearch::stopped(const Stop& stop) const { return counts_.hypotheses % kAtOnce == 0 && stop && stop(); }

bool StartSearch::look_further(int hypotheses, const Stop& stop) {
  const auto is_free = [this](int region) { return !is_taken(scan_, region); };
  int looked_at = 0;
  for (; pairs_ < options_.most_pairs && looked_at < hypotheses; ++looked_at, ++pairs_) {
    if (stopped(stop)) return true;
    const std::optional<MatchPair> pair = queue_.next(is_free, stop);
    if (!pair && stop && stop()) return true;
    if (!pair) break;
    try_pair(*pair);
  }
  for (; next_single_ < singles_.size(); ++next_single_) {
    const RatedMatch& match = singles_[next_single_];
    if (!is_free(match.region)) continue;
    if (looked_at++ >= hypotheses || stopped(stop)) return true;
    try_single(match);
  }
  return false;
}

void StartSearch::look_for_rivals(int region, int second, const Stop& stop) {
  if (!rivals_.insert({region, second}).second) return;
  if (second >= 0) {
    for (const MatchPair& pair : queue_.pairs_of(region, second, options_.most_rivals)) {
      if (stopped(stop)) return;
      try_pair(pair);
    }
  }
  const RegionMatches singles = best_rated(matches_[static_cast<std::size_t>(region)]);
  const auto most = static_cast<std::size_t>(options_.most_rivals);
  for (std::size_t i = 0; i < std::min(most, singles.size()); ++i) {
    if (stopped(stop)) return;
    try_single(singles[i]);
  }
}

PoseCheck StartSearch::look(int model, const Pose& pose, double least_quality) {
  ++counts_.checks;
  return checker_.check(model, pose, least_quality);
}

// Settling may make a start look better, but one that looks half as well as any that ever came to something does not
// become one.
double StartSearch::least_quality(int index) const { return kHalfAsWell * model(index).acceptance.least_quality; }

// Keeps the pose in `best` where it looks better.
void StartSearch::consider(StartPose& best, PoseCheck& best_check, const Pose& pose, const PoolVector<int>& regions) {
  PoseCheck check = look(best.model, pose, std::max(best.quality, least_quality(best.model)));
  const double quality = check.quality();
  if (quality <= best.quality) return;
  best.quality = quality;
  best.T_sensor_model = pose;
  best.regions = regions;
  best_check = std::move(check);
}

void StartSearch::try_pair(const MatchPair& pair) {
  ++counts_.hypotheses;
  StartPose best;
  best.model = pair.a.model;
  PoseCheck check;
  for (const Pose& pose : pair_starts(database_, shapes_, regions_, pair)) {
    consider(best, check, pose, {pair.a.region, pair.b.region});
  }
  for (const RatedMatch& third : thirds(pair)) {
    const std::array<RegionFaceMatch, 3> matches = {
        {{&region(pair.a), &face(pair.a)}, {&region(pair.b), &face(pair.b)}, {&region(third), &face(third)}}};
    const std::optional<Pose> pose = pose_from_matches(matches);
    if (pose) consider(best, check, *pose, {pair.a.region, pair.b.region, third.region});
  }
  keep(std::move(best), std::move(check));
}

// All that look like something are kept: one surface often fits in several ways, and the answer has to say so.
void StartSearch::try_single(const RatedMatch& match) {
  ++counts_.hypotheses;
  for (const Pose& pose : single_starts(database_, shapes_, regions_, match, rater_.is_cut(region(match)))) {
    StartPose start;
    start.model = match.model;
    PoseCheck check;
    consider(start, check, pose, {match.region});
    keep(std::move(start), std::move(check));
  }
}

// The matches that go best with both, of regions whose plane fixes the point of the pair's line and that see the
// object from the same side: the sign of the triple product of the normals tells an object from its mirror image.
PoolVector<RatedMatch> StartSearch::thirds(const MatchPair& pair) {
  struct Third {
    double rating;
    RatedMatch match;
  };
  PoolVector<Third> found;
  const Eigen::Vector3d seen = region(pair.a).region.normal.cross(region(pair.b).region.normal);
  const Eigen::Vector3d modelled = face(pair.a).normal.cross(face(pair.b).normal);
  for (std::size_t r = 0; r < matches_.size(); ++r) {
    const int index = static_cast<int>(r);
    if (index == pair.a.region || index == pair.b.region || is_taken(scan_, index)) continue;
    const double volume = seen.dot(regions_.regions[r].region.normal);
    const auto run = std::equal_range(matches_[r].begin(), matches_[r].end(), RatedMatch{0, pair.a.model, 0, 0.0},
                                      [](const RatedMatch& a, const RatedMatch& b) { return a.model < b.model; });
    for (auto third = run.first; third != run.second; ++third) {
      if (!same_handed(volume, modelled.dot(face(*third).normal))) continue;
      const std::optional<double> rating = rate_third(pair, *third);
      if (rating && *rating > 0.0) found.push_back({*rating, *third});
    }
  }
  const auto count = std::min(found.size(), static_cast<std::size_t>(options_.most_thirds));
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count), found.end(),
                    [](const Third& a, const Third& b) {
                      return std::tuple(-a.rating, a.match.region, a.match.face) <
                             std::tuple(-b.rating, b.match.region, b.match.face);
                    });
  PoolVector<RatedMatch> best;
  for (std::size_t i = 0; i < count; ++i) best.push_back(found[i].match);
  return best;
}

std::optional<double> StartSearch::rate_third(const MatchPair& pair, const RatedMatch& third) {
  double rating = third.rating;
  for (const RatedMatch* match : {&pair.a, &pair.b}) {
    const FacePair* faces = database_.pair(third.model, match->face, third.face);
    if (faces == nullptr) return std::nullopt;
    const bool cut = rater_.is_cut(region(*match)) || rater_.is_cut(region(third));
    rating += rater_.rate(*faces, relations_.between(match->region, third.region), cut);
  }
  return rating;
}

// Settles a start on the planes it touches and keeps it, once for all starts that settle together.
void StartSearch::keep(StartPose start, PoseCheck check) {
  if (!(start.quality > least_quality(start.model))) return;
  for (int i = 0; i < kRefits; ++i) {
    const Pose refitted = refit_to_planes(model(start.model), start.T_sensor_model, check, regions_.regions);
    PoseCheck at_refitted = look(start.model, refitted, start.quality);
    if (at_refitted.quality() < start.quality) break;
    start.T_sensor_model = refitted;
    start.quality = at_refitted.quality();
    check = std::move(at_refitted);
  }
  const CompiledModel& compiled = model(start.model);
  PoolVector<std::size_t>& known = of_model_[static_cast<std::size_t>(start.model)];
  const Eigen::Vector3d centre = start.T_sensor_model * compiled.centre;
  const double least_trace = 1.0 + 2.0 * std::cos(options_.same_angle);
  for (const std::size_t index : known) {
    StartPose& other = starts_[index];
    const Eigen::Vector3d apart = other.T_sensor_model * compiled.centre - centre;
    if (apart.squaredNorm() > options_.same_distance * options_.same_distance) continue;
    if (other.T_sensor_model.rotation.cwiseProduct(start.T_sensor_model.rotation).sum() < least_trace) continue;
    if (start.quality > other.quality) other = std::move(start);
    return;
  }
  known.push_back(starts_.size());
  starts_.push_back(std::move(start));
}

PoolVector<StartPose> find_starts(const Database& database, const LabelledScan& scan, const StartSearchOptions& options,
                                  StartSearchCounts& counts) {
  StartSearch search(database, scan, options, counts);
  while (search.look_further(std::numeric_limits<int>::max())) {
  }
  PoolVector<StartPose> starts = search.starts();
  std::stable_sort(starts.begin(), starts.end(), [](const StartPose& a, const StartPose& b) {
    return std::tuple(-a.quality, a.model) < std::tuple(-b.quality, b.model);
  });
  return starts;
}

}  // namespace foresight
