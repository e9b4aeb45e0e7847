// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuGain: expected information gains over a BrickStore.

#include <span>

#include "saccade/cuda/internal/brick_store.hpp"
#include "saccade/cuda/internal/gain_kernel.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade::internal::cuda {

/// Buffers of an evaluation, which stay for the next.
class GpuGain {
 public:
  explicit GpuGain(Compute& compute) : compute_{compute}, windows_{compute}, coordinates_{compute}, gains_{compute} {}

  [[nodiscard]] Result<GainResult> evaluate(const TsdfConfig& map, const Region& region,
                                            std::span<const Pose> T_world_camera, const GainConfig& config,
                                            BrickStore& bricks, const Executor& executor);

 private:
  Compute& compute_;
  Buffer<GainWindow> windows_;
  Buffer<float> coordinates_;
  Buffer<std::uint64_t> gains_;
};

}  // namespace saccade::internal::cuda
