#include "benchmarks/hypothesis_tester.h"

#include <optional>

#include "runtime/explained_regions.h"
#include "runtime/localization.h"
#include "runtime/pose_from_matches.h"
#include "runtime/verification.h"

namespace foresight {

HypothesisTester::HypothesisTester(const RangeImage& image, const PinholeCamera& camera,
                                   const PoolVector<DescribedRegion>& regions, const std::vector<CompiledModel>& models,
                                   const SceneTruth& truth)
    : image_(image), camera_(camera), regions_(regions), models_(models), truth_(truth), data_(image) {}

const HypothesisTest& HypothesisTester::test(const Clique& clique) {
  const auto found = known_.find(clique);
  if (found != known_.end()) return found->second;
  return known_.emplace(clique, run(clique)).first->second;
}

HypothesisTest HypothesisTester::run(const Clique& clique) const {
  const CompiledModel& model = models_[static_cast<std::size_t>(clique.model)];
  PoolVector<RegionFaceMatch> matches;
  for (const RegionAsFace& match : clique.matches) {
    matches.push_back(
        {&regions_[static_cast<std::size_t>(match.region)], &model.faces[static_cast<std::size_t>(match.face)]});
  }
  HypothesisTest result;
  const std::optional<Pose> start = pose_from_matches(matches);
  if (!start) return result;
  result.tested = true;
  const Pose pose = localize(model, sphere_, *start, data_, {}).T_sensor_model;
  result.accepted = verify(model, sphere_, pose, image_, camera_, data_, {}).accepted;
  if (!result.accepted) return result;
  result.right =
      clique.model == truth_.model && mssd(*truth_.object, pose, truth_.T_sensor_model) <= truth_.object->tolerance();
  const PoolVector<int> explained = explained_regions(model, pose, image_, regions_);
  result.explained.assign(explained.begin(), explained.end());
  return result;
}

}  // namespace foresight
