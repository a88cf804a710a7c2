#include "compiler/face_alignments.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace foresight {
namespace {

constexpr std::size_t kAnchors = 8;       // faces that are laid on others
constexpr std::size_t kTargets = 32;      // faces that they are laid on
constexpr std::size_t kMostFaces = 1000;  // the largest ones, looked at for the area that a rotation can bring together
constexpr std::size_t kMostRotations = 128;
constexpr std::size_t kMostOffsets = 3;  // along one axis, beside that of the centres
constexpr double kParallel = 0.95;       // cosine; nearer to parallel, two normals say little about a rotation
constexpr double kSameAngle = 0.0873;    // 5 degrees
constexpr double kSameNormal = 0.985;    // cosine, 10 degrees

// Values n . t that lay faces on faces, t the translation and n an axis.
struct Axis {
  Eigen::Vector3d direction;
  std::vector<std::pair<double, double>> offsets;  // value and the area that it brings together
  double weight = 0.0;
};

class Alignments {
 public:
  Alignments(const CadModel& model, const FaceAlignmentOptions& options)
      : options_(options), centre_(surface_centre(model)) {
    for (const CadFace& face : model.faces) faces_.push_back(&face);
    std::stable_sort(faces_.begin(), faces_.end(), [](const auto* a, const auto* b) { return a->area > b->area; });
    if (faces_.size() > kMostFaces) faces_.resize(kMostFaces);
  }

  [[nodiscard]] std::vector<Pose> run() const {
    std::vector<Pose> poses;
    for (const Eigen::Matrix3d& rotation : rotations()) {
      for (const Eigen::Vector3d& translation : translations(rotation)) poses.push_back({rotation, translation});
    }
    return poses;
  }

 private:
  [[nodiscard]] std::size_t targets() const { return std::min(kTargets, faces_.size()); }

  // Share of the large faces' area that finds area of the same normal, wherever that is.
  [[nodiscard]] double area_brought_together(const Eigen::Matrix3d& rotation) const {
    double all = 0.0;
    double met = 0.0;
    for (std::size_t a = 0; a < targets(); ++a) {
      const Eigen::Vector3d normal = rotation * faces_[a]->normal;
      double there = 0.0;
      for (std::size_t c = 0; c < faces_.size() && there < faces_[a]->area; ++c) {
        if (faces_[c]->normal.dot(normal) >= kSameNormal) there += faces_[c]->area;
      }
      met += std::min(there, faces_[a]->area);
      all += faces_[a]->area;
    }
    return met / all;
  }

  [[nodiscard]] std::vector<Eigen::Matrix3d> rotations() const {
    std::vector<std::pair<double, Eigen::Matrix3d>> found;
    const std::size_t anchors = std::min(kAnchors, faces_.size());
    for (std::size_t a = 0; a < anchors; ++a) {
      for (std::size_t b = a + 1; b < anchors; ++b) {
        const double cosine = faces_[a]->normal.dot(faces_[b]->normal);
        if (std::abs(cosine) > kParallel) continue;
        const Eigen::Matrix3d from = axes_from(faces_[a]->normal, faces_[b]->normal).transpose();
        for (std::size_t c = 0; c < targets(); ++c) {
          for (std::size_t d = 0; d < targets(); ++d) {
            const double other = faces_[c]->normal.dot(faces_[d]->normal);
            if (c == d || std::abs(other) > kParallel) continue;
            if (std::abs(std::acos(cosine) - std::acos(other)) > kSameAngle) continue;
            const Eigen::Matrix3d rotation = axes_from(faces_[c]->normal, faces_[d]->normal) * from;
            const double share = area_brought_together(rotation);
            if (share >= options_.least_share) found.emplace_back(share, rotation);
          }
        }
      }
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.first > y.first + 1e-9; });
    std::vector<Eigen::Matrix3d> unique;
    const double least_trace = 1.0 + 2.0 * std::cos(kSameAngle);  // trace(A^T B) = 1 + 2 cos(angle between A and B)
    for (const auto& [share, rotation] : found) {
      if (unique.size() == kMostRotations) break;
      if (std::none_of(unique.begin(), unique.end(), [&, &turn = rotation](const Eigen::Matrix3d& known) {
            return known.cwiseProduct(turn).sum() >= least_trace;
          }))
        unique.push_back(rotation);
    }
    return unique;
  }

