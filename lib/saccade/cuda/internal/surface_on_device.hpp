// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceOnDevice: the parts of the expected surface that kernels compute from a BrickStore.

#include "saccade/cuda/internal/brick_store.hpp"
#include "saccade/cuda/internal/surface_kernel.hpp"
#include "saccade/views/view_device.hpp"

namespace saccade::internal::cuda {

/// Buffers of the expected surface, which stay for the next.
class SurfaceOnDevice {
 public:
  explicit SurfaceOnDevice(Compute& compute);

  /// As ViewDevice, of the bricks.
  [[nodiscard]] Result<std::uint64_t> read_states(const BrickStore& bricks, double voxel_size_m, const IndexBox& box,
                                                  std::span<VoxelState> states);
  [[nodiscard]] Result<std::vector<ExposedVoxel>> exposed(std::uint64_t ticket, const ExposureTask& task);
  [[nodiscard]] Result<std::vector<std::uint8_t>> in_sight(std::uint64_t ticket, std::span<const LineOfSight> lines,
                                                           std::span<const Eigen::Vector3d> cameras_m,
                                                           double through_m);
  /// Gives the buffers back, with the volume: its ticket is refused from now on.
  void free_buffers() noexcept;

 private:
  [[nodiscard]] Status check(std::uint64_t ticket) const;

  Compute& compute_;
  std::uint64_t ticket_{0};  ///< names the last volume; 0: there is none
  std::uint64_t tickets_{0};
  StateBox volume_{};
  Buffer<std::uint8_t> states_;
  Buffer<VoxelRole> roles_;
  Buffer<std::uint16_t> squared_;
  Buffer<float> shares_;
  Buffer<std::uint32_t> count_;
  Buffer<ExposedVoxel> exposed_;
  Buffer<std::uint32_t> lines_;
  Buffer<double> cameras_m_;
  Buffer<std::uint8_t> visible_;
};

}  // namespace saccade::internal::cuda
