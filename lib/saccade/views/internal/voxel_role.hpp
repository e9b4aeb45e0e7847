// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelRole: relation of a voxel to the completed objects.

#include <cstdint>

#include "saccade/core/host_device.hpp"

namespace saccade {

/// Role of a voxel in the completion.
struct VoxelRole {
  /// Bits 0 and 1: state of this voxel as seen by an unknown neighbour.
  enum Opening : std::uint8_t { closed = 0, unknown = 1, empty = 2, openings = 3 };
  /// Bits 2 and 3: relation of the voxel to an object. Where hulls overlap, the larger value holds.
  enum Reach : std::uint8_t {
    outside = 0,
    below = 4,    ///< up to two voxels below an object, in its support
    carved = 8,   ///< in an object's hull, but empty at its mirrored place
    inside = 12,  ///< in an object's hull
  };
  std::uint8_t bits{0};
  [[nodiscard]] SACCADE_HD std::uint8_t reach() const { return bits & inside; }
  [[nodiscard]] SACCADE_HD std::uint8_t opening() const { return bits & openings; }
  /// Tells whether the voxel is known to be empty and in an object's hull.
  [[nodiscard]] SACCADE_HD bool is_empty_inside() const { return bits == (+inside | +empty); }
};

}  // namespace saccade
