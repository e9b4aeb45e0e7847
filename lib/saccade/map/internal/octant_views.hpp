// SPDX-License-Identifier: Apache-2.0
#pragma once
// Projection of the eight octants of a cube of voxels into a camera: the geometry of the conservative tests of fusion.

#include <array>
#include <cstdint>

#include "saccade/map/internal/tsdf_math.hpp"

namespace saccade::fusion {

constexpr int kOctants{8};

/// Octants of a cube of voxels, bit i: octant (i & 1, i >> 1 & 1, i >> 2).
using OctantMask = std::uint8_t;

/// Bounds of the voxel centres of a cube's octants: the pixels whose beams may hold them, and their ranges. Rounded
/// outwards.
struct OctantViews {
  std::array<std::int32_t, kOctants> u0;  ///< pixels, clamped to the image; 0 where hidden or near
  std::array<std::int32_t, kOctants> v0;
  std::array<std::int32_t, kOctants> u1;
  std::array<std::int32_t, kOctants> v1;
  std::array<float, kOctants> nearest_m;
  std::array<float, kOctants> farthest_m;
  OctantMask hidden;  ///< behind the camera or entirely outside the image
  OctantMask near;    ///< too near to the camera's plane to be projected
  OctantMask inside;  ///< entirely in the image
};

/// @param frame  frame of the cube's first voxel.
/// @param edge   edge of the cube in voxels, a power of two ≥ 4.
void view_octants(const tsdf::FusionCamera& camera, const tsdf::BrickFrame& frame, int edge, OctantViews& out);

/// Facts about the octants of a cube that need no look at their voxels.
struct KnownOctants {
  OctantMask hidden;          ///< no voxel is seen
  OctantMask free;            ///< every sample is 1
  OctantMask free_or_unseen;  ///< every sample is 1, or there is none; includes the octants of `free`
  OctantMask inside;          ///< every voxel lies in the image
};
constexpr OctantMask kAllOctants{0xFF};

}  // namespace saccade::fusion
