// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/surfel_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace saccade {

namespace {

/// 2 to the power of this is wider than the surfel.
int size_exponent(float radius_m) {
  int exponent{0};
  static_cast<void>(std::frexp(2.0F * radius_m, &exponent));
  return exponent;
}

/// Surfels much smaller than most do not get grids of their own, in which their neighbours would be hard to find.
int least_exponent(std::span<const float> radii_m, std::span<const std::uint32_t> surfels) {
  constexpr int kBelowMedian{2};
  std::vector<float> radii;
  for (const std::uint32_t surfel : surfels) {
    if (radii_m[surfel] > 0.0F) radii.push_back(radii_m[surfel]);
  }
  if (radii.empty()) return 0;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return size_exponent(*middle) - kBelowMedian;
}

}  // namespace

Result<SurfelGraph> SurfelGraph::create(const PointCloud& cloud) {
  SACCADE_CHECK(cloud.validate());
  SurfelGraph graph;
  graph.points_ = cloud.positions_m.size();
  const std::vector<std::uint32_t> surfels = finite_points(cloud.positions_m);
  if (surfels.empty()) return graph;
  if (cloud.radii_m.empty()) return Error{Errc::invalid_argument, "surfels need radii", "surfel graph"};
  for (const std::uint32_t surfel : surfels) {
    if (!(std::isfinite(cloud.radii_m[surfel]) && cloud.radii_m[surfel] >= 0.0F)) {
      return Error{Errc::invalid_argument, "a radius that is not finite, or negative",
                   "point " + std::to_string(surfel)};
    }
  }
  const int least = least_exponent(cloud.radii_m, surfels);
  std::map<int, std::vector<std::uint32_t>> by_size;
  for (const std::uint32_t surfel : surfels) {
    const float radius_m = cloud.radii_m[surfel];
    by_size[radius_m > 0.0F ? std::max(least, size_exponent(radius_m)) : least].push_back(surfel);
  }
  graph.surfels_.reserve(surfels.size());
  for (const auto& [exponent, of_size] : by_size) {
    SACCADE_TRY(PointCells cells, PointCells::create(cloud.positions_m, of_size, std::ldexp(1.0, exponent)));
    const auto first = static_cast<std::uint32_t>(graph.surfels_.size());
    graph.surfels_.insert(graph.surfels_.end(), cells.points().begin(), cells.points().end());
    graph.levels_.push_back({std::move(cells), first});
  }
  graph.nodes_.reserve(surfels.size());
  for (const std::uint32_t surfel : graph.surfels_) {
    const Eigen::Vector3f& p_m = cloud.positions_m[surfel];
    graph.nodes_.emplace_back(p_m.x(), p_m.y(), p_m.z(), cloud.radii_m[surfel]);
  }
  return graph;
}

void SurfelGraph::find_others(std::size_t level, std::size_t cell, std::vector<Range>& others) const {
  others.clear();
  const PointCells& own = levels_[level].cells;
  const auto add = [&](std::size_t in_level, std::uint64_t key) {
    const std::uint32_t found = levels_[in_level].cells.find(key);
    if (found != kUnlabelled) others.push_back(range_of(in_level, found));
  };
  const auto& around = neighbour_offsets();
  for (std::size_t i = 0; i < around.size() / 2; ++i) add(level, own.key(cell) + around[i]);  // the rest are opposite
  const Eigen::Vector3f p_m = nodes_[range_of(level, static_cast<std::uint32_t>(cell)).begin].head<3>();
  for (std::size_t coarser = level + 1; coarser < levels_.size(); ++coarser) {
    const std::uint64_t key = cell_at(p_m, levels_[coarser].cells.size_m());
    add(coarser, key);
    for (const std::uint64_t offset : around) add(coarser, key + offset);
  }
}

SurfelComponents number_components(const SurfelGraph& graph, DisjointSets& sets) {
  std::vector<std::uint32_t> surfels{graph.surfels().begin(), graph.surfels().end()};
  std::sort(surfels.begin(), surfels.end());
  SurfelComponents components;
  components.labels.assign(graph.points(), kUnlabelled);
  for (const std::uint32_t surfel : surfels) {
    const std::uint32_t least = sets.root(surfel);
    components.labels[surfel] =
        least == surfel ? static_cast<std::uint32_t>(components.count++) : components.labels[least];
  }
  return components;
}

Result<SurfelComponents> split_unconnected(const SurfelGraph& graph, std::span<const std::uint32_t> labels,
                                           const Executor& executor) {
  if (labels.size() != graph.points()) {
    return Error{Errc::size_mismatch, "one label per surfel is needed", "split"};
  }
  const std::span<const std::uint32_t> surfels = graph.surfels();
  SurfelComponents parts = connected_surfels(
      graph, executor, [&](std::uint32_t a, std::uint32_t b) { return labels[surfels[a]] == labels[surfels[b]]; });
  std::vector<std::uint32_t> numbers(parts.count, kUnlabelled);  // without the parts that have no label
  parts.count = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::uint32_t& part = parts.labels[i];
    if (part == kUnlabelled) continue;
    if (labels[i] == kUnlabelled) {
      part = kUnlabelled;
      continue;
    }
    if (numbers[part] == kUnlabelled) numbers[part] = static_cast<std::uint32_t>(parts.count++);
    part = numbers[part];
  }
  return parts;
}

}  // namespace saccade
