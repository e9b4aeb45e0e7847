// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/volumetric_gain.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "saccade/map/ray_walk.hpp"
#include "saccade/views/internal/check_finite.hpp"
#include "saccade/views/internal/ray_information.hpp"
#include "saccade/views/sensor_rays.hpp"

namespace saccade {
namespace {

/// States that rays meet, and the bricks with only empty voxels.
struct RayMap {
  const BaselineScene* scene;
  std::vector<float> distance_vox;  ///< per counted voxel; empty: not needed
  IndexBox bricks;
  std::vector<std::uint8_t> is_empty;  ///< per brick, x fastest

  [[nodiscard]] static std::size_t index_in(const IndexBox& box, const Index3& i) {
    const Index3 at = i - box.lo;
    const Index3 size = box.size();
    return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(at.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(at.x);
  }
  [[nodiscard]] bool brick_is_empty(const Index3& brick) const { return is_empty[index_in(bricks, brick)] != 0; }
  /// Returns d_max − d relative to d_max.
  [[nodiscard]] double proximity(const Index3& voxel, double reach_vox) const {
    if (distance_vox.empty()) return 0.0;
    return 1.0 - std::min(1.0, static_cast<double>(distance_vox[index_in(scene->counted, voxel)]) / reach_vox);
  }
};

std::vector<std::uint8_t> empty_bricks(const StateVolume& volume, const IndexBox& bricks, const Executor& executor) {
  std::vector<std::uint8_t> is_empty(static_cast<std::size_t>(bricks.count()), 1);
  executor.parallel_for(static_cast<std::size_t>(bricks.size().z), 1, [&](std::size_t layer, std::size_t) {
    bricks.layer(layer).for_each([&](const Index3& brick) {
      std::uint8_t& empty = is_empty[RayMap::index_in(bricks, brick)];
      IndexBox::cube(brick * kBrickEdge, kBrickEdge).intersection(volume.box()).for_each([&](const Index3& voxel) {
        if (volume[volume.index(voxel)] != VoxelState::empty) empty = 0;
      });
    });
  });
  return is_empty;
}

double steps_between(const Index3& a, const Index3& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
}

/// Follows one ray from where it enters the workspace to where it leaves the counted box.
template <VolumetricInformation kMetric>
void follow(const LatticeRay& ray, const RayMap& map, const PinholeCamera& camera, double reach_vox,
            RayInformation<kMetric>& told) {
  const StateVolume& volume = map.scene->volume;
  const RayEvent end = after_depth(static_cast<float>(camera.max_range_m));
  const RaySpan counted = clip(ray, map.scene->counted).until(end);
  if (counted.empty()) return;
  const RaySpan span = clip(ray, volume.box()).until(counted.exit);
  if (span.empty()) return;
  const Index3 first = voxel_at_event(ray, counted.enter);
  const auto min_range_m = static_cast<float>(camera.min_range_m);
  told.begin_ray();
  VoxelState before = VoxelState::unknown;  // state of the voxel passed last; outside the workspace nothing is known
  bool outside = true;
  walk_cells<kBrickLevel>(ray, span, [&](const Index3& brick, const RaySpan& in_brick) {
    if (map.brick_is_empty(brick)) {
      before = VoxelState::empty;
      outside = false;
      return false;
    }
    return walk_cells<kVoxelLevel>(ray, in_brick, [&](const Index3& voxel, const RaySpan& in_voxel) {
      const VoxelState state = volume[volume.index(voxel)];
      const bool after_unknown = before == VoxelState::unknown && !outside;
      const bool after_empty = before == VoxelState::empty;
      before = state;
      outside = false;
      if (state == VoxelState::empty) return false;
      const bool counts = in_voxel.enter.t >= min_range_m && map.scene->counts(voxel);
      if (state == VoxelState::occupied) {
        told.meet_occupied(counts, after_unknown, steps_between(first, voxel) + 1.0);
        return true;
      }
      return told.meet_unknown(counts, after_unknown, after_empty, counts ? map.proximity(voxel, reach_vox) : 0.0);
    });
  });
}

template <VolumetricInformation kMetric>
std::vector<double> informations(const RayMap& map, const PinholeCamera& camera, std::span<const Pose> T_world_camera,
                                 const Executor& executor) {
  const StateVolume& volume = map.scene->volume;
  const double reach_vox = kProximity_m / volume.voxel_size_m();
  std::vector<double> values(T_world_camera.size(), 0.0);
  std::vector<double> of_box(kMetric == VolumetricInformation::area_factor ? values.size() : 0, 0.0);
  executor.parallel_for(values.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (map.scene->is_blocked(T_world_camera[i].translation())) continue;
      const SensorRays rays = sensor_rays(T_world_camera[i], volume.voxel_size_m());
      RayInformation<kMetric> told;
      for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
          follow<kMetric>(pixel_ray(rays, camera, u, v), map, camera, reach_vox, told);
        }
      }
      values[i] = told.value(static_cast<double>(camera.width) * camera.height);
      if (!of_box.empty()) of_box[i] = told.value(told.rays_in_box());
    }
  });
  const bool none = std::none_of(values.begin(), values.end(), [](double value) { return value > 0.0; });
  return none && !of_box.empty() ? of_box : values;
}

}  // namespace

