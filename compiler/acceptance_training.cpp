#include "compiler/acceptance_training.h"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "compiler/logistic_regression.h"
#include "compiler/scene_generator.h"
#include "runtime/nearest_data_cell.h"
#include "runtime/pose_evidence.h"
#include "runtime/recognize.h"
#include "runtime/rendering.h"
#include "runtime/scan_context.h"
#include "runtime/settled_localization.h"
#include "runtime/start_search.h"

namespace foresight {
namespace {

constexpr double kStretch = 1.2;        // of the impostors
constexpr int kBoxes = 6;               // among them
constexpr double kSmallestSide = 0.15;  // of a box, as a share of the object's diameter
constexpr double kLargestSide = 1.2;
constexpr std::uint64_t kBoxStream = ~std::uint64_t{0};  // of random numbers; scenes use the low ones
constexpr double kSameDistance = 5.0;                    // of cells that show the same, at least. Unit: mm.
constexpr double kRightShare = 0.9;                      // of the cells of poses that show the same: right
constexpr double kWrongShare = 0.8;                      // fewer show the same: wrong; between them nothing is learnt
constexpr double kNearShare = 0.5;                       // of a start that is worth refining here: show the same
constexpr double kLeastVisible = 0.3;                    // an object hidden by more teaches nothing about right poses
// What evidence weighs for any object, of which some hundred samples of one object leave single weights open: a fit
// with these signs over 37000 refined poses, all eight objects of models/ together, in simulated clutter and single
// views (exploration seeds 5, 11, 33, 55 and 77).
constexpr std::array<double, kEvidenceFeatureCount> kExpectedWeights = {25.3, -5.0, -5.8, -0.1, 7.8, 0.1, 0.1, -3.1};
// How much the samples must say to change that. Between 0.2 and 3 it trades false reports in clean clutter against
// those in noisy clutter.
constexpr double kRidge = 0.5;
constexpr double kFixed = 1e6;  // a ridge that leaves no choice
// Of the least quality, and the least odds, that came to a right pose: few scenes were looked at.
constexpr double kQualityReserve = 0.5;
constexpr double kOddsReserve = 0.1;

using Features = std::array<double, kEvidenceFeatureCount>;

// What one scene teaches.
struct Lessons {
  std::vector<Features> right;
  std::vector<Features> wrong;
  // Of the best looking start that came to a right pose: recognition needs no other.
  std::vector<double> qualities;
  std::vector<Features> starts;
};

CadModel linearly_mapped(const CadModel& cad, const Eigen::Matrix3d& map) {
  CadModel mapped = cad;
  for (Eigen::Vector3d& vertex : mapped.vertices) vertex = map * vertex;
  if (map.determinant() < 0.0) {
    for (auto& triangle : mapped.triangles) std::swap(triangle[1], triangle[2]);
  }
  find_planar_faces(mapped, {});
  return mapped;
}

// A solid with flat faces of any size, as they lie about anywhere. Sides: shares of the object's diameter.
CadModel random_box(double diameter, Random& random) {
  CadModel box;
  Eigen::Vector3d size;
  for (int axis = 0; axis < 3; ++axis) size[axis] = diameter * random.uniform(kSmallestSide, kLargestSide);
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back((i & 1) != 0 ? size.x() : 0.0, (i & 2) != 0 ? size.y() : 0.0,
                              (i & 4) != 0 ? size.z() : 0.0);
  }
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  find_planar_faces(box, {});
  return box;
}

// The object, its impostors, then boxes.
struct Cast {
  std::vector<CadModel> models;
  int impostors = 0;
};

Cast cast_of(const CadModel& cad, std::uint64_t seed) {
  Cast cast;
  cast.models = {cad, linearly_mapped(cad, Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal())};
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d scale = Eigen::Vector3d::Ones();
    scale[axis] = axis == 1 ? 1.0 / kStretch : kStretch;
    cast.models.push_back(linearly_mapped(cad, scale.asDiagonal()));
  }
  cast.impostors = static_cast<int>(cast.models.size()) - 1;
  Random random(~seed, kBoxStream);
  for (int i = 0; i < kBoxes; ++i) cast.models.push_back(random_box(cad.diameter(), random));
  return cast;
}

