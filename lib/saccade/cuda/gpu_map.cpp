// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/gpu_map.hpp"

#include "saccade/core/clock.hpp"
#include "saccade/cuda/internal/cuda_compute.hpp"
#include "saccade/cuda/internal/gpu_fusion.hpp"
#include "saccade/cuda/internal/gpu_gain.hpp"
#include "saccade/cuda/internal/gpu_raycast.hpp"

namespace saccade {

using internal::cuda::BrickStore;
using internal::cuda::Compute;
using internal::cuda::GpuFusion;
using internal::cuda::GpuGain;
using internal::cuda::GpuRaycast;
using internal::cuda::HostCompute;

/// Members in the order of their lives: buffers go before the device does.
class GpuMap::Impl {
 public:
  Impl(const TsdfConfig& map_config, std::unique_ptr<Compute> device, std::string name)
      : config{map_config}, backend{std::move(name)}, compute{std::move(device)} {}

  TsdfConfig config;
  std::string backend;
  std::unique_ptr<Compute> compute;
  BrickStore bricks{*compute};
  GpuFusion fusion{*compute};
  GpuGain gain{*compute};
  GpuRaycast raycast{*compute};
};

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

const TsdfConfig& GpuMap::config() const { return impl_->config; }

Result<FusionStats> GpuMap::integrate(const PinholeCamera& camera, const DepthImage& depth,
                                      const Pose& T_world_camera) {
  return impl_->fusion.integrate(impl_->config, camera, depth, T_world_camera, impl_->bricks);
}

Status GpuMap::assign(const TsdfSnapshot& map) {
  SACCADE_CHECK(map.config.validate());
  impl_->config = map.config;
  return impl_->bricks.assign(map);
}

Result<TsdfSnapshot> GpuMap::snapshot() const { return impl_->bricks.snapshot(impl_->config); }

Result<SurfaceView> GpuMap::raycast(const PinholeCamera& camera, const Pose& T_world_camera) {
  return impl_->raycast.cast(impl_->config, camera, T_world_camera, impl_->bricks);
}

Result<GainResult> GpuMap::evaluate_views(const Region& region, std::span<const Pose> T_world_camera,
                                          const GainConfig& config, const Executor& executor) {
  SACCADE_TRY(GainResult result,
              impl_->gain.evaluate(impl_->config, region, T_world_camera, config, impl_->bricks, executor));
  result.backend = impl_->backend;
  return result;
}

}  // namespace saccade
