// SPDX-License-Identifier: Apache-2.0
#pragma once
// StateVolume: the states of the voxels of a box, one byte each, so that neighbours are a stride apart.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/views/internal/line_of_sight.hpp"
#include "saccade/views/view_device.hpp"

namespace saccade {

/// Volume of voxel states. Voxels outside the box are transparent and hold nothing. Immutable; const use from many
/// threads is safe.
class StateVolume {
 public:
  /// Makes an empty box without voxels.
  StateVolume() = default;
  /// Reads a box of the map.
  /// @return invalid_argument for a box of more than kMostVoxels. O(voxels of the box).
  [[nodiscard]] static Result<StateVolume> read(const TsdfSnapshot& map, const IndexBox& box, const Executor& executor);
  static constexpr double kMostVoxels{536'870'912.0};
  /// Reads a box of the map that a device follows. Errors: those of read(), and of the device.
  [[nodiscard]] static Result<StateVolume> read(const TsdfSnapshot& map, const IndexBox& box, ViewDevice& device);

  [[nodiscard]] const IndexBox& box() const { return box_; }
  [[nodiscard]] double voxel_size_m() const { return voxel_size_m_; }
  [[nodiscard]] std::size_t size() const { return states_.size(); }
  /// Strides along y and z; along x it is 1.
  [[nodiscard]] std::ptrdiff_t row() const { return row_; }
  [[nodiscard]] std::ptrdiff_t layer() const { return layer_; }

  /// Returns the index of a voxel. Expects a voxel of the box.
  [[nodiscard]] std::size_t index(const Index3& voxel) const {
    const Index3 i = voxel - box_.lo;
    return static_cast<std::size_t>(i.z * layer_ + i.y * row_ + i.x);
  }
  [[nodiscard]] Index3 voxel(std::size_t index) const {
    const auto i = static_cast<std::ptrdiff_t>(index);
    return box_.lo + Index3{static_cast<std::int32_t>(i % row_), static_cast<std::int32_t>(i % layer_ / row_),
                            static_cast<std::int32_t>(i / layer_)};
  }
  /// Returns the states by index().
  [[nodiscard]] const VoxelState* data() const { return states_.data(); }
  [[nodiscard]] VoxelState operator[](std::size_t index) const { return states_[index]; }
  /// Returns the volume as kernels see it. It borrows the states.
  [[nodiscard]] StateBox state_box() const;
  /// Returns the ticket of the device that the states came from; 0: they came from none.
  [[nodiscard]] std::uint64_t ticket() const { return ticket_; }

  /// Tells whether nothing hides a voxel of the box from a camera: the straight line from its centre to the camera's
  /// passes only empty voxels; over the first through_m also unknown ones. The voxel itself does not count. O(voxels
  /// between).
  [[nodiscard]] bool is_visible(std::size_t voxel, const Eigen::Vector3d& camera_m, double through_m) const;

 private:
  /// Makes a box of unknown voxels.
  [[nodiscard]] static Result<StateVolume> unknown(const TsdfSnapshot& map, const IndexBox& box);

  IndexBox box_{};
  double voxel_size_m_{1.0};
  std::ptrdiff_t row_{0};
  std::ptrdiff_t layer_{0};
  std::uint64_t ticket_{0};
  std::vector<VoxelState> states_;
};

/// Tells whether any of `count` voxels in a row is occupied.
[[nodiscard]] inline bool any_occupied(const VoxelState* states, std::size_t count) {
  unsigned any{0};
  for (std::size_t i = 0; i < count; ++i) any |= states[i] == VoxelState::occupied ? 1U : 0U;
  return any != 0;
}

}  // namespace saccade