  // The axes along which faces lie on faces after a rotation, those of most area first.
  [[nodiscard]] std::vector<Axis> axes_of(const Eigen::Matrix3d& rotation) const {
    std::vector<Axis> found;
    for (std::size_t a = 0; a < targets(); ++a) {
      const Eigen::Vector3d normal = rotation * faces_[a]->normal;
      for (std::size_t c = 0; c < targets(); ++c) {
        const CadFace& onto = *faces_[c];
        if (onto.normal.dot(normal) < kSameNormal) continue;
        auto axis = std::find_if(found.begin(), found.end(), [&](const Axis& known) {
          return std::abs(known.direction.dot(onto.normal)) >= kSameNormal;
        });
        if (axis == found.end()) axis = found.insert(found.end(), Axis{onto.normal, {}, 0.0});
        const double sign = axis->direction.dot(onto.normal) > 0.0 ? 1.0 : -1.0;
        const double area = std::min(faces_[a]->area, onto.area);
        axis->offsets.emplace_back(sign * (onto.offset - onto.normal.dot(rotation * faces_[a]->centroid)), area);
        axis->weight += area;
      }
    }
    std::stable_sort(found.begin(), found.end(), [](const Axis& x, const Axis& y) { return x.weight > y.weight; });
    return found;
  }

  // The offsets of most area along an axis, and that of the centres.
  [[nodiscard]] std::vector<double> values(const Axis& axis, const Eigen::Vector3d& of_centres) const {
    std::vector<std::pair<double, double>> offsets = axis.offsets;
    std::sort(offsets.begin(), offsets.end());
    std::vector<std::pair<double, double>> peaks;  // weight, mean
    for (std::size_t i = 0; i < offsets.size();) {
      double weight = 0.0;
      double sum = 0.0;
      std::size_t end = i;
      for (; end < offsets.size() && offsets[end].first <= offsets[i].first + 0.5 * options_.distance; ++end) {
        weight += offsets[end].second;
        sum += offsets[end].first * offsets[end].second;
      }
      peaks.emplace_back(weight, sum / weight);
      i = end;
    }
    std::stable_sort(peaks.begin(), peaks.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
    std::vector<double> result = {axis.direction.dot(of_centres)};
    for (std::size_t i = 0; i < std::min(kMostOffsets, peaks.size()); ++i) result.push_back(peaks[i].second);
    return result;
  }

  // Three axes that are not in one plane; what faces leave open goes by the centres.
  static std::vector<Axis> three_of(const std::vector<Axis>& found) {
    std::vector<Axis> three;
    const auto add = [&](const Axis& axis) {
      if (three.size() == 1 && std::abs(three[0].direction.dot(axis.direction)) > kParallel) return;
      if (three.size() == 2 &&
          std::abs(three[0].direction.cross(three[1].direction).normalized().dot(axis.direction)) < 0.3)
        return;
      if (three.size() < 3) three.push_back(axis);
    };
    for (const Axis& axis : found) add(axis);
    for (int k = 0; k < 3; ++k) add({Eigen::Vector3d::Unit(k), {}, 0.0});
    return three;
  }

  [[nodiscard]] std::vector<Eigen::Vector3d> translations(const Eigen::Matrix3d& rotation) const {
    const Eigen::Vector3d of_centres = centre_ - rotation * centre_;
    const std::vector<Axis> three = three_of(axes_of(rotation));
    Eigen::Matrix3d rows;
    for (int k = 0; k < 3; ++k) rows.row(k) = three[static_cast<std::size_t>(k)].direction;
    const Eigen::Matrix3d inverse = rows.inverse();
    std::vector<Eigen::Vector3d> result;
    for (const double x : values(three[0], of_centres)) {
      for (const double y : values(three[1], of_centres)) {
        for (const double z : values(three[2], of_centres)) result.push_back(inverse * Eigen::Vector3d(x, y, z));
      }
    }
    return result;
  }

  const FaceAlignmentOptions& options_;
  Eigen::Vector3d centre_;
  std::vector<const CadFace*> faces_;  // largest first
};

}  // namespace

std::vector<Pose> face_alignments(const CadModel& model, const FaceAlignmentOptions& options) {
  return Alignments(model, options).run();
}

Eigen::Vector3d surface_centre(const CadModel& model) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (const CadFace& face : model.faces) {
    sum += face.area * face.centroid;
    area += face.area;
  }
  return sum / area;
}

Eigen::Matrix3d axes_from(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  Eigen::Matrix3d frame;
  frame.col(0) = first;
  frame.col(2) = first.cross(second).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

}  // namespace foresight
