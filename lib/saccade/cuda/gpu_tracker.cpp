// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/gpu_tracker.hpp"

#include <utility>

namespace saccade {

Result<GpuTracker> GpuTracker::create(const TsdfConfig& config) {
  SACCADE_TRY(GpuMap map, GpuMap::create(config));
  SACCADE_TRY(GpuAligner aligner, GpuAligner::create());
  return GpuTracker{std::move(map), std::move(aligner)};
}

Result<GpuTracker> GpuTracker::create_emulated(const TsdfConfig& config, const Executor& executor,
                                               std::size_t memory_bytes) {
  SACCADE_TRY(GpuMap map, GpuMap::create_emulated(config, executor, memory_bytes));
  SACCADE_TRY(GpuAligner aligner, GpuAligner::create_emulated(executor));
  return GpuTracker{std::move(map), std::move(aligner)};
}

/// Takes note of what the device did or could not do, of its loss once. What the caller asked wrongly is neither.
template <class T>
Result<T> GpuTracker::noted(Result<T> result) {
  if (result.ok()) {
    ++answered_;
    return result;
  }
  const Errc code = result.error().code;
  if (code == Errc::invalid_argument || code == Errc::unsupported || told_loss_) return result;
  problem_ = result.error();
  told_loss_ = map_.is_lost();
  return result;
}

Result<SurfaceView> GpuTracker::raycast(const TsdfSnapshot& map, const PinholeCamera& camera,
                                        const Pose& T_world_camera, const Executor& executor) {
  const auto cast = [&]() -> Result<SurfaceView> {
    SACCADE_CHECK(map_.follow(map, executor));
    return map_.raycast(camera, T_world_camera);
  };
  return noted(cast());
}

Result<IcpResult> GpuTracker::align(const PointImage& measured, const PointImage& model, const PinholeCamera& camera,
                                    const Pose& T_model_camera_start, const IcpConfig& config) {
  if (map_.is_lost()) return Error{Errc::unavailable, "the GPU is lost", "cuda"};
  return noted(aligner_.align(measured, model, camera, T_model_camera_start, config));
}

std::optional<Error> GpuTracker::take_problem() { return std::exchange(problem_, std::nullopt); }

}  // namespace saccade
