// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/lccp.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "saccade/cloud/cell_index.hpp"
#include "saccade/segment/internal/supervoxel_growth.hpp"

namespace saccade {

namespace {

constexpr int kMostRounds{100};  // converged long before
constexpr double kMostReach{100.0};

/// Returns the number of the grid cell of each voxel, and the number of cells.
std::pair<std::vector<std::uint32_t>, std::size_t> seed_cells(const VoxelCloud& cloud, double spacing) {
  CellIndex index;
  std::vector<std::uint32_t> cell_of(cloud.voxels.size());
  for (std::size_t v = 0; v < cloud.voxels.size(); ++v) {
    cell_of[v] = index.insert(cell_at(cloud.voxels[v].place, spacing));
  }
  return {std::move(cell_of), index.cells().size()};
}

/// Labels every voxel: voxels that no seed reached in time continue to grow; connected parts without a seed become
/// supervoxels.
std::vector<std::uint32_t> with_rest(const VoxelCloud& cloud, SupervoxelGrowth::Grown grown) {
  std::vector<std::uint32_t>& labels = grown.labels;
  std::vector<std::uint32_t> rest;
  std::vector<std::uint32_t> front;
  for (std::uint32_t v = 0; v < labels.size(); ++v) {
    if (labels[v] != kUnlabelled) continue;
    rest.push_back(v);
    for (const std::uint32_t other : cloud.neighbours(v)) {
      if (labels[other] != kUnlabelled) front.push_back(other);
    }
  }
  std::sort(front.begin(), front.end());
  front.erase(std::unique(front.begin(), front.end()), front.end());
  const auto spread = [&] {
    for (std::size_t next = 0; next < front.size(); ++next) {
      for (const std::uint32_t other : cloud.neighbours(front[next])) {
        if (labels[other] != kUnlabelled) continue;
        labels[other] = labels[front[next]];
        front.push_back(other);
      }
    }
    front.clear();
  };
  spread();
  auto seeds = static_cast<std::uint32_t>(grown.seeds.size());
  for (const std::uint32_t v : rest) {
    if (labels[v] != kUnlabelled) continue;
    labels[v] = seeds++;
    front.push_back(v);
    spread();
  }
  return std::move(labels);
}

std::vector<Supervoxel> summarise(const VoxelCloud& cloud, const std::vector<std::uint32_t>& labels) {
  const std::size_t count = labels.empty() ? 0 : std::size_t{1} + *std::max_element(labels.begin(), labels.end());
  std::vector<Supervoxel> supervoxels(count);
  std::vector<Eigen::Matrix<double, 9, 1>> sums(count, Eigen::Matrix<double, 9, 1>::Zero());
  for (std::size_t v = 0; v < labels.size(); ++v) {
    const CloudVoxel& voxel = cloud.voxels[v];
    sums[labels[v]].head<3>() += voxel.position_m.cast<double>();
    sums[labels[v]].segment<3>(3) += voxel.normal.cast<double>();
    sums[labels[v]].tail<3>() += voxel.color.cast<double>();
    supervoxels[labels[v]].voxels += 1;
    supervoxels[labels[v]].points += voxel.points;
  }
  for (std::size_t s = 0; s < count; ++s) {
    const Eigen::Matrix<double, 9, 1> mean = sums[s] / static_cast<double>(supervoxels[s].voxels);
    supervoxels[s].centroid_m = mean.head<3>().cast<float>();
    supervoxels[s].normal = mean.segment<3>(3).normalized().cast<float>();
    supervoxels[s].color = mean.tail<3>().cast<float>();
  }
  return supervoxels;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> touching(const VoxelCloud& cloud,
                                                              const std::vector<std::uint32_t>& labels) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t v = 0; v < labels.size(); ++v) {
    for (const std::uint32_t other : cloud.neighbours(v)) {
      const std::pair edge{labels[v], labels[other]};
      if (edge.first < edge.second && (edges.empty() || edges.back() != edge)) edges.push_back(edge);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

Status SupervoxelConfig::validate() const {
  SACCADE_CHECK(voxels.validate());
  const auto error = [](const char* message) { return Error{Errc::invalid_argument, message, "supervoxels"}; };
  for (const double number : {seed_spacing_m, spatial_weight, normal_weight, color_weight, min_seed_share, reach}) {
    if (!(std::isfinite(number) && number >= 0.0)) return error("a number is not finite, or negative");
  }
  if (spatial_weight + normal_weight + color_weight == 0.0) return error("all weights are zero");
  if (seed_spacing_m < voxels.voxel_size_m) return error("seed_spacing_m must be at least voxel_size_m");
  if (reach > kMostReach) return error("reach must be at most 100");
  if (rounds < 1 || rounds > kMostRounds) return error("rounds must be from 1 to 100");
  return {};
}

double SupervoxelConfig::fewest_around_seed(double spacing_vox) const {
  return min_seed_share * std::numbers::pi * 0.25 * spacing_vox * spacing_vox;
}

Result<SupervoxelResult> find_supervoxels(const PointCloud& cloud, const SupervoxelConfig& config,
                                          const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(const VoxelCloud voxels, voxelise(cloud, config.voxels, executor));
  const double spacing_vox = config.seed_spacing_m / config.voxels.voxel_size_m;
  const auto [cell_of, cells] = seed_cells(voxels, config.seed_spacing_m);
  SupervoxelGrowth growth{voxels, config};
  growth.seed(cell_of, cells, 0.5 * config.seed_spacing_m, config.fewest_around_seed(spacing_vox), executor);
  const double steps = config.reach * spacing_vox;
  SupervoxelGrowth::Grown grown = growth.grow(steps);
  for (int round = 1; round < config.rounds; ++round) {
    growth.move_to_means(grown);
    grown = growth.grow(steps);
  }
  const std::vector<std::uint32_t> labels = with_rest(voxels, std::move(grown));
  SupervoxelResult result;
  result.supervoxels = summarise(voxels, labels);
  result.edges = touching(voxels, labels);
  result.voxels = voxels.voxels.size();
  result.voxel_size_m = config.voxels.voxel_size_m;
  result.labels = voxels.voxel_of;
  for (std::uint32_t& label : result.labels) {
    if (label != kUnlabelled) label = labels[label];
  }
  return result;
}

}  // namespace saccade
