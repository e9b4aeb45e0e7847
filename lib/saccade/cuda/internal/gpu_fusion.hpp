// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuFusion: fuses depth images into a BrickStore.

#include <functional>

#include "saccade/cuda/internal/brick_store.hpp"
#include "saccade/cuda/internal/fusion_kernel.hpp"

namespace saccade::internal::cuda {

/// Makes the bricks of a box be on the device, if it is short of memory; empty: they all are.
using BringIn = std::function<Status(const IndexBox& bricks)>;

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
                                              const DepthImage& depth, const Pose& T_world_camera, BrickStore& bricks,
                                              const BringIn& bring_in = {});
  /// Tells whether the last frame failed after the kernels began to change bricks. Before, an error changes nothing.
  [[nodiscard]] bool failed_halfway() const { return began_; }
  /// Gives the buffers back. Not while a frame is fused.
  void free_buffers() noexcept;

 private:
  /// Numbers that the kernels of a frame count, in device memory.
  enum Counter : std::size_t { kReach, kValid, kInView, kWithoutSlot, kNewSlots, kUpdated, kCounters };

  Compute& compute_;
  bool began_{false};
  Buffer<float> depths_m_;
  Buffer<float> ranges_m_;
  Buffer<std::uint32_t> tile_reach_;
  Buffer<std::uint32_t> tile_clear_;
  Buffer<std::uint32_t> counters_;
  Buffer<std::uint32_t> in_view_;
};

}  // namespace saccade::internal::cuda
