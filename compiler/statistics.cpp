#include "compiler/statistics.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

namespace foresight {
namespace {

// Sample values of one face or one pair of faces, attribute by attribute, and the views they come from.
template <std::size_t N>
struct Samples {
  std::array<std::vector<double>, N> values;
  std::set<int> views;

  void add(const std::array<double, N>& observed, int view) {
    for (std::size_t k = 0; k < N; ++k) values[k].push_back(observed[k]);
    views.insert(view);
  }
};

// Range of the bins: from 0 to the largest value any sample has.
template <std::size_t N, typename Map>
std::array<double, N> largest_values(const Map& samples) {
  std::array<double, N> largest{};
  for (const auto& [key, sample] : samples) {
    for (std::size_t k = 0; k < N; ++k) {
      largest[k] = std::max(largest[k], *std::max_element(sample.values[k].begin(), sample.values[k].end()));
    }
  }
  return largest;
}

template <std::size_t N>
std::array<Density, N> densities(const Samples<N>& samples, const std::array<double, N>& upper, const DensityOptions& options) {
  std::array<Density, N> result;
  for (std::size_t k = 0; k < N; ++k) result[k] = estimate_density(samples.values[k], 0.0, upper[k], options);
  return result;
}

}  // namespace

void estimate_statistics(const std::vector<ViewSample>& views, const DensityOptions& options, CompiledModel& model) {
  std::map<int, Samples<kAttributeCount>> of_faces;
  std::map<std::pair<int, int>, Samples<kRelationCount>> of_pairs;
  for (std::size_t view = 0; view < views.size(); ++view) {
    for (const auto& [face, attributes] : views[view].faces) of_faces[face].add(attributes, static_cast<int>(view));
    for (const auto& [first, second, relations] : views[view].pairs) {
      of_pairs[{first, second}].add(relations, static_cast<int>(view));
    }
  }

  model.views = static_cast<int>(views.size());
  const auto largest = largest_values<kAttributeCount>(of_faces);
  for (const auto& [face, samples] : of_faces) {
    ModelFace& target = model.faces[static_cast<std::size_t>(face)];
    target.views_found = static_cast<int>(samples.views.size());
    target.densities = densities<kAttributeCount>(samples, largest, options);
  }

  auto farthest = largest_values<kRelationCount>(of_pairs);
  farthest[kOrientation] = std::numbers::pi;  // an angle has its own natural range
  model.pairs.clear();
  for (const auto& [faces, samples] : of_pairs) {
    model.pairs.push_back({faces.first, faces.second, static_cast<int>(samples.views.size()),
                           densities<kRelationCount>(samples, farthest, options)});
  }
}

}  // namespace foresight