// A quarter of the scenes each: the object alone; with an impostor among boxes; an impostor among boxes without it;
// with all impostors and two boxes, much hidden.
std::vector<int> roles(const Cast& cast, int index, Random& random) {
  const int first_box = cast.impostors + 1;
  std::vector<int> roles;
  if (index % 4 != 2) roles.push_back(0);
  if (index % 4 == 0) return roles;
  if (index % 4 == 3) {
    for (int i = 1; i <= cast.impostors; ++i) roles.push_back(i);
  } else {
    roles.push_back(random.integer(1, cast.impostors));
  }
  const int boxes = index % 4 == 3 ? 2 : 3;
  const int first = random.integer(0, kBoxes - 1);
  for (int i = 0; i < boxes; ++i) roles.push_back(first_box + (first + i) % kBoxes);
  return roles;
}

Scene training_scene(const Cast& cast, const SensorModel& sensor, const AcceptanceTrainingOptions& options, int index) {
  Random random(~options.seed, static_cast<std::uint64_t>(index));
  const std::vector<int> chosen = roles(cast, index, random);
  std::vector<CadModel> models;
  for (const int i : chosen) models.push_back(cast.models[static_cast<std::size_t>(i)]);
  const int count = static_cast<int>(models.size());
  const int measured = chosen.front() == 0 ? 0 : -1;  // nobody asks how much of the others is visible
  Scene scene = generate_scene(models, sensor, {count, count, sensor.background, measured}, options.seed,
                               static_cast<std::uint64_t>(index));
  for (SceneObject& object : scene.objects) object.model = chosen[static_cast<std::size_t>(object.model)];
  return scene;
}

// The share of the cells showing either, each alone, that show the same surface as far as the sensor can tell.
double same_share(const Rendering& a, const Rendering& b, const SensorModel& sensor) {
  return same_share(a, b, std::max(kSameDistance, agreeing_distance(sensor)), sensor.matching_window / 2);
}

// The pose moved and turned about the object's centre.
Pose displaced(const CompiledModel& model, const Pose& pose, double distance, double angle, Random& random) {
  Pose moved;
  moved.rotation = rotation_from_vector(angle * random.direction()) * pose.rotation;
  moved.translation = pose * model.centre + distance * random.direction() - moved.rotation * model.centre;
  return moved;
}

// As much of a compiled model as drawing it takes.
CompiledModel drawable(const CadModel& cad) {
  CompiledModel model;
  for (const Eigen::Vector3d& vertex : cad.vertices) model.vertices.push_back(vertex.cast<float>());
  model.triangles = cad.triangles;
  return model;
}

class SceneTeacher {
 public:
  SceneTeacher(const Database& database, const Cast& cast, const Scene& scene,
               const PoolVector<DescribedRegion>& regions)
      : model_(database.models().front()),
        data_(scene.scan.image, database.content().sensor.camera, judging_options(database.content().sensor).stride),
        context_{scene.scan.image, database.content().sensor.camera, database, regions, data_},
        labelled_(label_scan(scene.scan.image, context_.camera, database.content().sensor, regions)),
        settling_(database, labelled_, settling_options(labelled_.sensor)) {
    for (const SceneObject& object : scene.objects) {
      if (object.model == 0 && object.visible_fraction >= kLeastVisible) truth_ = object.T_sensor_model;
      present_ = present_ || object.model == 0;
      if (object.model > 0) {
        const CompiledModel other = drawable(cast.models[static_cast<std::size_t>(object.model)]);
        impostors_.push_back(render(other, object.T_sensor_model, context_.camera));
      }
    }
    if (truth_) true_view_ = drawn(*truth_);
  }

