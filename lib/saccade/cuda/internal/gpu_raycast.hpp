// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuRaycast: surface views of a BrickStore.

#include "saccade/cuda/internal/brick_store.hpp"
#include "saccade/cuda/internal/raycast_kernel.hpp"
#include "saccade/map/raycast.hpp"

namespace saccade::internal::cuda {

/// Buffers of a ray cast, which stay for the next.
class GpuRaycast {
 public:
  explicit GpuRaycast(Compute& compute)
      : compute_{compute}, coordinates_{compute}, depths_m_{compute}, normals_{compute} {}

  [[nodiscard]] Result<SurfaceView> cast(const TsdfConfig& config, const PinholeCamera& camera,
                                         const Pose& T_world_camera, BrickStore& bricks);
  void free_buffers() noexcept;

 private:
  Compute& compute_;
  Buffer<double> coordinates_;
  Buffer<float> depths_m_;
  Buffer<float> normals_;
};

}  // namespace saccade::internal::cuda
