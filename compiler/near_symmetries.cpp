#include "compiler/near_symmetries.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/random.h"
#include "compiler/face_alignments.h"
#include "compiler/surface_grid.h"
#include "compiler/symmetries.h"

namespace foresight {
namespace {

constexpr std::size_t kMostStarts = 64;
constexpr int kRoughSamples = 100;
constexpr int kClimbSamples = 300;
constexpr int kFineSamples = 1000;
constexpr double kClearly = 0.003;  // more overlap than this is more

struct Sample {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
};

// How a moved object lies on itself.
struct Overlap {
  double share = 0.0;      // of the samples
  double closeness = 0.0;  // the same, each counting the less the farther it is: the share alone has flat tops
};

struct Motion {
  Pose pose;
  Overlap overlap;
};

// Spread over the triangles by area, in random order: the first ones are spread over the whole surface, too.
std::vector<Sample> surface_samples(const CadModel& model, int count) {
  std::vector<double> sums;  // of the areas up to each triangle
  double sum = 0.0;
  for (const auto& t : model.triangles) {
    const auto corner = [&](std::size_t k) -> const Eigen::Vector3d& {
      return model.vertices[static_cast<std::size_t>(t[k])];
    };
    sums.push_back(sum += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm());
  }
  Random random(1);
  std::vector<Sample> samples;
  for (int i = 0; i < count; ++i) {
    const double place = sum * (i + random.uniform()) / count;
    const auto found = std::lower_bound(sums.begin(), sums.end() - 1, place);
    const auto t = static_cast<std::size_t>(found - sums.begin());
    const auto corner = [&](std::size_t k) { return model.vertices[static_cast<std::size_t>(model.triangles[t][k])]; };
    const double root = std::sqrt(random.uniform());
    const double share = random.uniform();
    samples.push_back({(1.0 - root) * corner(0) + root * (1.0 - share) * corner(1) + root * share * corner(2),
                       model.faces[static_cast<std::size_t>(model.triangle_face[t])].normal});
  }
  for (int i = count - 1; i > 0; --i)
    std::swap(samples[static_cast<std::size_t>(i)], samples[static_cast<std::size_t>(random.integer(0, i))]);
  return samples;
}

class Search {
 public:
  Search(const CadModel& model, const std::vector<Pose>& group, const NearSymmetryOptions& options)
      : group_(group),
        options_(options),
        grid_(model, options.distance),
        samples_(surface_samples(model, kFineSamples)),
        alignments_(face_alignments(model, {options.distance, 0.8 * options.least_overlap})),
        centre_(surface_centre(model)) {
    const Eigen::Vector3d lowest = model.lowest();
    const Eigen::Vector3d highest = model.highest();
    for (int i = 0; i < 8; ++i)
      box_.emplace_back((i & 1 ? lowest : highest).x(), (i & 2 ? lowest : highest).y(), (i & 4 ? lowest : highest).z());
    radius_ = 0.5 * (highest - lowest).norm();
  }

  [[nodiscard]] std::vector<Symmetry> run() const {
    std::vector<Motion> motions = starts();
    for (Motion& motion : motions) climb(motion);
    std::erase_if(motions,
                  [&](const Motion& motion) { return motion.overlap.share < options_.least_overlap || rises(motion); });
    motions = best_apart(std::move(motions), static_cast<std::size_t>(options_.most));
    std::stable_sort(motions.begin(), motions.end(),
                     [](const Motion& a, const Motion& b) { return a.overlap.share > b.overlap.share; });
    std::vector<Symmetry> symmetries;
    for (const Motion& motion : motions) symmetries.push_back({motion.pose, false, motion.overlap.share});
    return symmetries;
  }

 private:
  [[nodiscard]] Overlap overlap(const Pose& pose, int count) const {
    Overlap sum;
    for (int i = 0; i < count; ++i) {
      const Sample& sample = samples_[static_cast<std::size_t>(i)];
      const double distance =
          grid_.distance(pose * sample.position, pose.rotation * sample.normal, options_.normal_cosine);
      if (distance > options_.distance) continue;
      const double relative = distance / options_.distance;
      sum.share += 1.0;
      sum.closeness += 1.0 - relative * relative;
    }
    return {sum.share / count, sum.closeness / count};
  }

  // Where climbing begins: the best that are apart.
  [[nodiscard]] std::vector<Motion> starts() const {
    std::vector<Motion> motions;
    for (const Pose& pose : alignments_) {
      const Overlap rough = overlap(pose, kRoughSamples);
      if (rough.share >= 0.7 * options_.least_overlap) motions.push_back({pose, rough});
    }
    return best_apart(std::move(motions), kMostStarts);
  }

