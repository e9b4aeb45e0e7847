// SPDX-License-Identifier: Apache-2.0
#pragma once
// HybridMap: a map that lives on a GPU for as long as that works, and goes on on the CPU.

#include <optional>
#include <string>
#include <vector>

#include "saccade/cuda/gpu_map.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/views/expected_surface.hpp"

namespace saccade {

/// Map whose every step runs on a GPU: fusion, ray cast, gains of views, and parts of the expected surface; nothing is
/// copied back but results. Where the GPU cannot do a step, or its memory does not suffice for it, the CPU does that
/// step with a snapshot. Where it is lost, the CPU fuses the frames again that came since the last snapshot, and goes
/// on. Results equal those of the CPU to the bit in all cases, but for the statistics of a fusion: see integrate().
/// Colours are not fused. One thread at a time.
class HybridMap {
 public:
  /// @param gpu  its content is the map's; nullopt: the CPU does everything, from an empty map on. Answers
  /// invalid_argument for an invalid configuration, and where that of the GPU's map differs; unavailable where the
  /// content cannot be read.
  [[nodiscard]] static Result<HybridMap> create(const TsdfConfig& config, std::optional<GpuMap> gpu);

  /// As TsdfMap::integrate; keeps the image until the next snapshot, at most kMostFrames of them. The statistics count
  /// bricks as the back end does that fused the image (see GpuMap::integrate); valid_pixels is the same on both.
  [[nodiscard]] Result<FusionStats> integrate(const PinholeCamera& camera, const DepthImage& depth,
                                              const Pose& T_world_camera, const Executor& executor);
  /// As saccade::raycast, without colours.
  [[nodiscard]] Result<SurfaceView> raycast(const PinholeCamera& camera, const Pose& T_world_camera,
                                            const Executor& executor);
  /// As saccade::evaluate_views.
  [[nodiscard]] Result<GainResult> evaluate_views(const Region& region, std::span<const Pose> T_world_camera,
                                                  const GainConfig& config, const Executor& executor);
  /// As saccade::expected_surface. Takes a snapshot, since the CPU completes the objects; it does the GPU's parts, too,
  /// where that fails.
  [[nodiscard]] Result<ExpectedSurface> expected_surface(const ExpectedSurfaceConfig& config, const Executor& executor);
  /// Returns the content. O(bricks that changed since the last snapshot).
  [[nodiscard]] Result<TsdfSnapshot> snapshot(const Executor& executor);

  static constexpr std::size_t kMostFrames{32};  ///< a snapshot is taken after this number
  [[nodiscard]] bool on_gpu() const { return gpu_.has_value(); }
  /// Returns the last error of the GPU; empty: it had none.
  [[nodiscard]] const std::string& gpu_problem() const { return problem_; }
  /// Returns the GPU's map; nullptr where the CPU goes on.
  [[nodiscard]] GpuMap* gpu() { return gpu_ ? &*gpu_ : nullptr; }

 private:
  struct FusedFrame {
    PinholeCamera camera;
    DepthImage depth;
    Pose T_world_camera;
  };
  HybridMap(TsdfMap map, std::optional<GpuMap> gpu) : cpu_{std::move(map)}, gpu_{std::move(gpu)} {}

  /// Brings the CPU's map up to date: by a snapshot of the GPU, or by fusing anew if the GPU was lost.
  [[nodiscard]] Status catch_up(const Executor& executor);
  /// Takes over what went wrong on the GPU, and lets go of one that is lost. Expects a GPU, and that cpu_ holds all.
  void leave_if_lost();
  /// Does a step on the GPU, or on the CPU's map where that fails.
  template <class OnGpu, class OnCpu>
  auto step(const OnGpu& on_gpu, const OnCpu& on_cpu, const Executor& executor) -> decltype(on_cpu());

  TsdfMap cpu_;                     ///< content at the last snapshot
  std::optional<GpuMap> gpu_;       ///< nullopt: cpu_ is the map
  std::vector<FusedFrame> frames_;  ///< frames that the GPU fused since the last snapshot
  std::string problem_;
};

}  // namespace saccade