  Lessons teach(const AcceptanceTrainingOptions& options, Random random) {
    if (truth_) {
      learn(displaced(model_, *truth_, 0.01 * model_.diameter, 0.03, random));  // comes home
      learn(displaced(model_, *truth_, 0.1 * model_.diameter, 0.3, random));    // may be caught elsewhere
      learn(displaced(model_, *truth_, 0.05 * model_.diameter, 3.0, random));   // turned round
    }
    StartSearchCounts counts;
    const PoolVector<StartPose> starts = find_starts(context_.database, labelled_, {}, counts);
    // The best looking right ones and the best looking wrong ones: what recognition will have to tell apart.
    std::vector<std::size_t> wrong;
    int near = 0;
    const auto last_right = static_cast<std::size_t>(options.most_right_starts);
    const std::size_t most = std::min(static_cast<std::size_t>(options.most_wrong_starts), starts.size());
    for (std::size_t i = 0; i < most; ++i) {
      const StartPose& start = starts[i];
      const bool is_near =
          truth_ && same_share(drawn(start.T_sensor_model), true_view_, labelled_.sensor) >= kNearShare;
      if (!is_near) wrong.push_back(i);
      if (!is_near || i >= last_right || ++near > options.most_near) continue;
      const bool first = lessons_.qualities.empty();
      if (!learn(start.T_sensor_model) || !first) continue;
      lessons_.qualities.push_back(start.quality);
      lessons_.starts.push_back(rough_features(start));
    }
    learn_wrong(starts, wrong, options.most_far);
    return lessons_;
  }

 private:
  [[nodiscard]] Rendering drawn(const Pose& pose) const { return render(model_, pose, context_.camera); }

  [[nodiscard]] Features rough_features(const StartPose& start) const {
    EvidenceOptions rough;
    rough.distance = kStartDistance;
    return evidence_features(gather_evidence(model_, start.T_sensor_model, labelled_, rough));
  }

  // Half of them the best looking, half those that evidence speaks for most: an object hidden for the most part does
  // not look like much, but what is seen of it may fit well by chance.
  void learn_wrong(const PoolVector<StartPose>& starts, const std::vector<std::size_t>& wrong, int most) {
    const std::size_t half = std::min(wrong.size(), static_cast<std::size_t>(most / 2));
    for (std::size_t i = 0; i < half; ++i) learn(starts[wrong[i]].T_sensor_model);
    std::vector<std::pair<double, std::size_t>> spoken_for;
    for (std::size_t i = half; i < wrong.size(); ++i) {
      const Features features = rough_features(starts[wrong[i]]);
      const double sum = std::inner_product(features.begin(), features.end(), kExpectedWeights.begin(), 0.0);
      spoken_for.emplace_back(-sum, wrong[i]);
    }
    std::sort(spoken_for.begin(), spoken_for.end());
    for (std::size_t i = 0; i < std::min(spoken_for.size(), half); ++i) {
      learn(starts[spoken_for[i].second].T_sensor_model);
    }
  }

  // Refines a start and takes down what its evidence looks like. Whether it came to a right pose.
  bool learn(const Pose& start) {
    const SettledPose settled = localize_and_settle(context_, labelled_, 0, start, {}, settling_);
    const Rendering view = drawn(settled.localization.T_sensor_model);
    const double share = truth_ ? same_share(view, true_view_, labelled_.sensor) : 0.0;
    const bool right = share >= kRightShare;
    if (right || is_wrong(view, share)) {
      const Features features = evidence_features(settled.evidence);
      (right ? lessons_.right : lessons_.wrong).push_back(features);
    }
    return right;
  }

  // Neither right nor wrong: a pose of an object that is there but hardly visible, one a little beside the true one,
  // and one at an impostor that this view, or a symmetry of the object, cannot be told from the object.
  bool is_wrong(const Rendering& view, double share) const {
    if (share >= kWrongShare || (present_ && !truth_)) return false;
    return std::all_of(impostors_.begin(), impostors_.end(), [&](const Rendering& impostor) {
      return same_share(view, impostor, labelled_.sensor) < kWrongShare;
    });
  }

  const CompiledModel& model_;
  NearestDataCell data_;
  ScanContext context_;
  LabelledScan labelled_;
  PoseChecker settling_;
  std::optional<Pose> truth_;
  bool present_ = false;
  Rendering true_view_;               // where there is a truth
  std::vector<Rendering> impostors_;  // and boxes, each alone
  Lessons lessons_;
};

