// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuFusion: fuses depth images into a BrickStore.

#include "saccade/cuda/internal/brick_store.hpp"
#include "saccade/cuda/internal/fusion_kernel.hpp"

namespace saccade::internal::cuda {

/// Buffers of a frame, which stay for the next.
class GpuFusion {
 public:
  explicit GpuFusion(Compute& compute)
      : compute_{compute},
        depths_m_{compute},
        ranges_m_{compute},
        tile_reach_{compute},
        tile_clear_{compute},
        counters_{compute},
        in_view_{compute} {}

  [[nodiscard]] Result<FusionStats> integrate(const TsdfConfig& config, const PinholeCamera& camera,
                                              const DepthImage& depth, const Pose& T_world_camera, BrickStore& bricks);

 private:
  /// Numbers that the kernels of a frame count, in device memory.
  enum Counter : std::size_t { kReach, kValid, kInView, kUsedSlots, kUpdated, kCounters };

  Compute& compute_;
  Buffer<float> depths_m_;
  Buffer<float> ranges_m_;
  Buffer<std::uint32_t> tile_reach_;
  Buffer<std::uint32_t> tile_clear_;
  Buffer<std::uint32_t> counters_;
  Buffer<std::uint32_t> in_view_;
};

}  // namespace saccade::internal::cuda