  // Whether two motions differ by less than the separation, whatever symmetry comes first.
  [[nodiscard]] bool are_one(const Pose& a, const Pose& b) const {
    return std::any_of(group_.begin(), group_.end(), [&](const Pose& symmetry) {
      const Pose other = b * symmetry;
      return std::all_of(box_.begin(), box_.end(), [&](const Eigen::Vector3d& corner) {
        return (a * corner - other * corner).squaredNorm() < options_.separation * options_.separation;
      });
    });
  }

  // The closest ones that are apart from each other and from the symmetries of the group.
  [[nodiscard]] std::vector<Motion> best_apart(std::vector<Motion> motions, std::size_t most) const {
    std::stable_sort(motions.begin(), motions.end(),
                     [](const Motion& a, const Motion& b) { return a.overlap.closeness > b.overlap.closeness; });
    std::vector<Motion> apart;
    for (const Motion& motion : motions) {
      if (apart.size() == most) break;
      if (are_one(motion.pose, Pose{})) continue;
      if (std::none_of(apart.begin(), apart.end(),
                       [&](const Motion& other) { return are_one(motion.pose, other.pose); }))
        apart.push_back(motion);
    }
    return apart;
  }

  // The motion followed by a step along or a turn about an axis; turns are about the middle, by as much as moves the
  // farthest point by the step.
  [[nodiscard]] Pose stepped(const Pose& pose, int direction, double step) const {
    const Eigen::Vector3d along = (direction % 2 == 0 ? step : -step) * Eigen::Vector3d::Unit(direction / 2 % 3);
    if (direction < 6) return {pose.rotation, pose.translation + along};
    const Eigen::Matrix3d turn = rotation_from_vector(along / radius_);
    const Eigen::Vector3d middle = pose * centre_;
    return {turn * pose.rotation, turn * (pose.translation - middle) + middle};
  }

  // To the nearest motion of which no small step comes closer.
  void climb(Motion& motion) const {
    motion.overlap = overlap(motion.pose, kClimbSamples);
    for (double step = 0.5 * options_.distance; step > 0.1 * options_.distance; step *= 0.5) {
      for (int i = 0; i < 24 && ascend(motion, step); ++i) continue;
    }
    motion.pose.rotation = nearest_rotation(motion.pose.rotation);
    motion.overlap = overlap(motion.pose, kFineSamples);
  }

  // One step each way that comes closer.
  bool ascend(Motion& motion, double step) const {
    bool risen = false;
    for (int direction = 0; direction < 12; ++direction) {
      const Pose pose = stepped(motion.pose, direction, step);
      const Overlap there = overlap(pose, kClimbSamples);
      if (there.closeness <= motion.overlap.closeness + 1e-9) continue;
      motion = {pose, there};
      risen = true;
    }
    return risen;
  }

  // Whether it lies on a slope, as a plate that is moved along itself.
  [[nodiscard]] bool rises(const Motion& motion) const {
    for (int direction = 0; direction < 12; ++direction) {
      const Overlap there = overlap(stepped(motion.pose, direction, options_.distance), kFineSamples);
      if (there.closeness > motion.overlap.closeness + kClearly) return true;
    }
    return false;
  }

  const std::vector<Pose>& group_;
  const NearSymmetryOptions& options_;
  SurfaceGrid grid_;
  std::vector<Sample> samples_;
  std::vector<Pose> alignments_;
  std::vector<Eigen::Vector3d> box_;  // corners of the bounding box
  Eigen::Vector3d centre_;            // of the surface
  double radius_ = 0.0;
};

}  // namespace

NearSymmetryOptions near_symmetry_options(const SensorModel& sensor, double diameter) {
  NearSymmetryOptions options;
  options.distance = std::min(std::max(options.distance, 3.0 * sensor.depth_sigma()), 0.05 * diameter);
  options.separation = std::max(0.1 * diameter, 1.5 * options.distance);
  return options;
}

std::vector<Symmetry> find_near_symmetries(const CadModel& model, const std::vector<Pose>& group,
                                           const NearSymmetryOptions& options) {
  return Search(model, group, options).run();
}

std::vector<Symmetry> list_symmetries(const CadModel& model, const SensorModel& sensor) {
  const std::vector<Pose> group = symmetry_group(model, kMostExactSymmetries);
  std::vector<Symmetry> symmetries;
  for (std::size_t i = 1; i < group.size(); ++i) symmetries.push_back({group[i], true, 1.0});
  for (Symmetry& near : find_near_symmetries(model, group, near_symmetry_options(sensor, model.diameter())))
    symmetries.push_back(std::move(near));
  return symmetries;
}

}  // namespace foresight