Lessons lessons_of_scene(const Cast& cast, const Database& database, const AcceptanceTrainingOptions& options,
                         int index) {
  const CompiledDatabase& settings = database.content();
  const Scene scene = training_scene(cast, settings.sensor, options, index);
  const auto regions = extract_regions(scene.scan.image, settings.sensor.camera, settings.segmentation);
  return SceneTeacher(database, cast, scene, regions)
      .teach(options, Random(options.seed, static_cast<std::uint64_t>(index)));
}

// Both classes always have a voice: what any object's perfect and worthless evidence looks like.
void add_ideals(Lessons& lessons) {
  Features perfect{};
  perfect[kOwnedShare] = perfect[kFoundFaces] = perfect[kAmount] = perfect[kOtherSurfaces] = 1.0;
  Features worthless{};
  worthless[kContradictedShare] = 1.0;
  lessons.right.push_back(perfect);
  lessons.wrong.push_back(worthless);
}

// Explained cells speak for a pose, everything else against it. A weight that the few samples give another sign is
// noise: the expected one stands in.
LogisticFit fit_with_signs(const Eigen::MatrixXd& features, const Eigen::VectorXd& labels) {
  const Eigen::VectorXd expected = Eigen::Map<const Eigen::VectorXd>(kExpectedWeights.data(), kEvidenceFeatureCount);
  Eigen::VectorXd ridges = Eigen::VectorXd::Constant(kEvidenceFeatureCount, kRidge);
  while (true) {
    const LogisticFit fit = fit_logistic(features, labels, ridges, expected);
    const Eigen::Array<bool, Eigen::Dynamic, 1> wrong_sign =
        fit.weights.array() * expected.array() < 0.0 && ridges.array() < kFixed;
    if (!wrong_sign.any()) return fit;
    ridges = wrong_sign.select(kFixed, ridges);
  }
}

}  // namespace

AcceptanceModel train_acceptance(const CadModel& cad, const CompiledModel& compiled, const CompiledDatabase& settings,
                                 const AcceptanceTrainingOptions& options) {
  CompiledDatabase content = settings;
  content.models = {compiled};
  content.models.front().acceptance = {};  // what the search asks of starts is still to be learnt
  const Database database(std::move(content));
  const Cast cast = cast_of(cad, options.seed);
  std::vector<Lessons> of_scene(static_cast<std::size_t>(options.scenes));
  tbb::parallel_for(0, options.scenes, [&](int i) {
    of_scene[static_cast<std::size_t>(i)] = lessons_of_scene(cast, database, options, i);
  });

  Lessons all;
  for (const Lessons& lessons : of_scene) {
    all.right.insert(all.right.end(), lessons.right.begin(), lessons.right.end());
    all.wrong.insert(all.wrong.end(), lessons.wrong.begin(), lessons.wrong.end());
    all.qualities.insert(all.qualities.end(), lessons.qualities.begin(), lessons.qualities.end());
    all.starts.insert(all.starts.end(), lessons.starts.begin(), lessons.starts.end());
  }
  add_ideals(all);
  const auto rights = static_cast<Eigen::Index>(all.right.size());
  const auto samples = rights + static_cast<Eigen::Index>(all.wrong.size());
  Eigen::MatrixXd features(samples, kEvidenceFeatureCount);
  Eigen::VectorXd labels(samples);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const bool right = i < rights;
    const Features& row =
        right ? all.right[static_cast<std::size_t>(i)] : all.wrong[static_cast<std::size_t>(i - rights)];
    features.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), kEvidenceFeatureCount);
    labels[i] = right ? 1.0 : 0.0;
  }
  const LogisticFit fit = fit_with_signs(features, labels);
  AcceptanceModel model;
  for (int k = 0; k < kEvidenceFeatureCount; ++k) model.weights[static_cast<std::size_t>(k)] = fit.weights[k];
  model.bias = fit.bias;
  // Without a single right pose to go by, nothing is given up early.
  if (!all.starts.empty()) {
    model.least_quality = kQualityReserve * *std::min_element(all.qualities.begin(), all.qualities.end());
    double least = 1.0;
    for (const Features& start : all.starts) least = std::min(least, probability_right(model, start));
    model.least_probability = kOddsReserve * least / (1.0 - least + kOddsReserve * least);  // the odds
  }
  model.samples = static_cast<int>(samples);
  return model;
}

}  // namespace foresight
