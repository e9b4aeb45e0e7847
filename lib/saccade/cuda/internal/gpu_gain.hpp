// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuGain: expected information gains over a BrickStore.

#include <span>
#include <vector>

#include "saccade/cuda/internal/brick_store.hpp"
#include "saccade/cuda/internal/gain_kernel.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade::internal::cuda {

/// Windows of the poses within reach, each with the poses whose rays it holds.
struct GainWindows {
  std::vector<GainWindow> windows;
  std::vector<std::vector<std::size_t>> poses;
  std::vector<float> coordinates;
  std::vector<std::uint32_t> first_windows;  ///< see GainArguments
  std::uint64_t tiles{0};
};

/// An evaluation, prepared on the host: all but the map.
struct GainTask {
  GainArguments arguments{};  ///< without anything in device memory
  GainWindows windows;
  std::size_t poses{0};
  std::uint64_t rays_total{0};
  double prepare_ms{0.0};
};

/// Answers unsupported for a region and a count that the kernel does not know.
[[nodiscard]] Status check_gains(const Region& region, const GainConfig& config);
/// Answers every error of an evaluation that is none of the device's.
[[nodiscard]] Result<GainTask> prepare_gains(const TsdfConfig& map, const Region& region,
                                             std::span<const Pose> T_world_camera, const GainConfig& config,
                                             const Executor& executor);

/// Buffers of an evaluation, which stay for the next.
class GpuGain {
 public:
  explicit GpuGain(Compute& compute)
      : compute_{compute}, windows_{compute}, first_windows_{compute}, coordinates_{compute}, gains_{compute} {}

  [[nodiscard]] Result<GainResult> count(const GainTask& task, BrickStore& bricks);
  void free_buffers() noexcept;

 private:
  Compute& compute_;
  Buffer<GainWindow> windows_;
  Buffer<std::uint32_t> first_windows_;
  Buffer<float> coordinates_;
  Buffer<std::uint64_t> gains_;
};

}  // namespace saccade::internal::cuda
