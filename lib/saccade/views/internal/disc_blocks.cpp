// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/disc_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "saccade/map/voxel_index.hpp"

namespace saccade {
namespace {

struct Placed {
  std::uint64_t cell;  ///< sorts as zyx_less does
  std::uint32_t id;
};

/// Returns the place of a cell in their order; cells farther out than 2²⁰ along an axis count as the outermost.
std::uint64_t key_of(const Index3& cell) {
  constexpr std::int32_t kHalf{1 << 20};
  const auto part = [](std::int32_t i) { return static_cast<std::uint64_t>(std::clamp(i, -kHalf, kHalf - 1) + kHalf); };
  return part(cell.z) << 42 | part(cell.y) << 21 | part(cell.x);
}

/// Returns the ids of discs, sorted by their cells and then by id.
template <class Wanted>
std::vector<Placed> by_cell(std::span<const SurfelDisc> discs, double cell_m, const Wanted& wanted) {
  std::vector<Placed> placed;
  placed.reserve(discs.size());
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (wanted(discs[i]))
      placed.push_back({key_of(voxel_at(discs[i].position_m.cast<double>(), cell_m)), static_cast<std::uint32_t>(i)});
  }
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.cell != b.cell ? a.cell < b.cell : a.id < b.id; });
  return placed;
}

}  // namespace

std::vector<SurfelDisc> thinned_discs(const SurfelMap& surfels, double min_weight, double cell_m) {
  const std::span<const SurfelDisc> all{surfels.discs.data(), surfels.discs.size()};
  const auto is_heavy = [&](const SurfelDisc& disc) { return static_cast<double>(disc.weight) >= min_weight; };
  const std::vector<Placed> placed = by_cell(all, cell_m, is_heavy);
  const auto least_radius_m = static_cast<float>(0.5 * std::numbers::sqrt3 * cell_m);
  std::vector<SurfelDisc> kept;
  for (std::size_t begin = 0, end = 0; begin < placed.size(); begin = end) {
    std::uint32_t heaviest = placed[begin].id;
    for (end = begin; end < placed.size() && placed[end].cell == placed[begin].cell; ++end) {
      if (all[placed[end].id].weight > all[heaviest].weight) heaviest = placed[end].id;
    }
    kept.push_back(all[heaviest]);
    kept.back().radius_m = std::max(kept.back().radius_m, least_radius_m);
  }
  return kept;
}

ViewCone ViewCone::around(const Eigen::Vector3f& apex_m, std::span<const Eigen::Vector3f> points_m, float margin_rad) {
  ViewCone cone{apex_m, Eigen::Vector3f::Zero(), 0.0F, 0.0F};
  for (const Eigen::Vector3f& point : points_m) cone.axis += (point - apex_m).stableNormalized();
  if (!(cone.axis.squaredNorm() > 1e-6F)) cone.axis = Eigen::Vector3f::UnitZ();
  cone.axis.normalize();
  float least_cosine{1.0F};
  for (const Eigen::Vector3f& point : points_m) {
    least_cosine = std::min(least_cosine, cone.axis.dot((point - apex_m).stableNormalized()));
    cone.reach_m = std::max(cone.reach_m, (point - apex_m).norm());
  }
  cone.half_angle_rad = std::acos(std::clamp(least_cosine, -1.0F, 1.0F)) + margin_rad;
  return cone;
}

bool ViewCone::misses(const Eigen::Vector3f& middle_m, float radius_m) const {
  const Eigen::Vector3f towards = middle_m - apex_m;
  const float distance_m = towards.norm();
  if (distance_m <= radius_m) return false;
  // Depths are measured along axes, and a depth is up to √3 times less than a distance.
  if (distance_m - radius_m > std::numbers::sqrt3_v<float> * reach_m) return true;
  const float angle_rad = std::acos(std::clamp(axis.dot(towards) / distance_m, -1.0F, 1.0F));
  return angle_rad > half_angle_rad + std::asin(radius_m / distance_m);
}

DiscBlocks::DiscBlocks(std::vector<SurfelDisc> discs, double block_m) {
  const std::vector<Placed> placed = by_cell(discs, block_m, [](const SurfelDisc&) { return true; });
  discs_.reserve(discs.size());
  for (std::size_t begin = 0, end = 0; begin < placed.size(); begin = end) {
    Block block{begin, 0, Eigen::Vector3f::Zero(), 0.0F};
    for (end = begin; end < placed.size() && placed[end].cell == placed[begin].cell; ++end) {
      discs_.push_back(discs[placed[end].id]);
    }
    block.count = end - begin;
    for (std::size_t i = begin; i < end; ++i) {
      block.middle_m += discs_[i].position_m / static_cast<float>(block.count);
    }
    for (std::size_t i = begin; i < end; ++i) {
      block.radius_m = std::max(block.radius_m, (discs_[i].position_m - block.middle_m).norm() + discs_[i].radius_m);
    }
    blocks_.push_back(block);
  }
}

}  // namespace saccade
