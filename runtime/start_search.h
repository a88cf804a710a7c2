// From rated matches to start poses worth refining, the best looking first.
//
// Beyond the paper, which refines hypotheses in the order of their energy: the energy knows attributes, not the image.
// Here hypotheses come best rated first, each is looked at where it puts the object, and what is seen there orders
// them.
#pragma once

#include <optional>
#include <utility>

#include "common/memory_pool.h"
#include "common/pose.h"
#include "runtime/database.h"
#include "runtime/hypothesis_queue.h"
#include "runtime/pose_check.h"
#include "runtime/pose_evidence.h"
#include "runtime/start_poses.h"

namespace foresight {

struct StartPose {
  int model = 0;
  Pose T_sensor_model;
  double quality = 0.0;     // PoseCheck::quality
  PoolVector<int> regions;  // that the hypothesis matched: one, two or three
};

struct StartSearchOptions {
  int most_pairs = 2000;  // hypotheses of two or three regions looked at. Limit: >= 0.
  // Of these. In 24 noisy and 24 clean scenes of clutter (seed 11) and the ABW scans no pair that led to an accepted
  // pose was rated below 4.5.
  double least_rating = 4.0;
  int most_singles = 1000;  // single matches looked at. Limit: >= 0.
  int most_rivals = 200;    // pairs, and as many single matches, looked at for the same regions. Limit: >= 0.
  int most_thirds = 2;      // third regions tried for a pair
  // false: the limits on pairs, singles and their ratings do not hold, and matches that hardly anything speaks for are
  // looked at as well. What pruning costs and spares is measured against this.
  bool pruned = true;
  double same_distance = 4.0;  // starts this near, and
  double same_angle = 0.035;   // turned by less than 2 degrees, are one. Unit: mm, rad. Limit: > 0.
};

struct StartSearchCounts {
  long matches = 0;     // rated high enough
  long hypotheses = 0;  // pairs, triples and single regions
  long checks = 0;      // poses looked at
};

// The search, a stretch at a time, so that what is found may be tried before the rest is looked for.
class StartSearch {
 public:
  // The database, the scan, the options and the counts must outlive the search. What the scan has taken by the time of
  // a call takes no part in it. stop: asked while matches are rated. REQUIRES: the models know the faces of their
  // triangles.
  StartSearch(const Database& database, const LabelledScan& scan, const StartSearchOptions& options,
              StartSearchCounts& counts, const Stop& stop = {});

  // Looks at the next hypotheses, at most so many: the best rated pairs first, then single regions. Whether more may be
  // left. stop: asked on the way.
  bool look_further(int hypotheses, const Stop& stop = {});
  // Looks at all that may explain these regions, the best rated first: pairs of the two, then the first alone. Again:
  // does nothing. second: -1 where one region is all. stop: asked on the way.
  void look_for_rivals(int region, int second, const Stop& stop = {});

  // In the order they were found. A start that settles where another did replaces it where it looks better.
  [[nodiscard]] const PoolVector<StartPose>& starts() const { return starts_; }

 private:
  [[nodiscard]] const CompiledModel& model(int index) const {
    return database_.models()[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const DescribedRegion& region(const RatedMatch& match) const {
    return regions_.regions[static_cast<std::size_t>(match.region)];
  }
  [[nodiscard]] const ModelFace& face(const RatedMatch& match) const {
    return model(match.model).faces[static_cast<std::size_t>(match.face)];
  }
  // Whether to stop, asked for every so many hypotheses.
  [[nodiscard]] bool stopped(const Stop& stop) const;
  PoseCheck look(int model, const Pose& pose, double least_quality);
  [[nodiscard]] double least_quality(int index) const;
  void consider(StartPose& best, PoseCheck& best_check, const Pose& pose, const PoolVector<int>& regions);
  void try_pair(const MatchPair& pair);
  void try_single(const RatedMatch& match);
  [[nodiscard]] PoolVector<RatedMatch> thirds(const MatchPair& pair);
  [[nodiscard]] std::optional<double> rate_third(const MatchPair& pair, const RatedMatch& third);
  void keep(StartPose start, PoseCheck check);

  const Database& database_;
  const LabelledScan& scan_;
  const StartSearchOptions options_;
  StartSearchCounts& counts_;
  ScanRegions regions_;
  FaceShapes shapes_;
  MatchRater rater_;
  PoolVector<RegionMatches> matches_;
  RegionRelations relations_;
  PoseChecker checker_;
  HypothesisQueue queue_;
  int pairs_ = 0;                   // looked at
  PoolVector<RatedMatch> singles_;  // the best rated first
  std::size_t next_single_ = 0;
  PoolSet<std::pair<int, int>> rivals_;  // regions for which they were looked for
  PoolVector<StartPose> starts_;
  PoolVector<PoolVector<std::size_t>> of_model_;  // starts
};

// The whole search at once, best quality first.
[[nodiscard]] PoolVector<StartPose> find_starts(const Database& database, const LabelledScan& scan,
                                                const StartSearchOptions& options, StartSearchCounts& counts);

}  // namespace foresight
