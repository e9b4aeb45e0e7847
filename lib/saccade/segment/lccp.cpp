// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/lccp.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "saccade/cloud/disjoint_sets.hpp"

namespace saccade {

namespace {

/// Returns the smallest allowed angle between the line of centroids and the intersection of the two planes, for normals
/// `angle_rad` apart (Stein et al., section 3.2, with the constants given there).
double least_sane_angle_rad(double angle_rad) {
  constexpr double kMost_rad{60_deg};
  constexpr double kMiddle_deg{25.0};
  constexpr double kSlope_per_deg{0.25};
  return kMost_rad / (1.0 + std::exp(-kSlope_per_deg * (angle_rad / 1_deg - kMiddle_deg)));
}

/// Keeps those convex edges whose ends have a common neighbour connected by convex edges.
std::vector<bool> with_common_neighbour(const SupervoxelResult& from, const std::vector<bool>& convex) {
  std::vector<std::vector<std::uint32_t>> neighbours(from.supervoxels.size());  // sorted, as the edges are
  for (std::size_t e = 0; e < convex.size(); ++e) {
    if (convex[e]) neighbours[from.edges[e].second].push_back(from.edges[e].first);
  }
  for (std::size_t e = 0; e < convex.size(); ++e) {
    if (convex[e]) neighbours[from.edges[e].first].push_back(from.edges[e].second);
  }
  const auto meet = [](const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
      if (a[i] == b[k]) return true;
      ++(a[i] < b[k] ? i : k);
    }
    return false;
  };
  std::vector<bool> kept(convex.size());
  for (std::size_t e = 0; e < convex.size(); ++e) {
    kept[e] = convex[e] && meet(neighbours[from.edges[e].first], neighbours[from.edges[e].second]);
  }
  return kept;
}

/// Joins the smallest segment that is too small to its largest neighbour, until there is none.
void join_small(const SupervoxelResult& from, std::size_t min_supervoxels, DisjointSets& sets) {
  const std::size_t count = from.supervoxels.size();
  std::vector<std::size_t> sizes(count, 0);                // size of a set, at its root
  std::vector<std::vector<std::uint32_t>> next_to(count);  // supervoxels adjacent to a set, and some of its own
  for (std::uint32_t s = 0; s < count; ++s) sizes[sets.root(s)] += 1;
  for (const auto& [first, second] : from.edges) {
    const std::uint32_t a = sets.root(first);
    const std::uint32_t b = sets.root(second);
    if (a == b) continue;
    next_to[a].push_back(second);
    next_to[b].push_back(first);
  }
  std::set<std::pair<std::size_t, std::uint32_t>> small;  // by size, then by root
  for (std::uint32_t s = 0; s < count; ++s) {
    if (sizes[s] > 0 && sizes[s] < min_supervoxels) small.emplace(sizes[s], s);
  }
  while (!small.empty()) {
    const std::uint32_t least = small.begin()->second;
    small.erase(small.begin());
    std::uint32_t largest{kUnlabelled};
    for (const std::uint32_t other : next_to[least]) {
      const std::uint32_t root = sets.root(other);
      if (root == least) continue;
      if (largest == kUnlabelled || sizes[root] > sizes[largest] || (sizes[root] == sizes[largest] && root < largest)) {
        largest = root;
      }
    }
    if (largest == kUnlabelled) continue;  // no neighbour
    small.erase({sizes[largest], largest});
    sets.join(least, largest);
    const std::uint32_t both = sets.root(least);
    const std::uint32_t gone = both == least ? largest : least;
    sizes[both] += sizes[gone];
    sizes[gone] = 0;
    if (next_to[both].size() < next_to[gone].size()) next_to[both].swap(next_to[gone]);
    next_to[both].insert(next_to[both].end(), next_to[gone].begin(), next_to[gone].end());
    next_to[gone].clear();
    if (sizes[both] < min_supervoxels) small.emplace(sizes[both], both);
  }
}

}  // namespace

Status LccpConfig::validate() const {
  for (const double number : {concavity_tolerance_rad, smoothness}) {
    if (!(std::isfinite(number) && number >= 0.0)) {
      return Error{Errc::invalid_argument, "a number is not finite, or negative", "LCCP"};
    }
  }
  return {};
}

bool is_convex(const Supervoxel& a, const Supervoxel& b, const LccpConfig& config, double voxel_size_m) {
  const Eigen::Vector3d n_a = a.normal.cast<double>();
  const Eigen::Vector3d n_b = b.normal.cast<double>();
  const Eigen::Vector3d between_m = (a.centroid_m - b.centroid_m).cast<double>();
  const double distance_m = between_m.norm();
  if (!(distance_m > 0.0)) return true;
  const Eigen::Vector3d d = between_m / distance_m;
  const double angle_rad = std::atan2(n_a.cross(n_b).norm(), n_a.dot(n_b));

  if (config.smooth) {
    // On an evenly curved surface a patch lies off the other's plane by half of this.
    const double bend_m = distance_m * (n_a - n_b).norm();
    const double step_m = std::min(std::abs(n_a.dot(between_m)), std::abs(n_b.dot(between_m)));
    if (step_m > bend_m + config.smoothness * voxel_size_m) return false;
  }
  if (config.sanity) {
    const Eigen::Vector3d crease = n_a.cross(n_b);
    const double between_rad = std::atan2(crease.cross(d).norm(), std::abs(crease.dot(d)));
    if (crease.norm() > 0.0 && between_rad < least_sane_angle_rad(angle_rad)) return false;
  }
  return angle_rad < config.concavity_tolerance_rad || n_a.dot(d) >= n_b.dot(d);
}

LccpResult join_convex(const SupervoxelResult& supervoxels, std::vector<bool> convex, const LccpConfig& config) {
  LccpResult result;
  result.convex = std::move(convex);
  if (config.extended_convexity) result.convex = with_common_neighbour(supervoxels, result.convex);

  DisjointSets sets{supervoxels.supervoxels.size()};
  for (std::size_t e = 0; e < supervoxels.edges.size(); ++e) {
    if (result.convex[e]) sets.join(supervoxels.edges[e].first, supervoxels.edges[e].second);
  }
  if (config.min_supervoxels > 1) join_small(supervoxels, config.min_supervoxels, sets);

  std::tie(result.segment_of, result.segments) = sets.numbered();
  result.labels = supervoxels.labels;
  for (std::uint32_t& label : result.labels) {
    if (label != kUnlabelled) label = result.segment_of[label];
  }
  return result;
}

Result<LccpResult> segment_by_convexity(const SupervoxelResult& supervoxels, const LccpConfig& config) {
  SACCADE_CHECK(config.validate());
  std::vector<bool> convex(supervoxels.edges.size());
  for (std::size_t e = 0; e < convex.size(); ++e) {
    const auto& [a, b] = supervoxels.edges[e];
    convex[e] = is_convex(supervoxels.supervoxels[a], supervoxels.supervoxels[b], config, supervoxels.voxel_size_m);
  }
  return join_convex(supervoxels, std::move(convex), config);
}

}  // namespace saccade
