// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/unknown_surfels.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "saccade/views/internal/surfel_frontier.hpp"

namespace saccade {
namespace {

/// Sum of the directions to the open neighbours of a voxel; nullopt where none is open. Opposite neighbours that are
/// both open give the first of the two.
std::optional<Eigen::Vector3f> towards_open(const StateVolume& volume, const Index3& voxel) {
  static constexpr std::array<Index3, 6> kSides{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  Eigen::Vector3f sum{Eigen::Vector3f::Zero()};
  std::optional<Eigen::Vector3f> first;
  for (const Index3& side : kSides) {
    const Index3 other = voxel + side;
    if (volume.box().contains(other) && volume[volume.index(other)] != VoxelState::empty) continue;
    const Eigen::Vector3f direction = Eigen::Vector3i{side.x, side.y, side.z}.cast<float>();
    sum += direction;
    if (!first) first = direction;
  }
  if (!first) return std::nullopt;
  return sum.squaredNorm() > 0.5F ? sum.normalized() : *first;
}

}  // namespace

Status UnknownSurfelConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "unknown surfels"}; };
  if (!(min_weight >= 0.0 && std::isfinite(min_weight))) return fail("the least weight must not be negative");
  if (!(seen_share > 0.0 && std::isfinite(seen_share))) return fail("the share of a voxel's face must be positive");
  return {};
}

std::vector<std::uint8_t> seen_voxels(const StateVolume& volume, const SurfelMap& surfels,
                                      const UnknownSurfelConfig& config) {
  std::vector<float> area_m2(volume.size());
  for (const SurfelDisc& disc : surfels.discs) {
    if (!(static_cast<double>(disc.weight) >= config.min_weight)) continue;
    const Index3 voxel = voxel_at(disc.position_m.cast<double>(), volume.voxel_size_m());
    if (volume.box().contains(voxel))
      area_m2[volume.index(voxel)] += std::numbers::pi_v<float> * disc.radius_m * disc.radius_m;
  }
  const auto enough_m2 = static_cast<float>(config.seen_share * volume.voxel_size_m() * volume.voxel_size_m());
  std::vector<std::uint8_t> seen(volume.size());
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = area_m2[i] >= enough_m2 ? 1 : 0;
  return seen;
}

std::vector<SurfelDisc> frontier_discs(const StateVolume& volume, const std::vector<std::uint8_t>& seen,
                                       const Executor& executor) {
  if (volume.size() == 0) return {};
  const double edge_m = volume.voxel_size_m();
  std::vector<std::vector<SurfelDisc>> layers(static_cast<std::size_t>(volume.box().size().z));
  executor.parallel_for(layers.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t layer = begin; layer < end; ++layer) {
      volume.box().layer(layer).for_each([&](const Index3& voxel) {
        const std::size_t i = volume.index(voxel);
        if (volume[i] != VoxelState::unknown || seen[i] != 0) return;
        const std::optional<Eigen::Vector3f> normal = towards_open(volume, voxel);
        if (!normal) return;
        SurfelDisc& disc = layers[layer].emplace_back();
        disc.position_m = voxel_center(voxel, edge_m).cast<float>() + static_cast<float>(0.5 * edge_m) * *normal;
        disc.radius_m = static_cast<float>(0.5 * std::numbers::sqrt3 * edge_m);
        disc.normal = *normal;
        disc.weight = kUnknownConfidence;
      });
    }
  });
  std::vector<SurfelDisc> discs;
  for (const std::vector<SurfelDisc>& layer : layers) discs.insert(discs.end(), layer.begin(), layer.end());
  return discs;
}

Result<std::vector<SurfelDisc>> unknown_surfels(const TsdfSnapshot& free_space, const SurfelMap& surfels,
                                                const UnknownSurfelConfig& config, const Executor& executor) {
  SACCADE_CHECK(config.validate());
  const IndexBox box = free_space.config.workspace
                           ? voxels_with_center_in(*free_space.config.workspace, free_space.config.voxel_size_m)
                           : free_space.grid.known_bounds();
  SACCADE_TRY(const StateVolume volume, StateVolume::read(free_space, box, executor));
  return frontier_discs(volume, seen_voxels(volume, surfels, config), executor);
}

}  // namespace saccade
