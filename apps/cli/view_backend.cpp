// SPDX-License-Identifier: Apache-2.0
#include "view_backend.hpp"

#include "saccade/cuda/gpu_map.hpp"

namespace saccade::cli {
namespace {

Result<GainResult> evaluate_on_gpu(const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                                   const GainConfig& config, const Executor& executor) {
  SACCADE_CHECK(GpuMap::can_evaluate(region, config));  // before a GPU is opened in vain
  SACCADE_TRY(GpuMap gpu, GpuMap::create(map.config));
  SACCADE_CHECK(gpu.assign(map));
  return gpu.evaluate_views(region, T_world_camera, config, executor);
}

}  // namespace

Result<std::unique_ptr<SurfaceDevice>> surface_device_on(ViewBackend backend, const TsdfConfig& config) {
  std::unique_ptr<SurfaceDevice> device;
  if (backend == ViewBackend::cpu) return device;
  Result<GpuMap> gpu = GpuMap::create(config);
  if (!gpu.ok()) {
    if (backend == ViewBackend::cuda) return gpu.error();
    return device;
  }
  device = std::make_unique<GpuMap>(std::move(gpu).value());
  return device;
}

Result<GainResult> evaluate_views_on(ViewBackend backend, const TsdfSnapshot& map, const Region& region,
                                     std::span<const Pose> T_world_camera, const GainConfig& config,
                                     const Executor& executor, const Progress& progress) {
  if (backend != ViewBackend::cpu) {
    Result<GainResult> result = evaluate_on_gpu(map, region, T_world_camera, config, executor);
    if (result.ok() || backend == ViewBackend::cuda) return result;
  }
  return evaluate_views(map, region, T_world_camera, config, executor, progress);
}

}  // namespace saccade::cli
