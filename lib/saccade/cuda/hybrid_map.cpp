// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/hybrid_map.hpp"

namespace saccade {
namespace {

bool same_workspace(const TsdfConfig& a, const TsdfConfig& b) {
  if (!a.workspace || !b.workspace) return a.workspace.has_value() == b.workspace.has_value();
  return a.workspace->min == b.workspace->min && a.workspace->max == b.workspace->max;
}
/// Tells whether two maps hold the same after the same images. Colours are not fused in either.
bool same_map(const TsdfConfig& a, const TsdfConfig& b) {
  return a.voxel_size_m == b.voxel_size_m && a.truncation_vox == b.truncation_vox && a.max_weight == b.max_weight &&
         a.free_weight == b.free_weight && a.clearing_percent == b.clearing_percent && same_workspace(a, b);
}

}  // namespace

Result<HybridMap> HybridMap::create(const TsdfConfig& config, std::optional<GpuMap> gpu) {
  SACCADE_TRY(TsdfMap map, TsdfMap::create(config));
  if (gpu && !same_map(gpu->config(), config)) {
    return Error{Errc::invalid_argument, "the map on the GPU has another configuration", "cuda"};
  }
  if (gpu) {
    SACCADE_TRY(TsdfSnapshot content, gpu->snapshot());
    if (!content.grid.empty()) map = TsdfMap{TsdfSnapshot{config, std::move(content.grid)}};
  }
  return HybridMap{std::move(map), std::move(gpu)};
}

void HybridMap::leave_if_lost() {
  if (const std::optional<Error> problem = gpu_->take_problem()) problem_ = problem->message;
  if (!gpu_->is_lost()) return;
  if (problem_.empty()) problem_ = "the GPU was lost";
  gpu_.reset();
}

Status HybridMap::catch_up(const Executor& executor) {
  if (!gpu_) return {};
  if (frames_.empty()) {
    leave_if_lost();
    return {};
  }
  if (Result<TsdfSnapshot> content = gpu_->snapshot(); content.ok()) {
    cpu_ = TsdfMap{std::move(content).value()};
  } else {
    problem_ = content.error().message;
    gpu_.reset();
    for (const FusedFrame& frame : frames_)
      SACCADE_CHECK(cpu_.integrate(frame.camera, frame.depth, frame.T_world_camera, executor));
  }
  frames_.clear();
  return {};
}

template <class OnGpu, class OnCpu>
auto HybridMap::step(const OnGpu& on_gpu, const OnCpu& on_cpu, const Executor& executor) -> decltype(on_cpu()) {
  if (gpu_) {
    auto result = on_gpu();
    const bool failed =
        !result.ok() && (result.error().code == Errc::unavailable || result.error().code == Errc::unsupported);
    if (!failed) return result;
    problem_ = result.error().message;
  }
  SACCADE_CHECK(catch_up(executor));
  return on_cpu();
}

Result<FusionStats> HybridMap::integrate(const PinholeCamera& camera, const DepthImage& depth,
                                         const Pose& T_world_camera, const Executor& executor) {
  const auto on_gpu = [&]() -> Result<FusionStats> {
    frames_.push_back({camera, depth, T_world_camera});  // before: what the GPU fused is never without its image
    Result<FusionStats> stats = gpu_->integrate(camera, depth, T_world_camera);
    if (!stats.ok()) frames_.pop_back();
    return stats;
  };
  const auto on_cpu = [&]() -> Result<FusionStats> {
    Result<FusionStats> stats = cpu_.integrate(camera, depth, T_world_camera, executor);
    if (!gpu_ || !stats.ok()) return stats;
    if (const Status followed = gpu_->follow(cpu_.content(), executor); !followed.ok()) {
      problem_ = followed.error().message;
      gpu_.reset();
    }
    return stats;
  };
  SACCADE_TRY(const FusionStats stats, step(on_gpu, on_cpu, executor));
  if (frames_.size() >= kMostFrames) SACCADE_CHECK(catch_up(executor));
  return stats;
}

Result<SurfaceView> HybridMap::raycast(const PinholeCamera& camera, const Pose& T_world_camera,
                                       const Executor& executor) {
  return step([&] { return gpu_->raycast(camera, T_world_camera); },
              [&] { return saccade::raycast(cpu_.content(), camera, T_world_camera, executor); }, executor);
}

Result<GainResult> HybridMap::evaluate_views(const Region& region, std::span<const Pose> T_world_camera,
                                             const GainConfig& config, const Executor& executor) {
  return step([&] { return gpu_->evaluate_views(region, T_world_camera, config, executor); },
              [&] { return saccade::evaluate_views(cpu_.content(), region, T_world_camera, config, executor); },
              executor);
}

Result<ExpectedSurface> HybridMap::expected_surface(const ExpectedSurfaceConfig& config, const Executor& executor) {
  SACCADE_CHECK(catch_up(executor));
  Result<ExpectedSurface> surface = saccade::expected_surface(cpu_.content(), config, executor, gpu());
  if (gpu_) leave_if_lost();
  return surface;
}

Result<TsdfSnapshot> HybridMap::snapshot(const Executor& executor) {
  SACCADE_CHECK(catch_up(executor));
  return cpu_.snapshot();
}

}  // namespace saccade
