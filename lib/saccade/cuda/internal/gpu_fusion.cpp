// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/gpu_fusion.hpp"

#include <algorithm>
#include <array>

#include "saccade/core/clock.hpp"
#include "saccade/map/internal/frame_check.hpp"
#include "saccade/map/internal/frustum_box.hpp"

namespace saccade::internal::cuda {
namespace {

FusionArguments fusion_arguments(const TsdfConfig& config, const PinholeCamera& camera, const Pose& T_world_camera) {
  FusionArguments a{};
  a.camera = {static_cast<float>(camera.fx),
              static_cast<float>(camera.fy),
              static_cast<float>(camera.cx),
              static_cast<float>(camera.cy),
              camera.width,
              camera.height,
              static_cast<float>(config.truncation_m()),
              static_cast<float>(1.0 / config.truncation_m())};
  a.min_range_m = static_cast<float>(std::max(camera.min_range_m, 1e-6));
  a.max_range_m = static_cast<float>(camera.max_range_m);
  a.voxel_size_m = config.voxel_size_m;
  const Pose T_camera_world = T_world_camera.inverse();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) a.T_camera_world[row][column] = T_camera_world.matrix()(row, column);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = T_camera_world.linear().col(axis) * config.voxel_size_m;
    a.steps[axis] = {static_cast<float>(step.x()), static_cast<float>(step.y()), static_cast<float>(step.z())};
  }
  a.max_weight = config.max_weight;
  a.free_weight = config.free_weight;
  a.clearing_share = config.clearing_share();
  return a;
}

}  // namespace

Result<FusionStats> GpuFusion::integrate(const TsdfConfig& config, const PinholeCamera& camera, const DepthImage& depth,
                                         const Pose& T_world_camera, BrickStore& bricks, const BringIn& bring_in) {
  began_ = false;
  SACCADE_CHECK(check_frame(camera, depth, T_world_camera, nullptr));
  const Stopwatch stopwatch;
  SACCADE_CHECK(depths_m_.assign({depth.data(), depth.size()}));
  SACCADE_CHECK(ranges_m_.reserve(depth.size()));
  std::array<std::uint32_t, kCounters> counts{};
  SACCADE_CHECK(counters_.reserve(kCounters));
  SACCADE_CHECK(counters_.fill(0, kCounters));

  FusionArguments a = fusion_arguments(config, camera, T_world_camera);
  a.depths_m = depths_m_.data();
  a.ranges_m = ranges_m_.data();
  const std::size_t tiles = std::size_t{pixel_tiles(camera.width)} * pixel_tiles(camera.height);
  SACCADE_CHECK(tile_reach_.reserve(tiles));
  SACCADE_CHECK(tile_clear_.reserve(tiles));
  a.tile_reach = tile_reach_.data();
  a.tile_clear = tile_clear_.data();
  a.reach = counters_.data() + kReach;
  a.valid = counters_.data() + kValid;
  a.in_view_count = counters_.data() + kInView;
  a.without_slot = counters_.data() + kWithoutSlot;
  a.new_slots = counters_.data() + kNewSlots;
  a.updated = counters_.data() + kUpdated;
  SACCADE_CHECK(launch<FindRanges>(compute_, tiles, a));
  SACCADE_CHECK(counters_.read(counts));
  FusionStats stats;
  stats.valid_pixels = counts[kValid];
  const double reach_m = static_cast<double>(as_float(counts[kReach]));
  if (reach_m > 0.0) {
    SACCADE_TRY(const IndexBox sectors, sectors_in_frustum(a.camera, T_world_camera, reach_m, config.voxel_size_m));
    const IndexBox candidates{sectors.lo * kSectorEdge, sectors.hi * kSectorEdge};
    if (bring_in) SACCADE_CHECK(bring_in(candidates));
    SACCADE_CHECK(bricks.cover(candidates));
    const Index3 size = candidates.size();
    a.candidates = {candidates.lo, static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y),
                    static_cast<std::uint32_t>(size.z)};
    SACCADE_CHECK(in_view_.reserve(a.candidates.count()));
    a.in_view = in_view_.data();
    a.map = bricks.view();
    SACCADE_CHECK(launch<FindBricksInView>(compute_, blocks_for<FindBricksInView>(a.candidates.count()), a));
    SACCADE_CHECK(counters_.read(counts));
    SACCADE_CHECK(bricks.reserve_slots(counts[kWithoutSlot]));  // each of these takes one at most
    SACCADE_CHECK(bricks.reserve_pull());
    a.map = bricks.view();
    a.slots = static_cast<std::uint32_t>(bricks.slots());
    a.first_slot = static_cast<std::uint32_t>(bricks.used_slots());
    const Status started = launch<FuseBricks>(compute_, counts[kInView], a);
    began_ = started.ok() || !is_no_room(started.error());  // a kernel without room for itself does not start
    if (!started) return started.error();
    SACCADE_CHECK(counters_.read(counts));  // waits for the kernels
    bricks.set_used_slots(bricks.used_slots() + counts[kNewSlots]);
    bricks.changed();
    stats.bricks_updated = counts[kUpdated];
  }
  began_ = false;
  stats.ms = stopwatch.elapsed_ms();
  return stats;
}

void GpuFusion::free_buffers() noexcept {
  depths_m_.free();
  ranges_m_.free();
  tile_reach_.free();
  tile_clear_.free();
  counters_.free();
  in_view_.free();
}

}  // namespace saccade::internal::cuda