VolumetricGain::VolumetricGain(VolumetricInformation information, const BaselineGainConfig& config)
    : information_{information}, config_{config} {
  SACCADE_EXPECTS(config.validate().ok());
}

Result<std::vector<double>> VolumetricGain::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) {
  return evaluate_with(sampled_camera(config_), context, region, T_world_camera);
}

Result<RankedViews> VolumetricGain::best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) {
  const std::size_t fine = std::max(kFineViews, 4 * std::min(count, T_world_camera.size()));
  if (fine >= T_world_camera.size()) return Gain::best(context, region, T_world_camera, count);
  BaselineGainConfig coarse = config_;
  coarse.columns_px = std::max(1, config_.columns_px / kCoarser);
  SACCADE_TRY(const std::vector<double> gains, evaluate_with(sampled_camera(coarse), context, region, T_world_camera));
  std::vector<RankedView> others;
  std::vector<Pose> chosen;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    if (context.was_attempted(T_world_camera[i])) {
      chosen.push_back(T_world_camera[i]);
    } else {
      others.push_back({T_world_camera[i], gains[i]});
    }
  }
  order_by_gain(others);
  for (std::size_t i = 0; i < std::min(fine, others.size()); ++i) chosen.push_back(others[i].T_world_camera);
  SACCADE_TRY(RankedViews ranked, Gain::best(context, region, chosen, count));
  ranked.evaluated = T_world_camera.size();
  ranked.complete = others.size() <= fine;
  return ranked;
}

Result<std::vector<double>> VolumetricGain::evaluate_with(const PinholeCamera& camera, const PlanningContext& context,
                                                          const RegionOfInterest& region,
                                                          std::span<const Pose> T_world_camera) const {
  using enum VolumetricInformation;
  SACCADE_CHECK(check_finite(T_world_camera, "baseline gain"));
  SACCADE_TRY(const BaselineScene scene, read_baseline_scene(context, region, config_.object_margin_m));
  if (scene.counted.empty()) return std::vector<double>(T_world_camera.size(), 0.0);
  RayMap map{&scene, {}, parents(scene.volume.box()), {}};
  map.is_empty = empty_bricks(scene.volume, map.bricks, context.executor);
  if (information_ == proximity_count) {
    const auto reach_vox = static_cast<float>(kProximity_m / scene.volume.voxel_size_m());
    map.distance_vox = distance_to_occupied(scene.volume, scene.counted, reach_vox);
  }
  const auto of = [&]<VolumetricInformation kMetric>() {
    return informations<kMetric>(map, camera, T_world_camera, context.executor);
  };
  switch (information_) {
    case occlusion_aware: return of.operator()<occlusion_aware>();
    case unobserved_voxel: return of.operator()<unobserved_voxel>();
    case rear_side_voxel: return of.operator()<rear_side_voxel>();
    case rear_side_entropy: return of.operator()<rear_side_entropy>();
    case proximity_count: return of.operator()<proximity_count>();
    case average_entropy: return of.operator()<average_entropy>();
    case area_factor: break;
  }
  return of.operator()<area_factor>();
}

std::vector<float> distance_to_occupied(const StateVolume& volume, const IndexBox& box, float beyond_vox) {
  std::vector<float> distances(static_cast<std::size_t>(box.count()), beyond_vox);
  std::size_t next{0};
  box.for_each([&](const Index3& voxel) {
    if (volume[volume.index(voxel)] == VoxelState::occupied) distances[next] = 0.0F;
    ++next;
  });
  const Index3 size = box.size();
  const std::int32_t rows = size.x;
  const std::int32_t layers = size.x * size.y;
  // Two sweeps, forwards and backwards; each relaxes the distances from the 13 preceding neighbours.
  for (const std::int32_t ahead : {1, -1}) {
    const auto at = [ahead](std::int32_t i, std::int32_t count) { return ahead > 0 ? i : count - 1 - i; };
    for (std::int32_t k = 0; k < size.z; ++k) {
      for (std::int32_t j = 0; j < size.y; ++j) {
        for (std::int32_t i = 0; i < size.x; ++i) {
          const Index3 p{at(i, size.x), at(j, size.y), at(k, size.z)};
          float& here = distances[static_cast<std::size_t>(p.z * layers + p.y * rows + p.x)];
          for (std::int32_t n = 0; n < 13; ++n) {
            const Index3 step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
            const Index3 q = p + step * ahead;
            if (q.x < 0 || q.y < 0 || q.z < 0 || q.x >= size.x || q.y >= size.y || q.z >= size.z) continue;
            const float length = std::sqrt(static_cast<float>(step.x * step.x + step.y * step.y + step.z * step.z));
            here = std::min(here, distances[static_cast<std::size_t>(q.z * layers + q.y * rows + q.x)] + length);
          }
        }
      }
    }
  }
  return distances;
}

std::shared_ptr<Gain> volumetric_gain(VolumetricInformation information, const BaselineGainConfig& config) {
  return std::make_shared<VolumetricGain>(information, config);
}

}  // namespace saccade
