// SPDX-License-Identifier: Apache-2.0
#include "compute_backend.hpp"

#include <nlohmann/json.hpp>

#include "saccade/cuda/device.hpp"

namespace saccade::cli {
namespace {

Result<GainResult> evaluate_on_gpu(const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                                   const GainConfig& config, const Executor& executor) {
  SACCADE_CHECK(GpuMap::can_evaluate(region, config));  // before a GPU is opened in vain
  SACCADE_TRY(GpuMap gpu, GpuMap::create(map.config));
  SACCADE_CHECK(gpu.assign(map));
  return gpu.evaluate_views(region, T_world_camera, config, executor);
}

/// Opens what a GPU does for a map.
template <class Device>
Result<std::unique_ptr<Device>> opened(ComputeBackend backend, const TsdfConfig& config,
                                       std::optional<Error>& problem) {
  std::unique_ptr<Device> device;
  if (backend == ComputeBackend::cpu) return device;
  Result<Device> gpu = Device::create(config);
  if (gpu.ok()) {
    device = std::make_unique<Device>(std::move(gpu).value());
  } else if (backend == ComputeBackend::cuda) {
    return gpu.error();
  } else if (cuda_device().ok()) {
    problem = gpu.error();
  }
  return device;
}

}  // namespace

Result<std::unique_ptr<GpuMap>> gpu_map_on(ComputeBackend backend, const TsdfConfig& config,
                                           std::optional<Error>& problem) {
  return opened<GpuMap>(backend, config, problem);
}

Result<std::unique_ptr<GpuTracker>> gpu_tracker_on(ComputeBackend backend, const TsdfConfig& config,
                                                   std::optional<Error>& problem) {
  return opened<GpuTracker>(backend, config, problem);
}

nlohmann::json compute_json(ComputeBackend wanted, bool gpu_worked, const std::optional<Error>& problem) {
  return {{"wanted", kComputeBackendNames.of(wanted)},
          {"used", !gpu_worked ? "cpu"
                   : problem   ? "mixed"
                               : "cuda"},
          {"problem", problem ? nlohmann::json(problem->message) : nlohmann::json(nullptr)}};
}

Result<GainResult> evaluate_views_on(ComputeBackend backend, const TsdfSnapshot& map, const Region& region,
                                     std::span<const Pose> T_world_camera, const GainConfig& config,
                                     const Executor& executor, const Progress& progress,
                                     std::optional<Error>& problem) {
  if (backend != ComputeBackend::cpu) {
    Result<GainResult> result = evaluate_on_gpu(map, region, T_world_camera, config, executor);
    if (result.ok() || backend == ComputeBackend::cuda) return result;
    if (result.error().code == Errc::unavailable && cuda_device().ok()) problem = result.error();
  }
  return evaluate_views(map, region, T_world_camera, config, executor, progress);
}

}  // namespace saccade::cli
