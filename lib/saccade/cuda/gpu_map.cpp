// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/gpu_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saccade/cuda/internal/cuda_compute.hpp"
#include "saccade/cuda/internal/gpu_map_impl.hpp"
#include "saccade/map/internal/frustum_box.hpp"
#include "saccade/views/internal/exposure.hpp"
#include "saccade/views/internal/gain_problem.hpp"
#include "saccade/views/internal/no_gain.hpp"

namespace saccade {

using internal::cuda::Compute;
using internal::cuda::GainTask;
using internal::cuda::HostCompute;

namespace {

constexpr IndexBox kNoBricks{};
constexpr IndexBox kAllBricks{{-(1 << 27), -(1 << 27), -(1 << 27)}, {1 << 27, 1 << 27, 1 << 27}};

/// Returns the bricks that rays from some poses to a region can meet.
IndexBox bricks_between(const TsdfConfig& config, const Region& region, std::span<const Pose> T_world_camera) {
  IndexBox voxels = region_in_workspace(region, config);
  for (const Pose& pose : T_world_camera) {
    voxels = voxels.hull(IndexBox::cube(voxel_at(pose.translation(), config.voxel_size_m), 1));
  }
  return voxels.empty() ? kNoBricks : parents(voxels).grown(1);
}

/// Returns the bricks that the rays of an image can meet, and their neighbours.
IndexBox bricks_in_view(const TsdfConfig& config, const PinholeCamera& camera, const Pose& T_world_camera) {
  if (!camera.validate().ok()) return kNoBricks;  // refused later
  const tsdf::FusionCamera seen_by{static_cast<float>(camera.fx),
                                   static_cast<float>(camera.fy),
                                   static_cast<float>(camera.cx),
                                   static_cast<float>(camera.cy),
                                   camera.width,
                                   camera.height,
                                   0.0F,
                                   0.0F};
  const double reach_m = camera.max_range_m * std::hypot(1.0, std::max(camera.cx, camera.width - camera.cx) / camera.fx,
                                                         std::max(camera.cy, camera.height - camera.cy) / camera.fy);
  const auto sectors = sectors_in_frustum(seen_by, T_world_camera, reach_m, config.voxel_size_m);
  if (!sectors.ok()) return kAllBricks;
  return IndexBox{sectors->lo * kSectorEdge, sectors->hi * kSectorEdge}.grown(1);
}

}  // namespace

GpuMap::GpuMap(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
GpuMap::GpuMap(GpuMap&&) noexcept = default;
GpuMap& GpuMap::operator=(GpuMap&&) noexcept = default;
GpuMap::~GpuMap() = default;

Result<GpuMap> GpuMap::create(const TsdfConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(std::unique_ptr<Compute> compute, internal::cuda::open_cuda());
  return GpuMap{std::make_unique<Impl>(config, std::move(compute), "cuda")};
}

Result<GpuMap> GpuMap::create_emulated(const TsdfConfig& config, const Executor& executor, std::size_t memory_bytes) {
  SACCADE_CHECK(config.validate());
  return GpuMap{std::make_unique<Impl>(config, std::make_unique<HostCompute>(executor, memory_bytes), "cuda emulated")};
}

const TsdfConfig& GpuMap::config() const { return impl_->bricks.config(); }
bool GpuMap::is_paged() const { return impl_->bricks.is_paged(); }
bool GpuMap::is_lost() const { return impl_->bricks.is_lost(); }
GpuTraffic GpuMap::traffic() const { return impl_->compute.traffic(); }

Result<FusionStats> GpuMap::integrate(const PinholeCamera& camera, const DepthImage& depth,
                                      const Pose& T_world_camera) {
  auto& bricks = impl_->bricks;
  SACCADE_CHECK(bricks.check());
  IndexBox seen;
  const auto bring_in = [&](const IndexBox& box) {
    seen = box;
    return bricks.bring_in(box);
  };
  const auto fuse = [&] {
    impl_->is_fusing = true;
    Result<FusionStats> fused =
        impl_->fusion.integrate(config(), camera, depth, T_world_camera, bricks.store(), bring_in);
    impl_->is_fusing = false;
    return fused;
  };
  Result<FusionStats> stats = fuse();
  const auto lacks_room = [&] {
    return !stats.ok() && !impl_->fusion.failed_halfway() && internal::cuda::is_no_room(stats.error());
  };
  if (lacks_room()) {
    impl_->free_scratch();
    stats = fuse();
  }
  if (lacks_room() && !seen.empty() && !bricks.is_paged_to(seen)) {
    if (bricks.is_paged()) SACCADE_CHECK(bricks.note_too_much());  // else the frame itself may have been too much
    SACCADE_CHECK(bricks.page_to(seen));
    stats = fuse();
  }
  if (impl_->fusion.failed_halfway()) bricks.lose();
  return stats;
}

Status GpuMap::assign(const TsdfSnapshot& map) { return follow(map, {}); }

Status GpuMap::follow(const TsdfSnapshot& map, const Executor& executor) {
  SACCADE_CHECK(map.config.validate());
  return impl_->noted(impl_->bricks.assign(map, executor));
}

Result<TsdfSnapshot> GpuMap::snapshot() const { return impl_->bricks.pull(); }

Result<SurfaceView> GpuMap::raycast(const PinholeCamera& camera, const Pose& T_world_camera) {
  return impl_->with_bricks(bricks_in_view(config(), camera, T_world_camera), [&] {
    return impl_->raycast.cast(config(), camera, T_world_camera, impl_->bricks.store());
  });
}

Status GpuMap::can_evaluate(const Region& region, const GainConfig& config) {
  return internal::cuda::check_gains(region, config);
}

Result<GainResult> GpuMap::evaluate_views(const Region& region, std::span<const Pose> T_world_camera,
                                          const GainConfig& config, const Executor& executor) {
  const TsdfConfig& map = this->config();
  SACCADE_CHECK(impl_->bricks.check());
  SACCADE_TRY(const GainTask task, internal::cuda::prepare_gains(map, region, T_world_camera, config, executor));
  SACCADE_TRY(GainResult result, impl_->with_bricks(bricks_between(map, region, T_world_camera),
                                                    [&] { return impl_->gain.count(task, impl_->bricks.store()); }));
  result.backend = impl_->backend;
  if (std::all_of(result.gains.begin(), result.gains.end(), [](std::uint64_t gain) { return gain == 0; })) {
    SACCADE_TRY(const TsdfSnapshot content, snapshot());
    result.no_gain = why_no_gain(content, region, T_world_camera, config);
  }
  return result;
}

Result<GainResult> GpuMap::evaluate_views_of(const TsdfSnapshot& map, const Region& region,
                                             std::span<const Pose> T_world_camera, const GainConfig& config,
                                             const Executor& executor) {
  SACCADE_CHECK(can_evaluate(region, config));
  SACCADE_CHECK(follow(map, executor));
  return impl_->noted(evaluate_views(region, T_world_camera, config, executor));
}

Result<std::uint64_t> GpuMap::read_states(const IndexBox& box, std::span<VoxelState> states) {
  if (box.empty()) return Error{Errc::invalid_argument, "a box without voxels has no states", "cuda"};
  return impl_->noted(impl_->with_bricks(parents(box), [&] {
    return impl_->surface.read_states(impl_->bricks.store(), config().voxel_size_m, box, states);
  }));
}

Result<std::vector<ExposedVoxel>> GpuMap::exposed(std::uint64_t ticket, const ExposureTask& task) {
  if (const Status there = impl_->noted(impl_->bricks.check()); !there.ok()) return there.error();
  return impl_->noted(impl_->surface.exposed(ticket, task));
}

Result<std::vector<std::uint8_t>> GpuMap::in_sight(std::uint64_t ticket, std::span<const LineOfSight> lines,
                                                   std::span<const Eigen::Vector3d> cameras_m, double through_m) {
  if (const Status there = impl_->noted(impl_->bricks.check()); !there.ok()) return there.error();
  return impl_->noted(impl_->surface.in_sight(ticket, lines, cameras_m, through_m));
}

std::optional<Error> GpuMap::take_problem() { return std::exchange(impl_->problem, std::nullopt); }

}  // namespace saccade
