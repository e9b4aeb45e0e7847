// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/internal/surfel_graph.hpp"

#include "saccade/core/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace saccade {

namespace {

/// Returns an exponent: 2 to its power is wider than the surfel. Sizes within a factor of four share a grid, because
/// visiting another grid costs more than the points of wider cells.
int size_exponent(float radius_m) {
  int exponent{0};
  static_cast<void>(std::frexp(2.0F * radius_m, &exponent));
  return exponent + (exponent & 1);
}

/// Returns the smallest exponent of a grid: surfels much smaller than most get no grid of their own, in which
/// neighbours would be hard to find.
int least_exponent(std::span<const float> radii_m, std::span<const std::uint32_t> surfels) {
  constexpr int kBelowMedian{2};
  std::vector<float> radii;
  for (const std::uint32_t surfel : surfels) {
    if (radii_m[surfel] > 0.0F) radii.push_back(radii_m[surfel]);
  }
  if (radii.empty()) return 0;
  return size_exponent(upper_median(radii)) - kBelowMedian;
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
      return Error{Errc::invalid_argument, "a radius is not finite, or negative", "point " + std::to_string(surfel)};
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

void SurfelGraph::gather(std::size_t level, std::size_t cell, Nearby& near) const {
  near.nodes.clear();
  const auto add = [&](const Range& range) {
    for (std::uint32_t node = range.begin; node < range.end; ++node) near.nodes.push_back(node);
  };
  const auto add_cell = [&](std::size_t in_level, std::uint64_t key) {
    const std::uint32_t found = levels_[in_level].cells.find(key);
    if (found != kUnlabelled) add(range_of(in_level, found));
  };
  const PointCells& cells = levels_[level].cells;
  add(range_of(level, static_cast<std::uint32_t>(cell)));
  near.own = near.nodes.size();
  // Half of the cells around it, so that each pair occurs once, and all around it in coarser grids.
  const auto& around = neighbour_offsets();
  for (std::size_t i = 0; i < around.size() / 2; ++i) add_cell(level, cells.key(cell) + around[i]);
  const Eigen::Vector3f p_m = nodes_[near.nodes.front()].head<3>();
  for (std::size_t coarser = level + 1; coarser < levels_.size(); ++coarser) {
    const std::uint64_t key = cell_at(p_m, levels_[coarser].cells.size_m());
    add_cell(coarser, key);
    for (const std::uint64_t offset : around) add_cell(coarser, key + offset);
  }
  near.found.resize((near.nodes.size() + kBlock - 1) / kBlock);
  for (std::size_t lane = 0; lane < near.lanes.size(); ++lane) {
    std::vector<float>& values = near.lanes[lane];
    values.assign(kBlock * near.found.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t k = 0; k < near.nodes.size(); ++k) {
      values[k] = nodes_[near.nodes[k]][static_cast<Eigen::Index>(lane)];
    }
  }
}

void SurfelGraph::find_near(std::size_t i, Nearby& near) {
  constexpr float kMargin{1.0F + 1e-5F};
  const auto& [x, y, z, radius] = near.lanes;
  const float x_i = x[i], y_i = y[i], z_i = z[i], radius_i = radius[i];
  for (std::size_t block = (i + 1) / kBlock; block < near.found.size(); ++block) {
    std::array<std::uint8_t, kBlock> flags;
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
      const std::size_t k = kBlock * block + lane;
      const float dx = x[k] - x_i, dy = y[k] - y_i, dz = z[k] - z_i;
      const float reach_m = radius[k] + radius_i;
      flags[lane] = dx * dx + dy * dy + dz * dz <= reach_m * reach_m * kMargin ? 1 : 0;
    }
    near.found[block] = std::bit_cast<std::uint64_t>(flags);
  }
  const std::size_t first = (i + 1) / kBlock;  // partners of i come after it
  if (first < near.found.size()) near.found[first] &= ~std::uint64_t{0} << (8 * ((i + 1) % kBlock));
}

SurfelComponents number_components(const SurfelGraph& graph, DisjointSets& sets) {
  SurfelComponents components;
  components.labels.assign(graph.points(), kUnlabelled);
  const std::span<const std::uint32_t> surfels = graph.surfels();
  for (std::uint32_t node = 0; node < surfels.size(); ++node) components.labels[surfels[node]] = sets.root(node);
  std::vector<std::uint32_t> numbers(surfels.size(), kUnlabelled);  // numbers of roots
  for (std::uint32_t& label : components.labels) {
    if (label == kUnlabelled) continue;
    if (numbers[label] == kUnlabelled) numbers[label] = static_cast<std::uint32_t>(components.count++);
    label = numbers[label];
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
  std::vector<std::uint32_t> numbers(parts.count, kUnlabelled);  // excludes parts without a label
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
