// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuTracker: tracks the frames of a Reconstruction on a GPU.

#include <optional>

#include "saccade/cuda/gpu_align.hpp"
#include "saccade/cuda/gpu_map.hpp"
#include "saccade/tracking/tracking_device.hpp"

namespace saccade {

/// Casts the map's surface and aligns frames to it on a GPU, to the CPU's bits. The map stays on the host, where frames
/// are fused with their colours; the bricks that they change go to the GPU. Once that is lost, every call answers
/// unavailable, and take_problem() tells of it once. A map of which sectors are out of memory is unsupported, which is
/// no problem. Keeps the map's bricks as of the last call. One thread at a time.
class GpuTracker final : public TrackingDevice {
 public:
  /// Opens the first GPU for a map with this configuration. Answers unavailable where there is none; invalid_argument
  /// for an invalid configuration.
  [[nodiscard]] static Result<GpuTracker> create(const TsdfConfig& config);
  /// Runs the same kernels on the host, for tests.
  /// @param memory_bytes  memory of the emulated device for the map.
  [[nodiscard]] static Result<GpuTracker> create_emulated(const TsdfConfig& config, const Executor& executor,
                                                          std::size_t memory_bytes = ~std::size_t{0});

  GpuTracker(GpuMap map, GpuAligner aligner) : map_{std::move(map)}, aligner_{std::move(aligner)} {}

  [[nodiscard]] Result<SurfaceView> raycast(const TsdfSnapshot& map, const PinholeCamera& camera,
                                            const Pose& T_world_camera, const Executor& executor) override;
  [[nodiscard]] Result<IcpResult> align(const PointImage& measured, const PointImage& model,
                                        const PinholeCamera& camera, const Pose& T_model_camera_start,
                                        const IcpConfig& config) override;
  [[nodiscard]] std::optional<Error> take_problem() override;

  /// Returns the number of calls that the GPU answered.
  [[nodiscard]] std::size_t answered() const { return answered_; }

 private:
  template <class T>
  Result<T> noted(Result<T> result);

  GpuMap map_;
  GpuAligner aligner_;
  std::size_t answered_{0};
  bool told_loss_{false};
  std::optional<Error> problem_;
};

}  // namespace saccade
